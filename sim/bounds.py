"""Where the solid voxels of a memory are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Octree

_OCTANT_CORNERS = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], dtype=np.int64)


def solid_bounds(octree: Octree) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    """Find the box around all solid voxels, or None where there are none.

    Returns
    -------
    minimum, maximum
        int64, shape (3,), voxels: the box covers minimum <= cell < maximum.
    """
    # Down: the distinct blocks of each level. Up again: the box of each, in voxels from its own corner.
    words = octree.words
    levels = [np.zeros(1, dtype=np.int64)]
    while True:
        block = levels[-1][:, None] + (np.arange(8) if len(levels) > 1 else np.zeros(1, dtype=np.int64))
        pointers = words[block][words[block] >> 31 == 0]
        if not len(pointers):
            break
        levels.append(np.unique(pointers).astype(np.int64))

    below = np.empty(0, dtype=np.int64)
    low = high = np.empty((0, 3), dtype=np.int64)
    for level in range(len(levels) - 1, -1, -1):
        corners = _OCTANT_CORNERS if level else _OCTANT_CORNERS[:1]
        side = 1 << (octree.depth - level)
        octants = words[levels[level][:, None] + np.arange(len(corners))]
        first = np.full((*octants.shape, 3), np.iinfo(np.int64).max, dtype=np.int64)
        last = np.full((*octants.shape, 3), -1, dtype=np.int64)
        solid = (octants >> 31 == 1) & (octants & 0xFF != 0)
        first[solid], last[solid] = 0, side
        inner = octants >> 31 == 0
        rows = np.searchsorted(below, octants[inner])
        first[inner], last[inner] = low[rows], high[rows]
        filled = last >= 0
        first[filled] += np.broadcast_to(corners * side, first.shape)[filled]
        last[filled] += np.broadcast_to(corners * side, last.shape)[filled]
        below, low, high = levels[level], first.min(axis=1), last.max(axis=1)
    return (low[0], high[0]) if high[0, 0] >= 0 else None
