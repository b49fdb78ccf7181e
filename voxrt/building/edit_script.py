"""Scripts of edits: JSON Lines, an operation per line. docs/edit.md has the keys."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import msgspec
from msgspec import Meta, Struct

from voxrt.export import read_any
from voxrt.octree import Box, Capsule, RomError, Sphere, World
from voxrt.octree.query import Corner  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.octree.shapes import Point  # noqa: TC001
from voxrt.voxelize import AssetError, DoesNotFitError, Material
from voxrt.voxelize.arguments import instance
from voxrt.voxelize.authoring.declared_materials import parse_colour

if TYPE_CHECKING:
    import os

    from voxrt.octree.shapes import Shape

_MOST_BYTES = 1 << 28

MaterialName: TypeAlias = int | str
"""An id or a name; 0 and ``"empty"`` are empty space."""


class _Record(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An object that refuses unknown keys."""


class _BoxRecord(_Record, frozen=True, kw_only=True):
    low: Corner
    high: Corner


class _SphereRecord(_Record, frozen=True, kw_only=True):
    centre: Point
    radius: float


class _CapsuleRecord(_Record, frozen=True, kw_only=True):
    start: Point
    end: Point
    radius: float


class _Operation(_Record, frozen=True, kw_only=True, tag_field="op"):
    """A line of a script."""

    def run(self, world: World, folder: Path) -> None:
        raise NotImplementedError


class _SetVoxels(_Operation, frozen=True, kw_only=True, tag="set"):
    points: list[Corner]
    materials: MaterialName | list[MaterialName]

    def run(self, world: World, folder: Path) -> None:  # noqa: ARG002 - only paste reads files
        named = self.materials if isinstance(self.materials, list) else [self.materials] * len(self.points)
        world.set(self.points, [_material_id(world, name) for name in named])


class _ShapeOperation(_Operation, frozen=True, kw_only=True):
    material: MaterialName
    box: _BoxRecord | None = None
    sphere: _SphereRecord | None = None
    capsule: _CapsuleRecord | None = None

    def shape(self) -> Shape:
        """Return the one shape; ValueError if there is none, or there are several."""
        if sum(one is not None for one in (self.box, self.sphere, self.capsule)) != 1:
            raise ValueError("one of box, sphere and capsule is needed")
        if self.box is not None:
            return Box(self.box.low, self.box.high)
        if self.sphere is not None:
            return Sphere(self.sphere.centre, self.sphere.radius)
        assert self.capsule is not None
        return Capsule(self.capsule.start, self.capsule.end, self.capsule.radius)


class _Fill(_ShapeOperation, frozen=True, kw_only=True, tag="fill"):
    def run(self, world: World, folder: Path) -> None:  # noqa: ARG002
        world.fill(self.shape(), _material_id(world, self.material))


class _Paint(_ShapeOperation, frozen=True, kw_only=True, tag="paint"):
    def run(self, world: World, folder: Path) -> None:  # noqa: ARG002
        world.paint(self.shape(), _material_id(world, self.material))


class _Paste(_Operation, frozen=True, kw_only=True, tag="paste"):
    at: Corner
    box: _BoxRecord | None = None
    file: str | None = None
    turned: Annotated[int, Meta(ge=0, le=3)] = 0

    def run(self, world: World, folder: Path) -> None:
        if (self.box is None) == (self.file is None):
            raise ValueError("one of box and file is needed")
        if self.box is not None:
            world.paste(world.copy(self.box.low, self.box.high), self.at, turned=self.turned)
        elif self.file is not None:
            blob, _ = read_any(folder / self.file)
            world.paste(blob.rom, self.at, turned=self.turned)


class _AddMaterial(_Operation, frozen=True, kw_only=True, tag="material"):
    name: str
    colour: str | list[int]
    mirror: bool = False

    def run(self, world: World, folder: Path) -> None:  # noqa: ARG002
        if any(material.name == self.name for material in world.materials):
            raise ValueError(f"there is a material {self.name!r} already")
        world.add_material(Material(self.name, parse_colour(self.colour), self.mirror))


class _Undo(_Operation, frozen=True, kw_only=True, tag="undo"):
    def run(self, world: World, folder: Path) -> None:  # noqa: ARG002
        if not world.undo():
            raise ValueError("there is no edit to undo")


class _Redo(_Operation, frozen=True, kw_only=True, tag="redo"):
    def run(self, world: World, folder: Path) -> None:  # noqa: ARG002
        if not world.redo():
            raise ValueError("there is no edit to do again")


Operation: TypeAlias = _SetVoxels | _Fill | _Paint | _Paste | _AddMaterial | _Undo | _Redo


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
            operation.run(world, path.parent)
        except DoesNotFitError as error:
            raise DoesNotFitError(f"{path}: {place}: {error}") from error
        except (TypeError, ValueError, RomError) as error:
            raise AssetError(path, str(error), place=place) from error
    return len(operations)


def _read_operations(path: Path) -> list[tuple[int, Operation]]:
    """Read the operations and their lines; empty lines hold none."""
    try:
        with path.open("rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as error:
        raise AssetError(path, f"cannot be read: {error.strerror}") from None
    if len(data) > _MOST_BYTES:
        raise AssetError(path, f"has more than {_MOST_BYTES >> 20} MiB", fix="cut it into several scripts")
    decoder = msgspec.json.Decoder(Operation)
    operations: list[tuple[int, Operation]] = []
    for number, line in enumerate(data.split(b"\n"), 1):
        if not line.strip():
            continue
        try:
            operations.append((number, decoder.decode(line)))
        except (msgspec.MsgspecError, RecursionError) as error:
            raise AssetError(path, f"is no operation: {error}", place=f"line {number}") from None
    return operations


def _material_id(world: World, name: MaterialName) -> int:
    """Return the id of a material; ValueError if the world has none of that name. :class:`World` checks ids."""
    if isinstance(name, int):
        return name
    names = [material.name for material in world.materials]
    if name in names:
        return names.index(name)
    raise ValueError(f"there is no material {name!r}; add it by an operation material")
