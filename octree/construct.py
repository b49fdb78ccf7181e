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


def from_points(points: NDArray[np.integer], materials: NDArray[np.integer], depth: int) -> Octree:
    """Build the octree of solid voxels given one by one.

    Parameters
    ----------
    points
        Integers, shape (N, 3): voxel coordinates (x, y, z), 0 … 2**depth - 1. Where one repeats, the first counts.
    materials
        Integers, shape (N,): material ids 1 … 255.
    depth
        Levels of the world, 1 … 16.

    Raises
    ------
    ValueError
        Where a shape, a coordinate or a material is none of these.
    """
    if points.ndim != 2 or points.shape[1] != 3 or materials.shape != points.shape[:1]:
        raise ValueError(f"points and materials must be (N, 3) and (N,), not {points.shape} and {materials.shape}")
    if len(points) and (points.min() < 0 or int(points.max()) >> depth):
        raise ValueError(f"points must lie in 0 ... {(1 << depth) - 1}, not {points.min()} ... {points.max()}")
    if len(points) and (materials.min() < 1 or materials.max() > 255):
        raise ValueError(f"materials must be 1 ... 255, not {materials.min()} ... {materials.max()}")
    codes = np.zeros(len(points), dtype=np.uint64)
    for axis in range(3):
        codes |= _every_third_bit(points[:, axis].astype(np.uint64)) << np.uint64(axis)
    codes, first = np.unique(codes, return_index=True)
    return Octree(depth, _native.build_points(codes, materials[first].astype(np.uint8), depth))


def _every_third_bit(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Bit k of each value (16 bits) at bit 3k."""
    for shift, mask in (
        (16, 0x00FF0000FF0000FF),
        (8, 0xF00F00F00F00F00F),
        (4, 0x30C30C30C30C30C3),
        (2, 0x9249249249249249),
    ):
        values = (values | values << np.uint64(shift)) & np.uint64(mask)
    return values
