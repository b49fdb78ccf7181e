"""Box colliders in voxels, and their sides rounded up to powers of two voxels.

Rounding is the rule of the report that this project re-implements: a side of 3.5 voxels becomes 4, so that a box is a
few large octants instead of a skin of unit voxels.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec import Struct

from voxrt.voxelize.collider_shapes import box_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.collider_shapes import BoxCollider
    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.scene import SceneObject

Pow2: TypeAlias = Literal["box", "none"]

POW2_CHOICES: tuple[Pow2, ...] = ("box", "none")

UNITS_PER_VOXEL = 4096
"""Vertices are snapped to 1/4096 voxel; from there on coverage is exact."""

SNAP = 1.0
"""The farthest that rounding moves the lowest corner of a box to a multiple of a larger power of two, in voxels."""


def box_in_voxels(item: SceneObject, box: BoxCollider, grid: Grid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the lowest and the highest corner of an object's box, in voxels: float64, shape (3,)."""
    corners = box_corners(box) @ item.transform[:3, :3].T + item.transform[:3, 3]
    corners = (corners - np.array(grid.origin)) / grid.voxel_size
    return corners.min(axis=0), corners.max(axis=0)


def keeps_axes(transform: NDArray[np.float64]) -> bool:
    """Tell whether a transform maps each axis to an axis, up to the rounding of float32 files."""
    linear = np.abs(transform[:3, :3])
    largest = linear.max(axis=1, keepdims=True)
    main = linear > 1e-6 * largest
    return bool((main.sum(axis=0) == 1).all() and (main.sum(axis=1) == 1).all())


def keeps_shape(transform: NDArray[np.float64]) -> bool:
    """Tell whether a transform maps balls to balls, up to the rounding of float32 files."""
    linear = transform[:3, :3]
    gram = linear.T @ linear
    scale = np.trace(gram) / 3
    return bool(scale > 0 and np.abs(gram - scale * np.eye(3)).max() <= 1e-6 * scale)


class RoundedBox(Struct, frozen=True, eq=False):
    """A box whose sides are powers of two voxels."""

    # int64, shape (3,): lowest and highest corner, in voxels.
    low: NDArray[np.int64]
    high: NDArray[np.int64]
    # Voxels by which rounding moved the lowest corner and grew the box, per axis.
    moved: tuple[float, float, float]
    grown: tuple[float, float, float]


def round_box(minimum: NDArray[np.float64], maximum: NDArray[np.float64], limit: int | None = None) -> RoundedBox:
    """Round the sides of a box up to powers of two voxels.

    On each axis the lowest corner then moves to the nearest multiple of the largest power of two, at most the smallest
    side, that lies within :data:`SNAP` voxels. The corners are float64, shape (3,), in voxels. A box inside a grid of
    `limit` voxels per side stays inside; None is no limit.
    """
    low = np.rint(minimum * UNITS_PER_VOXEL) / UNITS_PER_VOXEL
    side = np.rint(maximum * UNITS_PER_VOXEL) / UNITS_PER_VOXEL - low
    rounded = np.array([next_power_of_two(float(s)) for s in side], dtype=np.int64)
    corner = np.array([_snapped_corner(float(c), int(rounded.min())) for c in low], dtype=np.int64)
    if limit is not None and (low >= 0).all() and (low + side <= limit).all():
        rounded = np.minimum(rounded, limit)
        corner = np.clip(corner, 0, limit - rounded)
    moved, grown = corner - low, rounded - side
    return RoundedBox(
        corner,
        corner + rounded,
        (float(moved[0]), float(moved[1]), float(moved[2])),
        (float(grown[0]), float(grown[1]), float(grown[2])),
    )


def next_power_of_two(voxels: float) -> int:
    """Return the smallest power of two, at least 1, that is not below a length."""
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
