"""Which sides of octants cannot be seen from anywhere: those that touch solid ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.morton import morton

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.leaf_arrays import Leaves


def covered_sides(solid: Leaves) -> NDArray[np.bool_]:
    """Tell which sides (bool, shape (N, 6): low and high on x, y, z) of N solid leaves are covered by the others.

    The leaves are all that is solid, in Morton order, and do not overlap. A side is as covered as the area in which
    others touch it is large. Two leaves that touch do so with the whole side of the smaller one, so that looking for
    the leaf behind one voxel of each side finds all pairs: N log N.
    """
    corners, levels = solid.corners.astype(np.int64), solid.levels.astype(np.int64)
    codes = morton(corners)
    areas = np.int64(1) << 2 * levels
    covered = np.zeros((len(levels), 6), np.int64)
    for axis in range(3):
        for end, step in enumerate((-np.ones_like(levels), np.int64(1) << levels)):
            beside = corners.copy()
            beside[:, axis] += step
            rows = np.flatnonzero((beside[:, axis] >= 0) & (beside[:, axis] < 1 << 16))
            sought = morton(beside[rows])
            found = np.searchsorted(codes, sought, side="right") - 1
            touches = (
                (found >= 0) & (levels[found] >= levels[rows]) & (sought - codes[found] < areas[found] << levels[found])
            )
            rows, found = rows[touches], found[touches]
            covered[rows, 2 * axis + end] += areas[rows]
            larger = levels[found] > levels[rows]
            np.add.at(covered[:, 2 * axis + 1 - end], found[larger], areas[rows[larger]])
    wholly: NDArray[np.bool_] = covered == areas[:, None]
    return wholly
