"""The voxelizer's output: sparse bricks and uniform octants in Morton order.

No array has the size of the volume: bricks exist only where the content is mixed, and a large interior is a few
octants.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from msgspec import field

from voxrt.voxelize.rules import Rule  # noqa: TC001 - msgspec reads it
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from voxrt.voxelize.errors import SceneWarning


class Voxels(Value, frozen=True, eq=False):
    """The solid voxels of a grid.

    Morton code: bit 3k is bit k of x, bit 3k+1 of y, bit 3k+2 of z, so the octant index is {z, y, x}. A brick holds
    8x8x8 voxels, indexed 0 … 511 by the Morton code of their position in it. Grids of depth below 3 use the first
    8**depth voxels of the single brick 0. Bricks and octants are disjoint. A voxel in neither is empty.

    Attributes
    ----------
    depth
        The grid's depth, 1 … 16.
    brick_codes
        uint64, shape (B,), strictly ascending: Morton code of the brick's corner divided by 8.
    brick_masks
        uint64, shape (B, 8): voxel i is solid when bit i % 64 of word i // 64 is set; never all zero.
    brick_materials
        uint8, shape (B,): the material of every solid voxel of the brick, or 0 where `cells` holds them.
    brick_rows
        int32, shape (B,): row of `cells` with the brick's materials, or -1 where the brick has one material.
    cells
        uint8, shape (C, 512): the material of each voxel, 0 where empty; consistent with the mask.
    octant_codes
        uint64, shape (U,): Morton code of the octant's corner divided by its side (2**level voxels), ascending by the
        corner's Morton code; disjoint.
    octant_levels
        uint8, shape (U,): log2 of the side in voxels, 3 … depth.
    octant_materials
        uint8, shape (U,): 1 … 255.
    """

    depth: int
    brick_codes: NDArray[np.uint64]
    brick_masks: NDArray[np.uint64]
    brick_materials: NDArray[np.uint8]
    brick_rows: NDArray[np.int32]
    cells: NDArray[np.uint8]
    octant_codes: NDArray[np.uint64]
    octant_levels: NDArray[np.uint8]
    octant_materials: NDArray[np.uint8]

    def __repr__(self) -> str:
        return f"Voxels(depth={self.depth}, bricks={len(self.brick_codes)}, octants={len(self.octant_codes)})"


class ObjectMode(StrEnum):
    """How the inside of an object was told from its outside. ``src/scene/object_mode.h`` decides it.

    Examples
    --------
    >>> str(ObjectMode.WINDING)
    'winding'
    """

    SURFACE = "surface"
    """It was not filled."""

    EXACT = "exact"
    """It closes and does not overlap itself, or is an analytic solid: signed crossings."""

    WINDING = "winding"
    """It has holes or overlaps itself: the generalized winding number."""

    OPEN = "open"
    """Some of it stands open, like a room without a front, and has a shell alone; the rest is as in `WINDING`."""

    TURNED = "turned"
    """It closes; faces or connected components that were inside out were turned, walls of cavities excepted."""


class ObjectReport(Value, frozen=True):
    """How one object was voxelized.

    Attributes
    ----------
    name
        The object's name.
    source
        What was voxelized: ``"mesh"``, ``"box"``, ``"sphere"``, ``"hull"``; colliders of several kinds are joined by
        ``"+"``.
    mode
        How its inside was told from its outside.
    voxels
        Voxels that belong to it; the first object that covers a voxel keeps it.
    moved
        Voxels by which rounding moved its lowest corner, per axis (x, y, z).
    grown
        Voxels by which rounding grew it, per axis.
    rule
        Which voxels are of it: its own rule, or that of the build.
    """

    name: str
    source: str
    mode: ObjectMode
    voxels: int
    moved: tuple[float, float, float] = (0.0, 0.0, 0.0)
    grown: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rule: Rule = "touch"


class Voxelization(Value, frozen=True, eq=False):
    """Voxels, and how each object was voxelized.

    Attributes
    ----------
    voxels
        The solid voxels.
    objects
        One report per object, in authored order.
    warnings
        What was ignored or replaced.
    seconds
        Wall seconds per stage of the native voxelizer, in order: ``"analysis"``, ``"bin"``, ``"coverage"``, ``"fill"``,
        ``"holes"``, ``"order"``, ``"gather"``; ``src/tiles/voxelizer.h`` describes the stages.
    """

    voxels: Voxels
    objects: tuple[ObjectReport, ...]
    warnings: tuple[SceneWarning, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"Voxelization(voxels={self.voxels!r}, objects={len(self.objects)}, warnings={len(self.warnings)})"


class VoxelizationReport(Value, frozen=True):
    """How each object was voxelized: a :class:`Voxelization` whose voxels were handed on block by block.

    Attributes
    ----------
    objects, warnings, seconds
        As in :class:`Voxelization`.

    Examples
    --------
    >>> from voxrt.voxelize import fit_grid, load, voxelize_in_blocks
    >>> scene = load("examples/house.obj")
    >>> report = voxelize_in_blocks(scene, fit_grid(scene, depth=7), lambda block: None, block_side=64)
    >>> [one.name for one in report.objects]
    ['door', 'windows', 'chimney', 'walls', 'roof']
    """

    objects: tuple[ObjectReport, ...]
    warnings: tuple[SceneWarning, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict)
