"""The three octree memories published with the report, depth 10."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from assets import asset

if TYPE_CHECKING:
    from numpy.typing import NDArray

SEED_DEPTH = 10
HOUSE_CAMERA = ((450 * 16, 600 * 16, 300 * 16), (0, 0, 90), (1, 0, 0), (0, 1, 0))


def seed_words(name: str) -> NDArray[np.uint32]:
    """Give a published memory in the report dialect: its tags hold the material in their lowest 3 bits."""
    path = asset(f"../seed-memories/{name}.mem")
    words = np.array([int(line, 16) for line in path.read_text().split()], np.uint32)
    return np.where(words >> 31 == 1, 0xFFFFFF00 | words & 7, words).astype(np.uint32)


class PointQueries:
    """A memory seen as voxels: indexing with three arrays of coordinates gives materials."""

    def __init__(self, words: NDArray[np.uint32], depth: int) -> None:
        self.words, self.depth = words, depth

    def __len__(self) -> int:
        return 1 << self.depth

    def __getitem__(self, cell: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]) -> NDArray[np.uint8]:
        x, y, z = cell
        word = np.full(len(x), self.words[0])
        for bit in range(self.depth - 1, -1, -1):
            octant = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2
            pointer = word >> 31 == 0
            word = np.where(pointer, self.words[np.where(pointer, word + octant, 0)], word)
        return (word & 0xFF).astype(np.uint8)
