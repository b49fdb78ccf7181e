"""One octant, as the hardware finds it: from the root, a word a level."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.leaf_arrays import Leaves
    from voxrt.octree.octree import Octree
    from voxrt.octree.query import Corner


@dataclass(frozen=True, slots=True)
class Octant:
    """A leaf and the word that makes it one.

    Attributes
    ----------
    address
        Of its word.
    word
        Report dialect.
    level
        log2 of its side in voxels.
    corner
        Its lowest voxel (x, y, z).
    """

    address: int
    word: int
    level: int
    corner: Corner

    @property
    def material(self) -> int:
        """Material id, 0 for empty space."""
        return self.word & 0xFF

    @property
    def end(self) -> Corner:
        """One voxel behind its highest."""
        x, y, z = self.corner
        side = 1 << self.level
        return x + side, y + side, z + side


def octant_at(octree: Octree, voxel: Corner) -> Octant:
    """Find the leaf that holds a voxel.

    Parameters
    ----------
    octree
        The memory.
    voxel
        Coordinates (x, y, z), grid frame.

    Raises
    ------
    ValueError
        Where the voxel lies outside the world.
    """
    x, y, z = voxel
    if min(voxel) < 0 or max(voxel) >= octree.size:
        raise ValueError(f"voxel {x},{y},{z} lies outside the world of {octree.size} voxels a side")
    address, level = 0, octree.depth
    word = int(octree.words[0])
    while not word >> 31:
        level -= 1
        address = word + (x >> level & 1) + 2 * (y >> level & 1) + 4 * (z >> level & 1)
        word = int(octree.words[address])
    return Octant(address, word, level, (x >> level << level, y >> level << level, z >> level << level))


def addresses(octree: Octree, some: Leaves) -> NDArray[np.uint32]:
    """Find the addresses of the words of some of an octree's leaves, shape (N,)."""
    found = np.zeros(len(some.levels), np.uint32)
    for level in reversed(range(octree.depth)):
        below = some.levels <= level
        octants = (some.corners[below] >> level & 1) @ np.array([1, 2, 4], np.int32)
        found[below] = octree.words[found[below]] + octants.astype(np.uint32)
    return found
