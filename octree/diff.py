"""What differs between two octrees."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from voxrt.octree import _native
from voxrt.octree.query import as_bounds

if TYPE_CHECKING:
    from voxrt.octree.octree import Octree
    from voxrt.octree.query import Corner


@dataclass(frozen=True, slots=True)
class Difference:
    """Voxels that differ, counted exactly.

    Attributes
    ----------
    appeared
        Empty in the first, solid in the second.
    vanished
        Solid in the first, empty in the second.
    recoloured
        Solid in both, of different materials.
    bounds
        The smallest box (lowest voxel, one behind the highest) that holds them all; None where nothing differs.
    """

    appeared: int
    vanished: int
    recoloured: int
    bounds: tuple[Corner, Corner] | None

    @property
    def voxels(self) -> int:
        """All voxels that differ."""
        return self.appeared + self.vanished + self.recoloured


def diff(first: Octree, second: Octree) -> Difference:
    """Compare the voxels of two octrees of one depth, not their words.

    Raises
    ------
    ValueError
        Where the depths differ.
    """
    if first.depth != second.depth:
        raise ValueError(f"octrees of depth {first.depth} and {second.depth} cannot be compared voxel by voxel")
    appeared, vanished, recoloured, corners = _native.diff(first.words, second.words, first.depth)
    return Difference(appeared, vanished, recoloured, as_bounds(corners))
