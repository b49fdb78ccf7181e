"""The native voxelizer (C++): parts in grid space to sparse voxels."""

import numpy as np
from numpy.typing import NDArray

class OutOfReach(ValueError):
    """A part reaches beyond 2**18 voxels from the grid's corner, or is not a number; the argument is its object."""

def voxelize(
    depth: int,
    meshes: list[tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.uint8]]],
    kinds: NDArray[np.uint8],
    mesh_of: NDArray[np.int32],
    frames: NDArray[np.float64],
    materials: NDArray[np.uint8],
    objects_of: NDArray[np.int32],
    objects: int,
    fill: bool,
    threads: int,
) -> tuple[
    NDArray[np.uint64],
    NDArray[np.uint64],
    NDArray[np.uint8],
    NDArray[np.int32],
    NDArray[np.uint8],
    NDArray[np.uint64],
    NDArray[np.uint8],
    NDArray[np.uint8],
    NDArray[np.int64],
    NDArray[np.uint8],
]:
    """Voxelize P parts; where they compete, the first keeps the voxel.

    Parameters
    ----------
    depth
        The grid's depth, 1 … 16.
    meshes
        Positions (V, 3), triangles (T, 3), materials (T,) or (0,), in their objects' frames; shared by parts.
    kinds
        Shape (P,): 0 mesh, 1 axis-aligned box, 2 ball, 3 ellipsoid.
    mesh_of
        Shape (P,): index into `meshes`, for kind 0.
    frames
        Shape (P, 12), in 1/4096 voxel. Kinds 0 and 3: rows of the 3x4 affine map to grid space (of the mesh, of the
        unit ball). Kind 1: minimum and maximum. Kind 2: centre and radius.
    materials
        Shape (P,): 1 … 255, or 0 where each triangle has its own.
    objects_of
        Shape (P,): ascending, below `objects`.
    fill
        Claim what parts enclose, not their shells alone.
    threads
        0 takes as many as the machine has. The result does not depend on it.

    Returns
    -------
    The arrays of :class:`voxrt.voxelize.Voxels` in the order of its attributes, then int64 voxels and uint8 modes
    (0 surface, 1 exact, 2 winding) by object.

    Raises
    ------
    OutOfReach
        See there.
    ValueError
        An array of the wrong shape or with an index out of range.
    """

def convex_hull(positions: NDArray[np.float64], frame: NDArray[np.float64]) -> NDArray[np.int32]:
    """Triangulate the convex hull of points as they lie in grid space, in exact arithmetic.

    Parameters
    ----------
    positions
        Shape (V, 3), in the object's frame.
    frame
        Shape (3, 4): rows of the affine map to grid space, in 1/4096 voxel.

    Returns
    -------
    int32, shape (T, 3): rows of `positions`, counter-clockwise seen from outside. Points in one plane give their
    polygon twice, facing both ways; points on one line give nothing.
    """
