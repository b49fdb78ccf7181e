"""Questions about single voxels and regions."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from voxrt.octree import _native
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from voxrt.octree.octree import Octree

Corner: TypeAlias = tuple[int, int, int]

_REGION_LIMIT = 1 << 33


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
    """
    voxels = np.asarray(points)
    if voxels.shape[-1:] != (3,) or not np.issubdtype(voxels.dtype, np.integer):
        raise ValueError(f"points must be integers of shape (..., 3), not {voxels.dtype} of shape {voxels.shape}")
    rows = np.ascontiguousarray(voxels, dtype=np.int64).reshape(-1, 3)
    return _native.materials_at(octree.words, octree.depth, rows).reshape(voxels.shape[:-1])


def count_in_box(octree: Octree, low: Corner, high: Corner) -> dict[int, int]:
    """Count the voxels of a box, exactly.

    Parameters
    ----------
    octree
        The memory.
    low, high
        Voxels from `low` up to and without `high`; what lies outside the world is not counted.

    Returns
    -------
    dict[int, int]
        Voxels by material id, ascending, 0 (empty) included where it occurs.
    """
    counts = _native.count_in_box(octree.words, octree.depth, low, high)
    return {int(material): int(counts[material]) for material in np.flatnonzero(counts)}


def solid_bounds(octree: Octree) -> tuple[Corner, Corner] | None:
    """Find the smallest box (lowest voxel, one behind the highest) of all solid voxels; None where all is empty."""
    return as_bounds(_native.solid_bounds(octree.words, octree.depth))


def as_bounds(bounds: _native.Bounds | None) -> tuple[Corner, Corner] | None:
    """Bounds of the native code as a plain pair."""
    return None if bounds is None else (bounds.low, bounds.high)


def to_dense(octree: Octree, low: Corner = (0, 0, 0), high: Corner | None = None) -> NDArray[np.uint8]:
    """Write a region out voxel by voxel.

    Parameters
    ----------
    octree
        The memory.
    low, high
        Voxels from `low` up to and without `high` (default: the world's end); outside the world is empty.

    Returns
    -------
    NDArray[np.uint8]
        Shape high - low, indexed [x, y, z]: material ids.

    Raises
    ------
    ValueError
        Where `high` lies below `low`.
    DoesNotFitError
        Where the region has more than 2**33 voxels.
    """
    end = (octree.size,) * 3 if high is None else high
    shape = tuple(above - below for below, above in zip(low, end, strict=True))
    if min(shape) < 0:
        raise ValueError(f"the region ends at {end}, below its start {low}")
    volume = shape[0] * shape[1] * shape[2]
    if volume > _REGION_LIMIT:
        raise DoesNotFitError(
            f"the region has {volume} voxels and an array at most {_REGION_LIMIT}; ask for less of it"
        )
    region = np.empty(shape, dtype=np.uint8)
    _native.fill_region(octree.words, octree.depth, low, region)
    return region
