"""Point clouds: what a scanner gives, before a grid makes voxels of it (placed_points.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray


class PointCloud(Value, frozen=True, eq=False):
    """Points without a surface. A voxel is solid where it holds enough of them.

    Attributes
    ----------
    positions
        float32 or float64, shape (N, 3): finite, in the object's frame.
    colours
        uint8, shape (N, 3): sRGB; None where the author gave none.
    least
        How many points make a voxel solid, 1 or more.

    Raises
    ------
    TypeError, ValueError
        An array of another kind, shape or range; a position that is not finite.

    Examples
    --------
    >>> PointCloud([[0, 0, 0], [1, 2, 3]], [[255, 0, 0], [0, 0, 255]])
    PointCloud(points=2, coloured=True, least=1)
    """

    positions: NDArray[np.floating]
    colours: NDArray[np.uint8] | None = None
    least: int = 1

    def __post_init__(self) -> None:
        positions = arguments.real_array("PointCloud.positions", self.positions, ("N", 3))
        force_setattr(self, "positions", positions)
        if self.colours is not None:
            colours = arguments.whole_array(
                "PointCloud.colours", self.colours, (len(positions), 3), np.uint8, low=0, high=255
            )
            force_setattr(self, "colours", colours)
        force_setattr(self, "least", arguments.whole("PointCloud.least", self.least, 1, MOST_POINTS))

    def __repr__(self) -> str:
        return f"PointCloud(points={len(self.positions)}, coloured={self.colours is not None}, least={self.least})"


MOST_POINTS = 1 << 31
"""The largest number of points that a voxel may be asked to hold."""
