"""What changes in a memory when its octree was edited."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.words import EMPTY
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Patch(Value, frozen=True, eq=False):
    """Writes that give a memory the octree of a commit, as :meth:`World.commit` returns them.

    All blocks are ones that no live root reaches: frames of these roots may be drawn while they are written. The word
    of the root comes last.

    Attributes
    ----------
    root
        The address of the word that is the new root: what the register ``root`` takes, after all is written.
    root_word
        What stands there, report dialect.
    addresses
        uint32, shape (N,), ascending: the word addresses of the blocks to write.
    blocks
        uint32, shape (N, 8), report dialect: their words.
    """

    root: int
    root_word: int
    addresses: NDArray[np.uint32]
    blocks: NDArray[np.uint32]

    def __repr__(self) -> str:
        return f"<Patch: {len(self.addresses):,} blocks, root at word {self.root}>"

    @property
    def words(self) -> int:
        """Words that it writes."""
        return self.blocks.size + 1

    @property
    def end(self) -> int:
        """The address behind the last word that it writes."""
        return max(self.root + 1, int(self.addresses[-1]) + 8 if len(self.addresses) else 0)

    def apply(self, words: NDArray[np.uint32]) -> NDArray[np.uint32]:
        """Return a memory with the patch; `words`, uint32, shape (N,), stay as they are.

        Words that neither has are empty leaves.

        Examples
        --------
        >>> from voxrt.octree import Rom, World, from_points
        >>> from voxrt.voxelize import EMPTY, Material
        >>> before = from_points([[1, 2, 3]], [1], depth=2)
        >>> world = World(Rom("dot", before, (EMPTY, Material("oak", (160, 110, 60)))))
        >>> world.set([[0, 0, 0]], [1])
        >>> patch = world.commit()
        >>> len(before.words), patch, len(patch.apply(before.words))
        (17, <Patch: 2 blocks, root at word 33>, 41)
        """
        blocks = -(-(max(self.end, len(words)) - 1) // 8)
        patched = np.full(1 + 8 * blocks, EMPTY, np.uint32)
        patched[: len(words)] = words
        patched[self.addresses[:, None] + np.arange(8, dtype=np.uint32)] = self.blocks
        patched[self.root] = self.root_word
        return patched
