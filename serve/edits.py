"""Edits of the present scene by clients: what they may ask for, and the scene as files."""

from __future__ import annotations

import tempfile
import time
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from voxrt.board.edited_scene import rom_of
from voxrt.board.errors import Refused
from voxrt.export import Blob, convert
from voxrt.export.vox import write_vox
from voxrt.octree import Box, Capsule, RomError, Sphere, census
from voxrt.octree.edit_operations import AddMaterial, Fill, Paint, PasteBox, Redo, SetVoxels, ShapeOperation, Undo
from voxrt.serve.packets import CHUNK_LIMIT, Chunk
from voxrt.serve.rate_limiter import RateLimiter
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from voxrt.board.scene import Scene
    from voxrt.octree import World
    from voxrt.octree.shapes import Shape

EditOperation: TypeAlias = SetVoxels | Fill | Paint | PasteBox | AddMaterial | Undo | Redo
"""What a client may ask for: the operations of docs/edit.md, but for files."""

SHAPE_LIMIT: Final = 512
"""Voxels that the sides of a shape may have: a ball of this size takes about 0.1 s."""
PASTE_LIMIT: Final = 128
"""Voxels that the sides of a box may have that is copied, since all of its voxels may differ."""
SAVED_SUFFIXES: Final = (".mem", ".blob", ".vox")
_VOX_VOXELS = 1 << 24
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


def run_operation(operation: EditOperation, world: World) -> None:
    """Edit a world. Refused where that cannot be done; then nothing has changed."""
    try:
        operation.run(world)
    except (TypeError, ValueError, RomError, DoesNotFitError) as error:
        raise Refused(str(error)) from error


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


class SavedScene:
    """A scene as files, which a client fetches in parts; :meth:`close` removes them.

    Parameters
    ----------
    number
        The request that saved it; every part repeats it.
    scene
        The scene, with the words of a build.
    suffix
        One of :data:`SAVED_SUFFIXES`.

    Raises
    ------
    Refused
        The scene cannot be saved so, or the temporary folder cannot be written.
    """

    def __init__(self, number: int, scene: Scene, suffix: str) -> None:
        self.number = number
        self._folder = tempfile.TemporaryDirectory(prefix="voxrt-saved-", ignore_cleanup_errors=True)
        try:
            self._paths = _write(scene, Path(self._folder.name, f"{_file_stem(scene.name)}{suffix}"))
            self._sizes = [path.stat().st_size for path in self._paths]
            self.files: list[dict[str, Any]] = [
                {"name": path.name, "size": size, "crc32": _crc32(path)}
                for path, size in zip(self._paths, self._sizes, strict=True)
            ]
        except (DoesNotFitError, RomError) as error:
            self.close()
            raise Refused(str(error).replace(f"{self._folder.name}/", "")) from error
        except OSError as error:
            self.close()
            raise Refused(f"the server cannot store the files: {error.strerror or error}; make room there") from error
        except BaseException:
            self.close()
            raise

    def part(self, offset: int) -> Chunk:
        """Read a part from a byte on, counted in all files together; Refused behind their end."""
        start = offset
        for path, size in zip(self._paths, self._sizes, strict=True):
            if start < size:
                with path.open("rb") as file:
                    file.seek(start)
                    return Chunk(self.number, offset, file.read(CHUNK_LIMIT))
            start -= size
        raise Refused(f"the files end at byte {sum(self._sizes)}, before byte {offset}")

    def close(self) -> None:
        """Remove the files."""
        self._folder.cleanup()


def _write(scene: Scene, path: Path) -> tuple[Path, ...]:
    rom = rom_of(scene)
    if path.suffix != ".vox":
        return convert(Blob(rom, scene.camera, scene.lighting), path)
    if (count := census(rom.octree).solid_voxels) > _VOX_VOXELS:
        raise Refused(f"{count:,} solid voxels are more than the {_VOX_VOXELS:,} of a .vox; save it as .blob")
    write_vox(path, rom)
    return (path,)


def _file_stem(name: str) -> str:
    """Make a file's name of a scene's."""
    return "".join(one if one.isalnum() or one in "-_." else "_" for one in name)[:60].strip(".") or "scene"


def _crc32(path: Path) -> int:
    crc = 0
    with path.open("rb") as file:
        while part := file.read(1 << 20):
            crc = zlib.crc32(part, crc)
    return crc


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
