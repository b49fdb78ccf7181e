"""Which object of the scene an octant belongs to: memory words know materials alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.leaf_arrays import solid_leaves
from voxrt.octree.morton import morton
from voxrt.octree.octant import octant_at

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.leaf_arrays import Leaves
    from voxrt.octree.octree import Octree
    from voxrt.octree.query import Corner

SEVERAL = -1
"""The owner of an octant whose voxels belong to several objects."""


@dataclass(frozen=True, eq=False, slots=True)
class Owners:
    """The objects of a scene and the voxels that each owns.

    Attributes
    ----------
    octree
        An octree of owners: leaf i > 0 belongs to object i - 1.
    names
        The objects' names, in authored order.
    """

    octree: Octree
    names: tuple[str, ...]

    def of(self, solid: Leaves) -> NDArray[np.int16]:
        """Tell whose some solid leaves are (shape (N,)): a row of `names`, or :data:`SEVERAL`."""
        owned = solid_leaves(self.octree)
        codes, sought = (morton(part.corners.astype(np.int64)) for part in (owned, solid))
        if not len(codes):
            return np.full(len(sought), SEVERAL, np.int16)
        found = np.maximum(np.searchsorted(codes, sought, side="right") - 1, 0)
        levels = owned.levels[found].astype(np.int64)
        within = (levels >= solid.levels) & (sought - codes[found] < np.int64(1) << 3 * levels)
        return np.where(within, owned.materials[found].astype(np.int16) - 1, SEVERAL).astype(np.int16)

    def name_at(self, voxel: Corner) -> str:
        """Name the object that owns a voxel."""
        owner = octant_at(self.octree, voxel).material
        return self.names[owner - 1] if owner else "nobody"
