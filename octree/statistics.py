"""How much of what: leaves and voxels by level and material, shared blocks counted wherever they stand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.octree import Octree


@dataclass(frozen=True, eq=False, slots=True)
class Census:
    """Exact counts.

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
    """Count the leaves of `octree` in time that grows with its words, not with its world."""
    return Census(_native.leaf_counts(octree.words, octree.depth))
