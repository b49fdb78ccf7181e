"""Questions about single voxels and regions."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from voxrt.octree import _native
from voxrt.octree.octree import Octree
from voxrt.voxelize.arguments import instance, whole_array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Corner: TypeAlias = tuple[int, int, int]

_FARTHEST = 1 << 20
"""Corners of boxes lie within this on each side of zero."""


def material_at(octree: Octree, points: ArrayLike) -> NDArray[np.uint8]:
    """Look up the material of voxels.

    Parameters
    ----------
    octree
        The memory.
    points
        Integers, shape (..., 3): voxel coordinates (x, y, z), grid frame. Outside the world is empty.

    Returns
    -------
    NDArray[np.uint8]
        Shape (...): material ids.

    Raises
    ------
    TypeError, ValueError
        The points are not integers, or of another shape.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> tree = from_points([[1, 2, 3]], [7], depth=2)
    >>> material_at(tree, [[1, 2, 3], [0, 0, 0], [-1, 9, 0]])
    array([7, 0, 0], dtype=uint8)
    """
    instance("octree", octree, Octree)
    rows, shape = as_points(points)
    return _native.materials_at(octree.words, octree.depth, rows).reshape(shape)


def count_in_box(octree: Octree, low: Corner, high: Corner) -> dict[int, int]:
    """Count the voxels of a box, exactly.

    Parameters
    ----------
    octree
        The memory.
    low, high
        Integers (x, y, z): the lowest voxel, and one behind the highest. What lies outside the world is not counted.

    Returns
    -------
    dict[int, int]
        Voxels by material id, ascending, 0 (empty) included where it occurs.

    Raises
    ------
    TypeError, ValueError
        A corner is not three integers, or `high` lies below `low`.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> count_in_box(from_points([[1, 2, 3]], [7], depth=2), (0, 0, 0), (4, 4, 4))
    {0: 63, 7: 1}
    """
    instance("octree", octree, Octree)
    counts = _native.count_in_box(octree.words, octree.depth, *as_box(low, high))
    return {int(material): int(counts[material]) for material in np.flatnonzero(counts)}


def solid_bounds(octree: Octree) -> tuple[Corner, Corner] | None:
    """Find the smallest box of all solid voxels: its lowest voxel, and one behind its highest.

    Returns
    -------
    tuple[Corner, Corner] or None
        None if all is empty.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> solid_bounds(from_points([[1, 2, 3], [3, 2, 1]], [7, 7], depth=2))
    ((1, 2, 1), (4, 3, 4))
    """
    instance("octree", octree, Octree)
    return _native.solid_bounds(octree.words, octree.depth)


def as_points(points: ArrayLike) -> tuple[NDArray[np.int64], tuple[int, ...]]:
    """Check voxels, integers of shape (..., 3); return them as rows, and the shape without the last axis."""
    voxels = np.asarray(points)
    if voxels.shape[-1:] != (3,):
        raise ValueError(f"points must have shape (..., 3), not {voxels.shape}")
    rows = whole_array("points", voxels.reshape(-1, 3), ("N", 3), np.int64, low=-(1 << 62), high=1 << 62)
    return np.ascontiguousarray(rows), voxels.shape[:-1]


def as_box(low: object, high: object) -> tuple[Corner, Corner]:
    """Check the corners of a box; TypeError or ValueError where they are none."""
    start, end = as_corner("low", low), as_corner("high", high)
    if any(above < below for below, above in zip(start, end, strict=True)):
        raise ValueError(f"the box ends at {end}, below its start {start}")
    return start, end


def as_corner(name: str, value: object) -> Corner:
    """Check three integers; TypeError or ValueError where they are none."""
    x, y, z = whole_array(name, value, (3,), np.int64, low=-_FARTHEST, high=_FARTHEST).tolist()
    return x, y, z
