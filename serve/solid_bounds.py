"""The box around the solid voxels of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ..board.scene import Scene
    from ..board.view import Triple

_OCTANTS = np.array([[octant >> axis & 1 for axis in range(3)] for octant in range(8)], dtype=np.int64)


def solid_bounds(scene: Scene) -> tuple[Triple, Triple] | None:
    """Return the lowest solid voxel on each axis, and one behind the highest; None where all is empty.

    A block that several pointers share is read once per level: blocks are collected from the root down, and their
    boxes are joined from the leaves up.

    Parameters
    ----------
    scene
        Its octree memory is valid.
    """
    words, side = scene.words, 1 << scene.depth
    blocks = [np.zeros(0, dtype=np.int64)] * scene.depth  # addresses of the blocks of each level, from the root down
    reached = words[:1]
    for level in range(scene.depth):
        blocks[level] = np.unique(reached[reached >> 31 == 0]).astype(np.int64)
        reached = words[blocks[level][:, None] + np.arange(8)]
    below = np.zeros(0, dtype=np.int64)
    lows, highs = np.zeros((0, 3), dtype=np.int64), np.zeros((0, 3), dtype=np.int64)
    for level in reversed(range(scene.depth)):
        octant_side = side >> (level + 1)
        low, high = _boxes_of(words[blocks[level][:, None] + np.arange(8)], octant_side, below, lows, highs)
        empty = (high <= low).any(axis=2, keepdims=True)
        corners = _OCTANTS * octant_side
        lows = np.where(empty, side, low + corners).min(axis=1)
        highs = np.where(empty, 0, high + corners).max(axis=1)
        below = blocks[level]
    low, high = _boxes_of(words[:1][None], side, below, lows, highs)
    if (high <= low).any():
        return None
    (x, y, z), (end_x, end_y, end_z) = low[0, 0].tolist(), high[0, 0].tolist()
    return (x, y, z), (end_x, end_y, end_z)


def _boxes_of(
    words: np.ndarray, side: int, blocks: np.ndarray, lows: np.ndarray, highs: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the box of what each word (shape (N, 8)) holds, relative to its octant; empty ones end at 0."""
    solid = (words >> 31 == 1) & (words & 0xFF != 0)
    low = np.zeros((*words.shape, 3), dtype=np.int64)
    high = np.where(solid[..., None], side, low)
    pointer = words >> 31 == 0
    rows = np.searchsorted(blocks, words[pointer])
    low[pointer], high[pointer] = lows[rows], highs[rows]
    return low, high
