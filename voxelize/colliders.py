"""Colliders: which geometry stands for an object, and boxes rounded up to powers of two voxels.

Rounding is the rule of the report that this project re-implements: a side of 3.5 voxels becomes 4, so that a box is a
few large octants and not a skin of unit voxels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from voxrt.voxelize.scene import BoxCollider, MeshCollider, SphereCollider

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.scene import Collider, SceneObject

Geometry: TypeAlias = Literal["auto", "render", "collider"]
Pow2: TypeAlias = Literal["box", "none"]

UNITS_PER_VOXEL = 4096
"""Vertices are snapped to 1/4096 voxel; from there on coverage is exact."""

SNAP = 1.0
"""How far, in voxels, rounding may move a box's lowest corner to stand on a larger octant's corner."""


def stand_ins(item: SceneObject, geometry: Geometry) -> tuple[Collider, ...] | None:
    """Give the colliders that stand for an object, or None where its triangles are voxelized.

    An object without colliders that must have one gets the box of its mesh, in its own frame.
    """
    if geometry == "render" or (geometry == "auto" and not item.colliders):
        return None
    if item.colliders or len(item.mesh.triangles) == 0:
        return item.colliders
    corners = item.mesh.positions[item.mesh.triangles.ravel()].astype(np.float64)
    return (BoxCollider(corners.min(axis=0), corners.max(axis=0)),)


def corner_points(collider: Collider) -> NDArray[np.floating]:
    """Points of a collider whose convex hull holds it (shape (V, 3), object frame)."""
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
"""The faces of a box over its corners numbered {z, y, x}, counter-clockwise seen from outside."""


def box_corners(box: BoxCollider) -> NDArray[np.float64]:
    """Give the eight corners of a box, numbered {z, y, x} (float64, shape (8, 3), object frame)."""
    return box.minimum + _CORNERS * (box.maximum - box.minimum)


def box_in_voxels(item: SceneObject, box: BoxCollider, grid: Grid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the lowest and the highest corner of an object's box, in voxels (float64, shape (3,))."""
    corners = box_corners(box) @ item.transform[:3, :3].T + item.transform[:3, 3]
    corners = (corners - np.array(grid.origin)) / grid.voxel_size
    return corners.min(axis=0), corners.max(axis=0)


def keeps_axes(transform: NDArray[np.float64]) -> bool:
    """Tell whether a transform takes each axis to an axis, up to the noise of float32 files."""
    linear = np.abs(transform[:3, :3])
    largest = linear.max(axis=1, keepdims=True)
    main = linear > 1e-6 * largest
    return bool((main.sum(axis=0) == 1).all() and (main.sum(axis=1) == 1).all())


def keeps_shape(transform: NDArray[np.float64]) -> bool:
    """Tell whether a transform takes balls to balls, up to the noise of float32 files."""
    linear = transform[:3, :3]
    gram = linear.T @ linear
    scale = np.trace(gram) / 3
    return bool(scale > 0 and np.abs(gram - scale * np.eye(3)).max() <= 1e-6 * scale)


@dataclass(frozen=True, eq=False, slots=True)
class RoundedBox:
    """A box whose sides are powers of two voxels.

    Attributes
    ----------
    low, high
        Lowest and highest corner in voxels (int64, shape (3,)).
    moved, grown
        Voxels by which rounding moved the lowest corner and grew the box, an axis each.
    """

    low: NDArray[np.int64]
    high: NDArray[np.int64]
    moved: tuple[float, float, float]
    grown: tuple[float, float, float]


def round_box(minimum: NDArray[np.float64], maximum: NDArray[np.float64], grid: Grid) -> RoundedBox:
    """Round a box in voxels (float64, shape (3,)) up to powers of two voxels.

    Each side grows to the next power of two. Then on each axis the lowest corner goes to the nearest multiple of the
    largest power of two, at most the smallest side, that lies within :data:`SNAP` voxels. A box inside the grid stays
    inside.
    """
    low = np.rint(minimum * UNITS_PER_VOXEL) / UNITS_PER_VOXEL
    side = np.rint(maximum * UNITS_PER_VOXEL) / UNITS_PER_VOXEL - low
    rounded = np.array([next_power_of_two(float(s)) for s in side], dtype=np.int64)
    corner = np.array([_snapped_corner(float(c), int(rounded.min())) for c in low], dtype=np.int64)
    if (low >= 0).all() and (low + side <= grid.size).all():
        rounded = np.minimum(rounded, grid.size)
        corner = np.clip(corner, 0, grid.size - rounded)
    moved, grown = corner - low, rounded - side
    return RoundedBox(
        corner,
        corner + rounded,
        (float(moved[0]), float(moved[1]), float(moved[2])),
        (float(grown[0]), float(grown[1]), float(grown[2])),
    )


def next_power_of_two(voxels: float) -> int:
    """Give the smallest power of two, at least 1, that is not below a length."""
    power = 1
    while power < voxels:
        power *= 2
    return power


def _snapped_corner(corner: float, largest: int) -> int:
    multiple = largest
    while True:
        nearest = int(np.floor(corner / multiple + 0.5)) * multiple
        if abs(nearest - corner) <= SNAP or multiple == 1:
            return nearest
        multiple //= 2
