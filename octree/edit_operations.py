"""Edits as records of JSON, as scripts and messages have them. docs/edit.md has the keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, TypeAlias

from msgspec import Meta, Struct

from voxrt.octree.query import Corner  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.octree.shapes import Box, Capsule, Point, Sphere
from voxrt.voxelize import Material
from voxrt.voxelize.authoring.declared_materials import parse_colour

if TYPE_CHECKING:
    from voxrt.octree.shapes import Shape
    from voxrt.octree.world import World

MaterialName: TypeAlias = int | str
"""An id or a name; 0 and ``"empty"`` are empty space."""


class Record(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An object that refuses unknown keys."""


class BoxRecord(Record, frozen=True, kw_only=True):
    """A box; :class:`Box` has its fields."""

    low: Corner
    high: Corner


class SphereRecord(Record, frozen=True, kw_only=True):
    """A ball; :class:`Sphere` has its fields."""

    centre: Point
    radius: float


class CapsuleRecord(Record, frozen=True, kw_only=True):
    """A capsule; :class:`Capsule` has its fields."""

    start: Point
    end: Point
    radius: float


class Operation(Record, frozen=True, kw_only=True, tag_field="op"):
    """An edit."""

    def run(self, world: World) -> None:
        """Edit a world. TypeError, ValueError or DoesNotFitError where it cannot be done."""
        raise NotImplementedError


class SetVoxels(Operation, frozen=True, kw_only=True, tag="set"):
    """Gives single voxels their materials."""

    points: list[Corner]
    materials: MaterialName | list[MaterialName]

    def run(self, world: World) -> None:
        """Edit a world."""
        named = self.materials if isinstance(self.materials, list) else [self.materials] * len(self.points)
        world.set(self.points, [_material_id(world, name) for name in named])


class ShapeOperation(Operation, frozen=True, kw_only=True):
    """Gives the voxels of a shape a material."""

    material: MaterialName
    box: BoxRecord | None = None
    sphere: SphereRecord | None = None
    capsule: CapsuleRecord | None = None

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


class Fill(ShapeOperation, frozen=True, kw_only=True, tag="fill"):
    """Fills a shape, or digs it out."""

    def run(self, world: World) -> None:
        """Edit a world."""
        world.fill(self.shape(), _material_id(world, self.material))


class Paint(ShapeOperation, frozen=True, kw_only=True, tag="paint"):
    """Paints the solid voxels of a shape."""

    def run(self, world: World) -> None:
        """Edit a world."""
        world.paint(self.shape(), _material_id(world, self.material))


class PasteBox(Operation, frozen=True, kw_only=True, tag="paste"):
    """Copies a box elsewhere."""

    box: BoxRecord
    at: Corner
    turned: Annotated[int, Meta(ge=0, le=3)] = 0

    def run(self, world: World) -> None:
        """Edit a world."""
        world.paste(world.copy(self.box.low, self.box.high), self.at, turned=self.turned)


class AddMaterial(Operation, frozen=True, kw_only=True, tag="material"):
    """Adds a material."""

    name: str
    colour: str | list[int]
    mirror: bool = False

    def run(self, world: World) -> None:
        """Edit a world."""
        if any(material.name == self.name for material in world.materials):
            raise ValueError(f"there is a material {self.name!r} already")
        world.add_material(Material(self.name, parse_colour(self.colour), self.mirror))


class Undo(Operation, frozen=True, kw_only=True, tag="undo"):
    """Goes back by an edit."""

    def run(self, world: World) -> None:
        """Edit a world."""
        if not world.undo():
            raise ValueError("there is no edit to undo")


class Redo(Operation, frozen=True, kw_only=True, tag="redo"):
    """Does an edit again."""

    def run(self, world: World) -> None:
        """Edit a world."""
        if not world.redo():
            raise ValueError("there is no edit to do again")


def _material_id(world: World, name: MaterialName) -> int:
    """Return the id of a material; ValueError if the world has none of that name. :class:`World` checks ids."""
    if isinstance(name, int):
        return name
    names = [material.name for material in world.materials]
    if name in names:
        return names.index(name)
    raise ValueError(f"there is no material {name!r}; add it by an operation material")
