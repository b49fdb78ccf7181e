"""Leaves and voxels by level and material. A shared block counts once for each place where it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from voxrt.octree import _native
from voxrt.octree.octree import Octree
from voxrt.voxelize.arguments import instance
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray


_COUNTED: WeakKeyDictionary[Octree, Census] = WeakKeyDictionary()  # an octree never changes


class Census(Value, frozen=True, eq=False):
    """Exact counts of leaves, as :func:`census` returns them.

    Attributes
    ----------
    leaves
        uint64, shape (depth + 1, 256): leaves of side 2**level (first axis) and material (second axis).
    """

    leaves: NDArray[np.uint64]

    @property
    def voxels(self) -> dict[int, int]:
        """Voxels by material id, ascending, 0 (empty) included where it occurs."""
        volumes = np.uint64(8) ** np.arange(len(self.leaves), dtype=np.uint64)
        sums = volumes @ self.leaves  # at most 2**48 in all
        return {int(material): int(sums[material]) for material in np.flatnonzero(sums)}

    @property
    def solid_voxels(self) -> int:
        """Voxels that are not empty."""
        return sum(count for material, count in self.voxels.items() if material != 0)


def census(octree: Octree) -> Census:
    """Count the leaves of an octree. The cost grows with its words, not with its world.

    An octree is counted once: its census is kept as long as the octree is.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> counts = census(from_points([[1, 2, 3]], [7], depth=2))
    >>> counts.voxels, counts.solid_voxels, counts.leaves[0, 7].item()
    ({0: 63, 7: 1}, 1, 1)
    """
    if (known := _COUNTED.get(instance("octree", octree, Octree))) is None:
        counts = _native.leaf_counts(octree.words, octree.depth)
        counts.flags.writeable = False
        known = _COUNTED[octree] = Census(counts)
    return known
