"""How much of the visible surface two octrees share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from voxrt.octree import _native

if TYPE_CHECKING:
    from voxrt.octree.octree import Octree


@dataclass(frozen=True, slots=True)
class SurfaceChange:
    """Voxels on a surface: solid, one of the six neighbours empty or outside the world.

    Attributes
    ----------
    surface
        On the surface of the first octree.
    changed
        Of those, not on the surface of the second, or of another material there.
    """

    surface: int
    changed: int

    @property
    def percent(self) -> float:
        """Percent of the surface voxels that changed."""
        return 100 * self.changed / self.surface if self.surface else 0.0


def surface_change(first: Octree, second: Octree) -> SurfaceChange:
    """Compare the surfaces of two octrees of one depth, voxel by voxel; cost grows with the surface.

    Raises
    ------
    ValueError
        Where the depths differ.
    """
    if first.depth != second.depth:
        raise ValueError(f"octrees of depth {first.depth} and {second.depth} cannot be compared voxel by voxel")
    found = _native.surface_change(first.words, second.words, first.depth)
    return SurfaceChange(surface=found.surface, changed=found.changed)
