"""The grid of voxels and its place in the scene."""

from __future__ import annotations

from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.value import Value

DEPTH_LIMIT = 16
"""The deepest octree: 65536 voxels per side."""


class Grid(Value, frozen=True):
    """A cube of 2**depth voxels per side. Its axes are the scene's axes: no swap, no mirror.

    Attributes
    ----------
    depth
        Levels of the octree, 1 … 16.
    origin
        Metres, scene frame: the lowest corner of voxel (0, 0, 0).
    voxel_size
        Metres per voxel, positive.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind or range.

    Examples
    --------
    >>> Grid(7, (0, 0, 0), 0.25).size
    128
    """

    depth: int
    origin: tuple[float, float, float]
    voxel_size: float

    def __post_init__(self) -> None:
        force_setattr(self, "depth", arguments.whole("Grid.depth", self.depth, 1, DEPTH_LIMIT))
        force_setattr(self, "origin", arguments.vector("Grid.origin", self.origin))
        force_setattr(self, "voxel_size", arguments.real("Grid.voxel_size", self.voxel_size, above=0))

    @property
    def size(self) -> int:
        """Voxels per side."""
        return 1 << self.depth
