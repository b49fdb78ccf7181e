"""The object of the scene that an octant belongs to. Memory words hold materials only."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.leaf_arrays import solid_leaves
from voxrt.octree.morton import morton
from voxrt.octree.octant import octant_at
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.leaf_arrays import Leaves
    from voxrt.octree.octree import Octree
    from voxrt.octree.query import Corner

SEVERAL = -1
"""The owner of an octant whose voxels belong to several objects."""


class Owners(Value, frozen=True, eq=False):
    """The objects of a scene and the voxels that each owns.

    Attributes
    ----------
    octree
        An octree of owners: leaf i > 0 belongs to object i - 1.
    names
        The objects' names, in authored order.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> owners = Owners(from_points([[1, 2, 3], [0, 0, 0]], [1, 2], depth=2), ("lamp", "floor"))
    >>> owners.name_at((1, 2, 3)), owners.name_at((3, 3, 3))
    ('lamp', 'nobody')
    """

    octree: Octree
    names: tuple[str, ...]

    def of(self, solid: Leaves) -> NDArray[np.int16]:
        """Return the owners of some solid leaves: int16, shape (N,), rows of `names`, or :data:`SEVERAL`."""
        owned = solid_leaves(self.octree)
        codes, sought = (morton(part.corners.astype(np.int64)) for part in (owned, solid))
        if not len(codes):
            return np.full(len(sought), SEVERAL, np.int16)
        found = np.maximum(np.searchsorted(codes, sought, side="right") - 1, 0)
        levels = owned.levels[found].astype(np.int64)
        within = (levels >= solid.levels) & (sought - codes[found] < np.int64(1) << 3 * levels)
        return np.where(within, owned.materials[found].astype(np.int16) - 1, SEVERAL).astype(np.int16)

    def name_at(self, voxel: Corner) -> str:
        """Return the name of the object that owns a voxel (x, y, z)."""
        owner = octant_at(self.octree, voxel).material
        return self.names[owner - 1] if owner else "nobody"
