"""Many rays at once through a small world of unit voxels, exactly. Knows no octree, no mirroring and no common scale.

Each ray walks from cell to cell. The plane ahead on axis a is reached at the ray's parameter t_a = (p_a - o_a) / d_a;
two such fractions are compared by multiplying out, in 64-bit integers. Equal parameters are crossed in the order of
the axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def trace_batch(
    voxels: NDArray[np.uint8], origins: NDArray[np.int64], directions: NDArray[np.int64]
) -> tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.int64]]:
    """Give material, face and cell of each ray's first solid cell.

    `voxels` is (S, S, S) indexed [x, y, z]; `origins` (N, 3) in 1/16 voxel, `directions` (N, 3), each below 2**20 in
    size. A miss gives material 0, face 3 and cell -1.
    """
    origins, directions = origins.astype(np.int64), directions.astype(np.int64)
    side = len(voxels)
    count = len(origins)
    material = np.zeros(count, np.uint8)
    face = np.full(count, 3, np.uint8)
    found = np.full((count, 3), -1, np.int64)

    rising = directions > 0
    falling = directions < 0
    floor = origins // 16
    on_plane = origins % 16 == 0
    cell = np.where(falling & on_plane, floor - 1, floor)
    crossed = np.full(count, 3, np.uint8)
    walking = np.arange(count)
    while len(walking):
        here = cell[walking]
        inside = np.all((here >= 0) & (here < side), axis=1)
        x, y, z = np.where(inside[:, None], here, 0).T
        seen = np.where(inside, voxels[x, y, z], 0)
        hit = walking[seen > 0]
        material[hit] = seen[seen > 0]
        face[hit] = crossed[hit]
        found[hit] = cell[hit]

        # A ray goes on while it has not hit and no axis has left, or can never reach, the world's range.
        lost_low = (here < 0) & ~rising[walking]
        lost_high = (here >= side) & ~falling[walking]
        resting = np.all(directions[walking] == 0, axis=1)
        walking = walking[(seen == 0) & ~np.any(lost_low | lost_high, axis=1) & ~resting]

        ahead = np.where(rising[walking], cell[walking] + 1, cell[walking]) * 16
        numerator = np.abs(ahead - origins[walking])
        denominator = np.abs(directions[walking])
        first = np.zeros(len(walking), np.int64)
        for axis in (1, 2):
            rows = np.arange(len(walking))
            best_numerator, best_denominator = numerator[rows, first], denominator[rows, first]
            sooner = numerator[:, axis] * best_denominator < best_numerator * denominator[:, axis]
            first = np.where((denominator[:, axis] > 0) & (sooner | (best_denominator == 0)), axis, first)
        cell[walking, first] += np.where(rising[walking, first], 1, -1)
        crossed[walking] = first
    return material, face, found
