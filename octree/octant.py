"""One octant, found as the hardware finds it: from the root, one word per level."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.octree import Octree
from voxrt.octree.query import as_corner
from voxrt.octree.words import is_leaf, material
from voxrt.voxelize.arguments import instance
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.leaf_arrays import Leaves
    from voxrt.octree.query import Corner


class Octant(Value, frozen=True):
    """A leaf and its word, as :func:`octant_at` returns them.

    Attributes
    ----------
    address
        Address of the word.
    word
        The word, report dialect.
    level
        log2 of the side in voxels.
    corner
        The lowest voxel (x, y, z).
    """

    address: int
    word: int
    level: int
    corner: Corner

    @property
    def material(self) -> int:
        """Material id, 0 for empty space."""
        return material(self.word)

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
        Integers (x, y, z), grid frame.

    Raises
    ------
    TypeError, ValueError
        The voxel is not three integers, or lies outside the world.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> octant_at(from_points([[1, 2, 3]], [7], depth=2), (0, 0, 0))
    Octant(address=1, word=4294967040, level=1, corner=(0, 0, 0))
    """
    instance("octree", octree, Octree)
    x, y, z = as_corner("voxel", voxel)
    if min(x, y, z) < 0 or max(x, y, z) >= octree.size:
        raise ValueError(f"voxel {x},{y},{z} lies outside the world of {octree.size} voxels per side")
    address, level = 0, octree.depth
    word = int(octree.words[0])
    while not is_leaf(word):
        level -= 1
        address = word + (x >> level & 1) + 2 * (y >> level & 1) + 4 * (z >> level & 1)
        word = int(octree.words[address])
    return Octant(address, word, level, (x >> level << level, y >> level << level, z >> level << level))


def addresses(octree: Octree, some: Leaves) -> NDArray[np.uint32]:
    """Find the addresses of the words of some leaves of an octree: uint32, shape (N,).

    Examples
    --------
    >>> from voxrt.octree import from_points, leaves
    >>> tree = from_points([[1, 2, 3]], [7], depth=2)
    >>> [addresses(tree, part).tolist() for part in leaves(tree, solid_only=True)]
    [[14]]
    """
    found = np.zeros(len(some.levels), np.uint32)
    for level in reversed(range(octree.depth)):
        below = some.levels <= level
        octants = (some.corners[below] >> level & 1) @ np.array([1, 2, 4], np.int32)
        found[below] = octree.words[found[below]] + octants.astype(np.uint32)
    return found
