"""Colliders: simple shapes that represent an object in place of its triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.mesh import checked_surface
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

ColliderKind: TypeAlias = Literal["box", "sphere", "hull", "mesh"]

COLLIDER_KINDS: tuple[ColliderKind, ...] = ("box", "sphere", "hull", "mesh")


class BoxCollider(Value, frozen=True, eq=False):
    """A box along the axes of its object's frame.

    Attributes
    ----------
    minimum, maximum
        float64, shape (3,): the lowest and the highest corner, in units of the object's frame.
    pow2
        Whether the box asks for sides that are powers of two voxels; see `pow2` of :func:`voxrt.voxelize.voxelize`.

    Raises
    ------
    TypeError, ValueError
        A corner that is not three finite numbers, or a maximum below the minimum.

    Examples
    --------
    >>> BoxCollider([0, 0, 0], [1, 2, 1]).maximum
    array([1., 2., 1.])
    """

    minimum: NDArray[np.float64]
    maximum: NDArray[np.float64]
    pow2: bool = True

    def __post_init__(self) -> None:
        low = arguments.real_array("BoxCollider.minimum", self.minimum, (3,)).astype(np.float64, copy=False)
        high = arguments.real_array("BoxCollider.maximum", self.maximum, (3,)).astype(np.float64, copy=False)
        if (high < low).any():
            raise ValueError(f"BoxCollider.maximum {high.tolist()} is below its minimum {low.tolist()}")
        force_setattr(self, "minimum", low)
        force_setattr(self, "maximum", high)
        force_setattr(self, "pow2", arguments.flag("BoxCollider.pow2", self.pow2))


class SphereCollider(Value, frozen=True, eq=False):
    """A ball in its object's frame; an ellipsoid where the object's transform scales the axes differently.

    Attributes
    ----------
    centre
        float64, shape (3,).
    radius
        Units of the object's frame, not negative.

    Raises
    ------
    TypeError, ValueError
        A centre that is not three finite numbers, or a radius that is negative or not finite.

    Examples
    --------
    >>> SphereCollider([0, 1, 0], 2).radius
    2.0
    """

    centre: NDArray[np.float64]
    radius: float

    def __post_init__(self) -> None:
        centre = arguments.real_array("SphereCollider.centre", self.centre, (3,)).astype(np.float64, copy=False)
        radius = arguments.real("SphereCollider.radius", self.radius)
        if radius < 0:
            raise ValueError(f"SphereCollider.radius must not be negative, as {radius} is")
        force_setattr(self, "centre", centre)
        force_setattr(self, "radius", radius)


class HullCollider(Value, frozen=True, eq=False):
    """The convex hull of points in its object's frame.

    Attributes
    ----------
    positions
        float64, shape (V, 3), V > 0.

    Raises
    ------
    TypeError, ValueError
        No points, or one that is not three finite numbers.

    Examples
    --------
    >>> HullCollider([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).positions.shape
    (4, 3)
    """

    positions: NDArray[np.float64]

    def __post_init__(self) -> None:
        points = arguments.real_array("HullCollider.positions", self.positions, ("V", 3))
        if not len(points):
            raise ValueError("HullCollider.positions must hold one point or more")
        force_setattr(self, "positions", points.astype(np.float64, copy=False))


class MeshCollider(Value, frozen=True, eq=False):
    """Triangles that are voxelized in place of the rendered ones.

    Attributes
    ----------
    positions, triangles
        As in :class:`voxrt.voxelize.Mesh`.

    Raises
    ------
    TypeError, ValueError
        As :class:`voxrt.voxelize.Mesh`.

    Examples
    --------
    >>> MeshCollider([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).triangles.dtype
    dtype('int32')
    """

    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]

    def __post_init__(self) -> None:
        positions, triangles = checked_surface("MeshCollider", self.positions, self.triangles)
        force_setattr(self, "positions", positions)
        force_setattr(self, "triangles", triangles)


Collider: TypeAlias = BoxCollider | SphereCollider | HullCollider | MeshCollider


def collider_around(
    kind: ColliderKind, positions: NDArray[np.floating], triangles: NDArray[np.int32], *, pow2: bool = True
) -> Collider:
    """Return a collider around a surface, in the surface's frame.

    Parameters
    ----------
    kind
        ``"box"``: the bounding box; ``"sphere"``: the smallest ball about the middle of that box; ``"hull"``: the
        convex hull; ``"mesh"``: the triangles themselves.
    positions, triangles
        As in :class:`voxrt.voxelize.Mesh`; at least one triangle.
    pow2
        As in :class:`BoxCollider`.

    Raises
    ------
    TypeError, ValueError
        An argument out of range.

    Examples
    --------
    >>> collider_around("box", np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0]]), np.array([[0, 1, 2]])).maximum
    array([1., 2., 0.])
    """
    arguments.choice("collider", kind, COLLIDER_KINDS)
    positions, triangles = checked_surface("collider_around", positions, triangles)
    if kind == "mesh":
        return MeshCollider(positions, triangles)
    if not len(triangles):
        raise ValueError("collider_around.triangles must hold one triangle or more")
    points = positions[np.unique(triangles)].astype(np.float64)
    if kind == "hull":
        return HullCollider(points)
    low, high = points.min(axis=0), points.max(axis=0)
    if kind == "box":
        return BoxCollider(low, high, pow2)
    centre = low + (high - low) / 2
    return SphereCollider(centre, float(np.linalg.norm(points - centre, axis=1).max()))


def bounding_points(collider: Collider) -> NDArray[np.floating]:
    """Return points of a collider's frame whose convex hull holds the collider: shape (V, 3)."""
    if isinstance(collider, BoxCollider):
        return box_corners(collider)
    if isinstance(collider, SphereCollider):
        return collider.centre + collider.radius * (2 * _CORNERS - 1)
    if isinstance(collider, MeshCollider):
        return collider.positions[np.unique(collider.triangles)]
    return collider.positions


_CORNERS = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], dtype=np.float64)

BOX_TRIANGLES = np.array(
    [
        [0, 4, 6], [0, 6, 2],  # x = minimum
        [1, 3, 7], [1, 7, 5],
        [0, 1, 5], [0, 5, 4],  # y = minimum
        [2, 6, 7], [2, 7, 3],
        [0, 2, 3], [0, 3, 1],  # z = minimum
        [4, 5, 7], [4, 7, 6],
    ],
    dtype=np.int32,
)  # fmt: skip
"""int32, shape (12, 3): the faces of a box over its corners numbered {z, y, x}, counter-clockwise seen from outside."""


def box_corners(box: BoxCollider) -> NDArray[np.float64]:
    """Return the eight corners of a box, numbered {z, y, x}: float64, shape (8, 3), object frame."""
    return box.minimum + _CORNERS * (box.maximum - box.minimum)
