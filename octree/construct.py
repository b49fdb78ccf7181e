"""Voxels or a dense array to an octree with equal blocks shared."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.morton import morton
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.voxelize import DoesNotFitError, Voxels
from voxrt.voxelize.arguments import instance, whole, whole_array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def build(voxels: Voxels, *, threads: int = 0) -> Octree:
    """Build the octree of sparse voxels, bottom-up.

    Masks collapse by bit operations. Equal blocks meet in a flat hash table. The words come out breadth-first by first
    visit. The cost grows with the bricks and octants, never with the volume. Equal voxels give equal bytes, however
    they are cut into bricks and octants, on any number of threads.

    Parameters
    ----------
    voxels
        What the voxelizer made.
    threads
        Threads to use; 0 takes one per core.

    Returns
    -------
    Octree
        Equal blocks are stored once.

    Raises
    ------
    ValueError
        The arrays break the contract of :class:`~voxrt.voxelize.Voxels`.

    Examples
    --------
    >>> from voxrt import voxelize
    >>> scene = voxelize.load("examples/house.obj")
    >>> grid = voxelize.fit_grid(scene, depth=4)
    >>> build(voxelize.voxelize(scene, grid).voxels)
    <Octree: depth 4, 721 words>
    """
    voxels = instance("voxels", voxels, Voxels)
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
        whole("threads", threads, 0, 1024),
    )
    return Octree(voxels.depth, words)


def from_dense(materials: ArrayLike) -> Octree:
    """Build the octree of a dense array.

    Parameters
    ----------
    materials
        Integers, shape (X, Y, Z), indexed [x, y, z]: material ids 0 (empty) … 255. The world is the smallest cube with
        a power of two voxels per side (at least 2) that holds the array. It is empty beyond the array.

    Returns
    -------
    Octree
        Equal blocks are stored once.

    Raises
    ------
    TypeError, ValueError
        The array is not three-dimensional, not of integers, empty, or holds an id outside 0 … 255.
    DoesNotFitError
        A side is longer than 2**16.

    Examples
    --------
    >>> import numpy as np
    >>> world = np.zeros((8, 8, 8), np.uint8)
    >>> world[:, 0] = 1
    >>> from_dense(world)
    <Octree: depth 3, 25 words>
    """
    array = np.asarray(materials)
    if array.ndim == 3 and max(array.shape) > 1 << MAX_DEPTH:
        raise DoesNotFitError(
            f"{max(array.shape)} voxels per side do not fit depth {MAX_DEPTH}; cut the array into parts"
        )
    cells = whole_array("materials", array, ("X", "Y", "Z"), np.uint8, low=0, high=255)
    if cells.size == 0:
        raise ValueError(f"materials must hold a voxel, and its shape is {cells.shape}")
    depth = max(1, (max(cells.shape) - 1).bit_length())
    return Octree(depth, _native.build_dense(np.ascontiguousarray(cells), depth))


def from_points(points: ArrayLike, materials: ArrayLike, depth: int) -> Octree:
    """Build the octree of solid voxels given one by one.

    Parameters
    ----------
    points
        Integers, shape (N, 3): voxel coordinates (x, y, z), 0 … 2**depth - 1. Where one repeats, the first counts.
    materials
        Integers, shape (N,): material ids 1 … 255.
    depth
        Levels of the world, 1 … 16.

    Returns
    -------
    Octree
        Equal blocks are stored once.

    Raises
    ------
    TypeError, ValueError
        A shape, a coordinate, a material or the depth is none of these.

    Examples
    --------
    >>> tree = from_points([[0, 0, 0], [3, 3, 3]], [1, 2], depth=2)
    >>> tree
    <Octree: depth 2, 25 words>
    """
    depth = whole("depth", depth, 1, MAX_DEPTH)
    places = whole_array("points", points, ("N", 3), np.int64, low=0, high=(1 << depth) - 1)
    ids = whole_array("materials", materials, ("N",), np.uint8, low=1, high=255)
    if len(ids) != len(places):
        raise ValueError(f"points and materials must be (N, 3) and (N,), not {places.shape} and {ids.shape}")
    codes, first = np.unique(morton(places).astype(np.uint64), return_index=True)
    return Octree(depth, _native.build_points(codes, ids[first], depth))
