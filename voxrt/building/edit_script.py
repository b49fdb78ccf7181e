"""Scripts of edits: JSON Lines, an operation per line. docs/edit.md has the keys."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import msgspec
from msgspec import Meta

from voxrt.export import read_any
from voxrt.octree import RomError, World
from voxrt.octree.edit_operations import AddMaterial, BoxRecord, Fill, Operation, Paint, PasteBox, Redo, SetVoxels, Undo
from voxrt.octree.query import Corner  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.voxelize import AssetError, DoesNotFitError
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    import os

_MOST_BYTES = 1 << 28


class _Paste(Operation, frozen=True, kw_only=True, tag="paste"):
    """Pastes a box of the world, or the memory in a file."""

    at: Corner
    box: BoxRecord | None = None
    file: str | None = None
    turned: Annotated[int, Meta(ge=0, le=3)] = 0

    def run_in(self, world: World, folder: Path) -> None:
        """Edit a world; the file is found from a folder."""
        if (self.box is None) == (self.file is None):
            raise ValueError("one of box and file is needed")
        if self.box is not None:
            PasteBox(box=self.box, at=self.at, turned=self.turned).run(world)
        elif self.file is not None:
            blob, _ = read_any(folder / self.file)
            world.paste(blob.rom, self.at, turned=self.turned)


_Line: TypeAlias = SetVoxels | Fill | Paint | _Paste | AddMaterial | Undo | Redo


def run_edit_script(world: World, script: str | os.PathLike[str]) -> int:
    """Run the edits of a script, and return their number.

    All lines are read before the first is run. If one fails, those before it have been done.

    Parameters
    ----------
    world
        The memory that is edited.
    script
        The file. Files that it names are found from its folder.

    Raises
    ------
    AssetError
        The file cannot be read, or a line is no operation or cannot be done. The message names the line.
    DoesNotFitError
        The memory has no room for the result of a line.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> _ = Path("dig.jsonl").write_text('{"op": "fill", "sphere": {"centre": [8, 8, 8], "radius": 4}, "material": 0}')
    >>> world = voxrt.World(voxrt.build("examples/house.obj", depth=4).rom)
    >>> run_edit_script(world, "dig.jsonl")
    1
    """
    instance("world", world, World)
    path = Path(script)
    operations = _read_operations(path)
    for line, operation in operations:
        place = f"line {line}"
        try:
            if isinstance(operation, _Paste):
                operation.run_in(world, path.parent)
            else:
                operation.run(world)
        except DoesNotFitError as error:
            raise DoesNotFitError(f"{path}: {place}: {error}") from error
        except (TypeError, ValueError, RomError) as error:
            raise AssetError(path, str(error), place=place) from error
    return len(operations)


def _read_operations(path: Path) -> list[tuple[int, _Line]]:
    """Read the operations and their lines; empty lines hold none."""
    try:
        with path.open("rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as error:
        raise AssetError(path, f"cannot be read: {error.strerror}") from None
    if len(data) > _MOST_BYTES:
        raise AssetError(path, f"has more than {_MOST_BYTES >> 20} MiB", fix="cut it into several scripts")
    decoder = msgspec.json.Decoder(_Line)
    operations: list[tuple[int, _Line]] = []
    for number, line in enumerate(data.split(b"\n"), 1):
        if not line.strip():
            continue
        try:
            operations.append((number, decoder.decode(line)))
        except (msgspec.MsgspecError, RecursionError) as error:
            raise AssetError(path, f"is no operation: {error}", place=f"line {number}") from None
    return operations
