"""The grid of voxels and where it stands in the scene."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Grid:
    """A cube of 2**depth voxels a side. Its axes are the scene's axes: no swap, no mirror.

    Attributes
    ----------
    depth
        Levels of the octree, 1 … 16.
    origin
        Scene position (metres) of the lowest corner of voxel (0, 0, 0).
    voxel_size
        Metres a voxel.
    """

    depth: int
    origin: tuple[float, float, float]
    voxel_size: float

    @property
    def size(self) -> int:
        """Voxels a side."""
        return 1 << self.depth
