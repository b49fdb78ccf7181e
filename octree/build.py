"""Voxels or a dense array to an octree with equal blocks shared."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize import Voxels


def build(voxels: Voxels, *, threads: int = 0) -> Octree:
    """Build the octree of sparse voxels, bottom-up.

    Masks collapse by bit operations, equal blocks meet in a flat hash table, and the words come out breadth-first by
    first visit. Cost grows with the bricks and octants, never with the volume; equal voxels give equal bytes, however
    they are cut into bricks and octants and on however many threads.

    Parameters
    ----------
    voxels
        What the voxelizer made.
    threads
        How many threads to use; 0 for as many as the machine has.

    Raises
    ------
    ValueError
        Where the arrays break the contract of :class:`~voxrt.voxelize.Voxels`.
    """
    words = _native.build(
        voxels.depth,
        np.ascontiguousarray(voxels.brick_codes),
        np.ascontiguousarray(voxels.brick_masks),
        np.ascontiguousarray(voxels.brick_materials),
        np.ascontiguousarray(voxels.brick_rows),
        np.ascontiguousarray(voxels.cells),
        np.ascontiguousarray(voxels.octant_codes),
        np.ascontiguousarray(voxels.octant_levels),
        np.ascontiguousarray(voxels.octant_materials),
        threads,
    )
    return Octree(voxels.depth, words)


def from_dense(materials: NDArray[np.integer]) -> Octree:
    """Build the octree of a dense array.

    Parameters
    ----------
    materials
        Any integer type, shape (X, Y, Z), indexed [x, y, z]: material ids 0 (empty) … 255. The world is the smallest
        cube of a power of two that holds the array (at least 2 voxels a side), empty beyond it.

    Raises
    ------
    ValueError
        Where the array is not three-dimensional, not of integers, empty, or holds an id outside 0 … 255.
    DoesNotFitError
        Where a side is longer than 2**16.
    """
    if materials.ndim != 3 or not np.issubdtype(materials.dtype, np.integer):
        raise ValueError(
            f"materials must be integers of shape (X, Y, Z), not {materials.dtype} of shape {materials.shape}"
        )
    if materials.size == 0:
        raise ValueError(f"materials must hold a voxel, and its shape is {materials.shape}")
    lowest, highest = int(materials.min()), int(materials.max())
    if lowest < 0 or highest > 255:
        raise ValueError(f"materials must be 0 ... 255, and the array holds {lowest} ... {highest}")
    depth = max(1, (max(materials.shape) - 1).bit_length())
    if depth > MAX_DEPTH:
        raise DoesNotFitError(
            f"{max(materials.shape)} voxels a side do not fit depth {MAX_DEPTH}; cut the array in parts"
        )
    return Octree(depth, _native.build_dense(np.ascontiguousarray(materials, dtype=np.uint8), depth))
