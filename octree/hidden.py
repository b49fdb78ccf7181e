"""Which octants cannot be seen from anywhere: all of their six sides touch solid ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.leaves import Leaves

_SPREADS = (
    (16, 0x0000FF0000FF),
    (8, 0x00F00F00F00F),
    (4, 0x0C30C30C30C3),
    (2, 0x249249249249),
)


def hidden(solid: Leaves) -> NDArray[np.bool_]:
    """Tell which of some solid leaves are covered on all six sides by the others.

    A leaf is as covered as the area in which others touch it is large. Two leaves that touch do so with the whole side
    of the smaller one, so that looking for the leaf behind one voxel of each side finds all pairs: N log N.

    Parameters
    ----------
    solid
        N solid leaves that do not overlap, in Morton order. Nothing is solid beside them.

    Returns
    -------
    NDArray[np.bool_]
        Shape (N,).
    """
    corners, levels = solid.corners.astype(np.int64), solid.levels.astype(np.int64)
    codes = _morton(corners)
    areas = np.int64(1) << 2 * levels
    covered = np.zeros_like(areas)
    for axis in range(3):
        for step in (-np.ones_like(levels), np.int64(1) << levels):
            beside = corners.copy()
            beside[:, axis] += step
            rows = np.flatnonzero((beside[:, axis] >= 0) & (beside[:, axis] < 1 << 16))
            sought = _morton(beside[rows])
            found = np.searchsorted(codes, sought, side="right") - 1
            touches = (
                (found >= 0) & (levels[found] >= levels[rows]) & (sought - codes[found] < areas[found] << levels[found])
            )
            rows, found = rows[touches], found[touches]
            covered[rows] += areas[rows]
            larger = levels[found] > levels[rows]
            np.add.at(covered, found[larger], areas[rows[larger]])
    wholly: NDArray[np.bool_] = covered == 6 * areas
    return wholly


def _morton(voxels: NDArray[np.int64]) -> NDArray[np.int64]:
    """Interleave 16 bits of each of x, y, z (shape (N, 3)), x lowest, as octant indices do."""
    code = np.zeros(len(voxels), np.int64)
    for axis in range(3):
        spread = voxels[:, axis].copy()
        for shift, mask in _SPREADS:
            spread = (spread | spread << shift) & mask
        code |= spread << axis
    return code
