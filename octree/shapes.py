"""Solids that an edit fills: boxes, balls and capsules, in voxels of the grid frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from msgspec.structs import force_setattr

from voxrt.octree.camera import POSITION_UNITS
from voxrt.octree.query import Corner, as_box
from voxrt.voxelize.arguments import real, shown, vector
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from voxrt.octree import _native

Point: TypeAlias = tuple[float, float, float]

_REACH = 1 << 20
"""Positions and radii are at most this, in voxels."""


class Box(Value, frozen=True):
    """The voxels of a box.

    Attributes
    ----------
    low, high
        Integers (x, y, z): the lowest voxel, and one behind the highest. The box may reach beyond the world.

    Raises
    ------
    TypeError, ValueError
        A corner is not three integers, or `high` lies below `low`.

    Examples
    --------
    >>> Box([0, 0, 0], [4, 1, 4])
    Box(low=(0, 0, 0), high=(4, 1, 4))
    """

    low: Corner
    high: Corner

    def __post_init__(self) -> None:
        low, high = as_box(self.low, self.high)
        force_setattr(self, "low", low)
        force_setattr(self, "high", high)


class Sphere(Value, frozen=True):
    """The voxels whose centres are in a ball, its surface included. Voxel v has its centre at v + 0.5.

    Attributes
    ----------
    centre
        Numbers (x, y, z): voxels, multiples of 1/16, at most 2**20.
    radius
        Voxels, a multiple of 1/16, 0 … 2**20.

    Raises
    ------
    TypeError, ValueError
        A number is none of these: round it, for example ``np.rint(16 * centre) / 16``.

    Examples
    --------
    >>> Sphere((8, 8, 8), 2.5)
    Sphere(centre=(8.0, 8.0, 8.0), radius=2.5)
    """

    centre: Point
    radius: float

    def __post_init__(self) -> None:
        force_setattr(self, "centre", _point("Sphere.centre", self.centre))
        force_setattr(self, "radius", _sixteenths("Sphere.radius", real("Sphere.radius", self.radius, low=0)))


class Capsule(Value, frozen=True):
    """The voxels whose centres are within a distance of a straight line, which makes tunnels, for example.

    Attributes
    ----------
    start, end
        Numbers (x, y, z): the ends of the line. Voxels, multiples of 1/16, at most 2**20.
    radius
        Voxels, a multiple of 1/16, 0 … 2**20.

    Raises
    ------
    TypeError, ValueError
        A number is none of these.

    Examples
    --------
    >>> Capsule((0, 4.5, 4.5), (16, 4.5, 4.5), 3).radius
    3.0
    """

    start: Point
    end: Point
    radius: float

    def __post_init__(self) -> None:
        force_setattr(self, "start", _point("Capsule.start", self.start))
        force_setattr(self, "end", _point("Capsule.end", self.end))
        force_setattr(self, "radius", _sixteenths("Capsule.radius", real("Capsule.radius", self.radius, low=0)))


Shape: TypeAlias = Box | Sphere | Capsule


def change_shape(world: _native.World, shape: Shape, material: int, *, solid_only: bool) -> bool:
    """Give a shape's voxels a material; False where the result does not fit. TypeError if it is no shape."""
    match shape:
        case Box():
            return world.change_box(shape.low, shape.high, material, solid_only)
        case Sphere():
            return world.change_ball(_in_units(shape.centre), _whole(shape.radius), material, solid_only)
        case Capsule():
            ends = _in_units(shape.start), _in_units(shape.end)
            return world.change_capsule(*ends, _whole(shape.radius), material, solid_only)
    raise TypeError(f"shape must be a Box, a Sphere or a Capsule, not {shown(shape)}")


def _in_units(point: Point) -> Corner:
    x, y, z = (_whole(coordinate) for coordinate in point)
    return x, y, z


def _whole(value: float) -> int:
    """Return voxels in whole numbers of 1/16 voxel."""
    return int(value * POSITION_UNITS)


def _point(name: str, value: object) -> Point:
    x, y, z = (_sixteenths(name, coordinate) for coordinate in vector(name, value))
    return x, y, z


def _sixteenths(name: str, value: float) -> float:
    if not (value * POSITION_UNITS).is_integer() or abs(value) > _REACH:
        raise ValueError(
            f"{name} must have multiples of 1/16 voxel up to 2**20, not {value}; round it: np.rint(16 * x) / 16"
        )
    return value
