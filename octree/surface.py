"""Changes of the surface between two octrees."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from voxrt.octree import _native
from voxrt.octree.difference import refuse_other_depth

if TYPE_CHECKING:
    from voxrt.octree.octree import Octree


@dataclass(frozen=True, slots=True)
class SurfaceChange:
    """Surface voxels and how many of them changed, as :func:`surface_change` returns them.

    A surface voxel is solid, and one of its six neighbours is empty or outside the world.

    Attributes
    ----------
    surface
        Surface voxels of the first octree.
    changed
        Those of them that are not on the surface of the second, or of another material there.
    """

    surface: int
    changed: int

    @property
    def percent(self) -> float:
        """Percent of the surface voxels that changed."""
        return 100 * self.changed / self.surface if self.surface else 0.0


def surface_change(first: Octree, second: Octree) -> SurfaceChange:
    """Compare the surfaces of two octrees of one depth, voxel by voxel. The cost grows with the surface.

    Raises
    ------
    TypeError, ValueError
        One is no octree, or the depths differ.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> before = from_points([[1, 2, 3], [0, 0, 0]], [7, 7], depth=2)
    >>> surface_change(before, from_points([[1, 2, 3]], [7], depth=2)).percent
    50.0
    """
    refuse_other_depth(first, second)
    return SurfaceChange(*_native.surface_change(first.words, second.words, first.depth))
