"""The octree as the hardware sees it: memory words in the report dialect.

Word 0 is the root. A word with bit 31 clear is a pointer, the word address of octant 0 of a block of 8; a word
``0xFFFFFFmm`` is a leaf of material mm (0 = empty). Octant index = {z, y, x}. Blocks stand at 1 + 8k, breadth-first by
first visit; equal blocks are stored once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MAX_DEPTH = 16
"""The most levels below the root: 65 536 voxels a side."""


@dataclass(frozen=True, eq=False, slots=True)
class Octree:
    """A valid octree memory.

    Attributes
    ----------
    depth
        Levels below the root, 1 … 16: the world is 2**depth voxels a side.
    words
        uint32, shape (1 + 8 * blocks,), read-only, report dialect.
    """

    depth: int
    words: NDArray[np.uint32]

    @property
    def size(self) -> int:
        """Voxels a side."""
        return 1 << self.depth

    @property
    def blocks(self) -> int:
        """How many blocks of 8 words the memory holds."""
        return (len(self.words) - 1) // 8
