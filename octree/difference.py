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


@dataclass(frozen=True, slots=True)
class Region:
    """Voxels that differ and hang together by faces, edges or corners.

    Attributes
    ----------
    bounds
        The smallest box (lowest voxel, one behind the highest) that holds them.
    appeared, vanished, recoloured
        As in :class:`Difference`.
    """

    bounds: tuple[Corner, Corner]
    appeared: int
    vanished: int
    recoloured: int

    @property
    def voxels(self) -> int:
        """How many they are."""
        return self.appeared + self.vanished + self.recoloured


def diff(first: Octree, second: Octree) -> Difference:
    """Compare the voxels of two octrees of one depth, not their words.

    Raises
    ------
    ValueError
        Where the depths differ.
    """
    _refuse_other_depth(first, second)
    found = _native.diff(first.words, second.words, first.depth)
    return Difference(found.appeared, found.vanished, found.recoloured, as_bounds(found.bounds))


def differing_regions(first: Octree, second: Octree) -> tuple[Region, ...]:
    """Tell where two octrees of one depth differ: the pieces, those with most voxels first, then by lowest voxel.

    Cost grows with the octants that differ; more than 2**21 of them are given as one region.

    Raises
    ------
    ValueError
        Where the depths differ.
    """
    _refuse_other_depth(first, second)
    found = _native.differing_regions(first.words, second.words, first.depth)
    return tuple(
        Region(((x, y, z), (end_x, end_y, end_z)), appeared, vanished, recoloured)
        for (x, y, z), (end_x, end_y, end_z), appeared, vanished, recoloured in zip(
            found.low.tolist(),
            found.high.tolist(),
            found.appeared.tolist(),
            found.vanished.tolist(),
            found.recoloured.tolist(),
            strict=True,
        )
    )


def _refuse_other_depth(first: Octree, second: Octree) -> None:
    if first.depth != second.depth:
        raise ValueError(f"octrees of depth {first.depth} and {second.depth} cannot be compared voxel by voxel")
