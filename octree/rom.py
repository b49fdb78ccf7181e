"""The ROM: an octree memory with all that is needed to look at it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.octree.octree import Octree
    from voxrt.voxelize import Grid, Material


@dataclass(frozen=True, eq=False, slots=True)
class Rom:
    """An octree memory with its materials and its place in the scene.

    Attributes
    ----------
    name
        The name its files get.
    octree
        The memory.
    materials
        Indexed by material id; entry 0 is empty space and carries the background's colour. Covers every id in use.
    grid
        Where the memory's voxels stand in the scene; None for a memory that does not say.
    """

    name: str
    octree: Octree
    materials: tuple[Material, ...]
    grid: Grid | None = None
