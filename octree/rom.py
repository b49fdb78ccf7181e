"""The ROM: an octree memory with all that is needed to look at it."""

from __future__ import annotations

from msgspec.structs import force_setattr

from voxrt.octree.octree import Octree
from voxrt.octree.statistics import census
from voxrt.voxelize import Grid, Material
from voxrt.voxelize.arguments import instance, text
from voxrt.voxelize.value import Value

MOST_NAME = 1000
"""Characters of the longest name: whatever shows a memory shows its name."""

_MOST_MATERIALS = 256


class Rom(Value, frozen=True, eq=False):
    """An octree memory with its materials and its place in the scene.

    Attributes
    ----------
    name
        The name of its files, at most 1000 characters. Bytes of a file's name that are no text become ``_``.
    octree
        The memory.
    materials
        The materials by id. Entry 0 is empty space; its colour is the background. Every id in use has an entry.
    grid
        Where the voxels stand in the scene; None if that is not known.

    Raises
    ------
    TypeError, ValueError
        A value of another type, a longer name, more than 256 materials, or fewer than the memory uses.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import Rom, from_dense
    >>> from voxrt.voxelize import EMPTY, Material
    >>> tree = from_dense(np.ones((4, 4, 3), np.uint8))
    >>> Rom("slab", tree, (EMPTY, Material("oak", (160, 110, 60))))
    <Rom 'slab': depth 2, 17 words, 1 material>
    """

    name: str
    octree: Octree
    materials: tuple[Material, ...]
    grid: Grid | None = None

    def __repr__(self) -> str:
        count = len(self.materials) - 1
        return (
            f"<Rom {self.name!r}: depth {self.octree.depth}, {len(self.octree.words):,} words, "
            f"{count} {'material' if count == 1 else 'materials'}>"
        )

    def __post_init__(self) -> None:
        name = "".join("_" if "\ud800" <= c <= "\udfff" else c for c in text("name", self.name))
        if len(name) > MOST_NAME:
            raise ValueError(f"name has {len(name)} characters; it may have {MOST_NAME}")
        force_setattr(self, "name", name)
        instance("octree", self.octree, Octree)
        if self.grid is not None and instance("grid", self.grid, Grid).depth != self.octree.depth:
            raise ValueError(f"grid has depth {self.grid.depth} and the octree depth {self.octree.depth}")
        if isinstance(self.materials, Material):
            raise TypeError("materials must be a sequence of Material, not one Material")
        materials = tuple(instance(f"materials[{row}]", one, Material) for row, one in enumerate(self.materials))
        force_setattr(self, "materials", materials)
        if not 1 <= len(materials) <= _MOST_MATERIALS:
            raise ValueError(f"materials must have 1 to 256 entries, entry 0 for empty space, not {len(materials)}")
        if len(materials) < _MOST_MATERIALS and (used := max(census(self.octree).voxels)) >= len(materials):
            raise ValueError(f"materials end at id {len(materials) - 1}, and the octree uses {used}")
