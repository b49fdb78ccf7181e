"""The octree as the hardware sees it: memory words in the report dialect.

:mod:`voxrt.octree.words` defines words. Blocks stand breadth-first by first visit; equal blocks are stored once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MAX_DEPTH = 16
"""The most levels below the root: 65,536 voxels per side."""


class Octree(Value, frozen=True, eq=False, weakref=True):
    """A valid octree memory. :func:`build`, :func:`from_dense`, :func:`from_points` and :func:`decode` make one.

    Attributes
    ----------
    depth
        Levels below the root, 1 … 16: the world has 2**depth voxels per side.
    words
        uint32, shape (1 + 8 * blocks,), read-only, report dialect.
    means
        uint8, shape (blocks,), read-only: the mean material of each block, which a ray shows that stops there; 0 where
        none does. None for a memory without level of detail: :func:`with_means` gives it some.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import from_dense
    >>> tree = from_dense(np.ones((4, 4, 3), np.uint8))
    >>> tree
    <Octree: depth 2, 17 words>
    >>> tree.size, tree.blocks
    (4, 2)
    """

    depth: int
    words: NDArray[np.uint32]
    means: NDArray[np.uint8] | None = None

    def __repr__(self) -> str:
        return f"<Octree: depth {self.depth}, {len(self.words):,} words>"

    @property
    def size(self) -> int:
        """Voxels per side."""
        return 1 << self.depth

    @property
    def blocks(self) -> int:
        """Blocks of 8 words in the memory."""
        return (len(self.words) - 1) // 8
