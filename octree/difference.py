"""What differs between two octrees: voxels, regions, surfaces."""

from __future__ import annotations

from voxrt.octree import _native
from voxrt.octree.octree import Octree
from voxrt.octree.query import Corner  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.voxelize.arguments import instance
from voxrt.voxelize.value import Value


class Difference(Value, frozen=True):
    """Voxels that differ, counted exactly, as :func:`diff` returns them.

    Attributes
    ----------
    appeared
        Empty in the first, solid in the second.
    vanished
        Solid in the first, empty in the second.
    recoloured
        Solid in both, of different materials.
    bounds
        The smallest box that holds them all: its lowest voxel, and one behind its highest. None if nothing differs.
    """

    appeared: int
    vanished: int
    recoloured: int
    bounds: tuple[Corner, Corner] | None

    @property
    def voxels(self) -> int:
        """All voxels that differ."""
        return self.appeared + self.vanished + self.recoloured


class Region(Value, frozen=True):
    """Voxels that differ and are connected by faces, edges or corners, as :func:`differing_regions` returns them.

    Attributes
    ----------
    bounds
        The smallest box that holds them: its lowest voxel, and one behind its highest.
    appeared, vanished, recoloured
        As in :class:`Difference`.
    """

    bounds: tuple[Corner, Corner]
    appeared: int
    vanished: int
    recoloured: int

    @property
    def voxels(self) -> int:
        """Their number."""
        return self.appeared + self.vanished + self.recoloured


def diff(first: Octree, second: Octree) -> Difference:
    """Compare the voxels of two octrees of one depth. How their words are arranged does not matter.

    Raises
    ------
    TypeError, ValueError
        One is no octree, or the depths differ.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> before = from_points([[1, 2, 3]], [7], depth=2)
    >>> diff(before, from_points([[1, 2, 3], [0, 0, 0]], [6, 1], depth=2))
    Difference(appeared=1, vanished=0, recoloured=1, bounds=((0, 0, 0), (2, 3, 4)))
    """
    _refuse_other_depth(first, second)
    return Difference(*_native.diff(first.words, second.words, first.depth))


def differing_regions(first: Octree, second: Octree) -> tuple[Region, ...]:
    """Find the regions in which two octrees of one depth differ.

    The cost grows with the octants that differ. More than 2**21 of them make one region.

    Returns
    -------
    tuple[Region, ...]
        Those with most voxels first, then by their lowest voxel.

    Raises
    ------
    TypeError, ValueError
        One is no octree, or the depths differ.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> before = from_points([[1, 2, 3]], [7], depth=3)
    >>> [region.bounds for region in differing_regions(before, from_points([[7, 7, 7]], [7], depth=3))]
    [((1, 2, 3), (2, 3, 4)), ((7, 7, 7), (8, 8, 8))]
    """
    _refuse_other_depth(first, second)
    found = _native.differing_regions(first.words, second.words, first.depth)
    return tuple(
        Region(((x, y, z), (end_x, end_y, end_z)), appeared, vanished, recoloured)
        for (x, y, z), (end_x, end_y, end_z), appeared, vanished, recoloured in zip(
            *(column.tolist() for column in found), strict=True
        )
    )


class SurfaceChange(Value, frozen=True):
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
    _refuse_other_depth(first, second)
    return SurfaceChange(*_native.surface_change(first.words, second.words, first.depth))


def _refuse_other_depth(first: Octree, second: Octree) -> None:
    """Raise TypeError or ValueError unless both are octrees of one depth."""
    instance("first", first, Octree)
    if first.depth != instance("second", second, Octree).depth:
        raise ValueError(f"octrees of depth {first.depth} and {second.depth} cannot be compared voxel by voxel")
