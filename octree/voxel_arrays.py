"""Octrees written out as arrays: every voxel of a region, or the solid voxels one by one."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.leaf_arrays import leaves
from voxrt.octree.morton import positions
from voxrt.octree.octree import Octree
from voxrt.octree.query import as_box
from voxrt.octree.statistics import census
from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.arguments import instance, whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.query import Corner

ARRAY_LIMIT = 1 << 31
"""Bytes of the largest array that :func:`to_dense` and :func:`to_points` make unless told otherwise: 2 GiB."""

_CHUNK = 4096  # leaves at a time
_SMALL_LEVEL, _LARGE_LEVEL = 3, 6


def to_dense(
    octree: Octree, low: Corner = (0, 0, 0), high: Corner | None = None, *, limit: int = ARRAY_LIMIT
) -> NDArray[np.uint8]:
    """Return the material of every voxel of a region as an array.

    Parameters
    ----------
    octree
        The memory.
    low, high
        Integers (x, y, z): the lowest voxel, and one behind the highest (default: the world's end). Outside the world
        is empty.
    limit
        The largest size of the array, in bytes: one per voxel.

    Returns
    -------
    NDArray[np.uint8]
        Shape high - low, indexed [x, y, z]: material ids.

    Raises
    ------
    TypeError, ValueError
        A corner is not three integers, or `high` lies below `low`.
    DoesNotFitError
        The array would be larger than `limit`.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> to_dense(from_points([[1, 2, 3]], [7], depth=2))[1, 2]
    array([0, 0, 0, 7], dtype=uint8)
    """
    instance("octree", octree, Octree)
    start, end = as_box(low, (octree.size,) * 3 if high is None else high)
    shape = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    volume = shape[0] * shape[1] * shape[2]
    if volume > whole("limit", limit, 0, 1 << 62):
        raise DoesNotFitError(
            f"the region of {shape[0]} x {shape[1]} x {shape[2]} voxels takes {_size(volume)} as an array, above the "
            f"limit of {_size(limit)}; ask for a part of it (low, high), or pass limit={volume}"
        )
    region = np.empty(shape, dtype=np.uint8)
    _native.fill_region(octree.words, octree.depth, start, region)
    return region


def to_points(octree: Octree, *, limit: int = ARRAY_LIMIT) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """Return the solid voxels one by one: what :func:`from_points` takes.

    Parameters
    ----------
    octree
        The memory.
    limit
        The largest size of the arrays, in bytes: 13 per voxel.

    Returns
    -------
    points
        int32, shape (N, 3): voxel coordinates (x, y, z), in Morton order.
    materials
        uint8, shape (N,): material ids 1 … 255.

    Raises
    ------
    DoesNotFitError
        The arrays would be larger than `limit`.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> points, materials = to_points(from_points([[1, 2, 3], [0, 0, 1]], [7, 5], depth=2))
    >>> points.tolist(), materials.tolist()
    ([[0, 0, 1], [1, 2, 3]], [5, 7])
    """
    count = census(instance("octree", octree, Octree)).solid_voxels
    if 13 * count > whole("limit", limit, 0, 1 << 62):
        raise DoesNotFitError(
            f"{count:,} solid voxels take {_size(13 * count)} one by one, above the limit of {_size(limit)}; take the "
            f"octants instead (voxrt.octree.leaves), or pass limit={13 * count}"
        )
    points, materials = np.empty((count, 3), np.int32), np.empty(count, np.uint8)
    filled = 0
    for part in leaves(octree, solid_only=True, chunk=_CHUNK):
        volumes = np.int64(1) << 3 * part.levels.astype(np.int64)
        starts = filled + np.cumsum(volumes) - volumes
        filled += int(volumes.sum())
        materials[filled - volumes.sum() : filled] = np.repeat(part.materials, volumes)
        for level in np.unique(part.levels).tolist():
            some = part.levels == level
            _fill(points, starts[some], part.corners[some], level)
    return points, materials


def _fill(points: NDArray[np.int32], starts: NDArray[np.int64], corners: NDArray[np.int32], level: int) -> None:
    """Write the voxels of leaves of one level into `points`, each leaf's from its start on."""
    if level <= _SMALL_LEVEL:
        rows = starts[:, None] + np.arange(1 << 3 * level)
        points[rows] = corners[:, None] + _offsets(level)
        return
    part = min(level, _LARGE_LEVEL)  # larger leaves are written in parts of this level
    offsets, volume = _offsets(part), 1 << 3 * part
    for start, corner in zip(starts.tolist(), corners, strict=True):
        for number, low in enumerate(corner + (_offsets(level - part) << part)):
            first = start + number * volume
            np.add(offsets, low, out=points[first : first + volume])


@cache
def _offsets(level: int) -> NDArray[np.int32]:
    """Return the voxels of an octant of 2**level voxels per side in Morton order: int32, shape (8**level, 3)."""
    return positions(np.arange(1 << 3 * level), level)


def _size(count: int) -> str:
    return f"{count:,} bytes ({count / 2**30:,.1f} GiB)"
