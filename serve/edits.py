"""Edits of the present scene by clients, and cuts of it: what they may ask for."""

from __future__ import annotations

import base64
import time
from typing import TYPE_CHECKING, Final, TypeAlias

from voxrt.board.errors import Refused
from voxrt.octree import Box, Capsule, RomError, Sphere
from voxrt.octree.edit_operations import AddMaterial, Fill, Paint, PasteBox, Redo, SetVoxels, ShapeOperation, Undo
from voxrt.octree.solid_box import solid_box
from voxrt.serve.rate_limiter import RateLimiter
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from voxrt.octree import Octree, World
    from voxrt.octree.query import Corner
    from voxrt.octree.shapes import Shape

EditOperation: TypeAlias = SetVoxels | Fill | Paint | PasteBox | AddMaterial | Undo | Redo
"""What a client may ask for: the operations of docs/edit.md, but for files."""

SHAPE_LIMIT: Final = 512
"""Voxels that the sides of a shape may have: a ball of this size takes about 0.1 s."""
PASTE_LIMIT: Final = 128
"""Voxels that the sides of a box may have that is copied, since all of its voxels may differ."""
CUT_WORDS: Final = 1 << 15
"""Words of a cut: 128 KiB."""
CUT_OCTANTS: Final = 1 << 16
"""Octants that a cut looks into, which takes about 10 ms."""
_NAME = 200


def check_operation(operation: EditOperation) -> None:
    """Refuse an operation that takes too long, or a name that cannot be shown."""
    try:
        if isinstance(operation, ShapeOperation):
            _check_sides(operation.shape(), SHAPE_LIMIT)
        if isinstance(operation, PasteBox):
            _check_sides(Box(operation.box.low, operation.box.high), PASTE_LIMIT)
    except (TypeError, ValueError) as error:
        raise Refused(str(error)) from error
    if isinstance(operation, AddMaterial) and not (operation.name.isprintable() and 1 <= len(operation.name) <= _NAME):
        raise Refused(f"the name of a material has 1 to {_NAME} printable characters")


def run_operation(operation: EditOperation, stroke: int, world: World) -> None:
    """Edit a world. Refused where that cannot be done; then nothing has changed."""
    world.stroke = stroke
    try:
        operation.run(world)
    except (TypeError, ValueError, RomError, DoesNotFitError) as error:
        raise Refused(str(error)) from error


def cut_solid(scene: Octree | World, low: Corner, high: Corner) -> dict[str, object]:
    """Cut the solid voxels of a box out: `depth`, and `words` as the Base64 of little-endian bytes.

    Raises
    ------
    Refused
        The box is none, or too much is in it.
    """
    try:
        cut = solid_box(scene, low, high, words=CUT_WORDS, octants=CUT_OCTANTS)
    except (TypeError, ValueError) as error:
        raise Refused(str(error)) from error
    return {"depth": cut.depth, "words": base64.b64encode(cut.words.astype("<u4").tobytes()).decode()}


class EditRate:
    """Refuses edits that come too fast.

    Parameters
    ----------
    per_second
        Edits per second, on average; a burst may have twice as many.
    """

    def __init__(self, per_second: float) -> None:
        self._per_second = per_second
        self._limiter = RateLimiter(per_second, time.monotonic)

    def check(self) -> None:
        """Count an edit."""
        if not self._limiter.acquire():
            raise Refused(f"there are more than {self._per_second:g} edits per second; wait a moment")


def _check_sides(shape: Shape, limit: int) -> None:
    sides: list[float]
    match shape:
        case Box():
            sides = [high - low for low, high in zip(shape.low, shape.high, strict=True)]
        case Sphere():
            sides = [2 * shape.radius]
        case Capsule():
            sides = [2 * shape.radius + abs(a - b) for a, b in zip(shape.start, shape.end, strict=True)]
    if max(sides) > limit:
        raise Refused(f"the shape has {max(sides):g} voxels per side, and an edit may have {limit}; make it smaller")
