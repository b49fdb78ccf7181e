"""The plan of a build: its grid, whether all voxels are made at once or tile by tile, and what that takes.

A tile is a square of columns of the grid. Its octree is made alone; the octrees of the tiles are joined to the same
words as those of all voxels at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from voxrt import voxelize
from voxrt.options.build_options import DEFAULT_DEPTH
from voxrt.plans.estimate import estimate_build
from voxrt.voxelize.free_memory import free_memory

if TYPE_CHECKING:
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.estimate import BuildEstimate
    from voxrt.plans.stage_clock import StageClock
    from voxrt.voxelize import Grid, Scene

_LEAST_DEPTH = 11
"""Grids of fewer levels are built at once: their voxels take less memory than the tables of a thread."""

_LEAST_SIDE = 256
_UNEVEN = 8  # a square may have so many times its share of the surface
_BLOCKS_PER_SURFACE_VOXEL = 0.0132  # of a scan with 2**28 surface voxels; it halves with 16 times as many
_BYTES_PER_JOINED_BLOCK = 60
_BYTES_PER_BLOCK_OF_TABLE = 20
_BYTES_OF_BLOCK = 32
_COPIES_ON_DISK = 3  # the tiles, the blocks that are joined, and the words


class BuildPlan(Struct, frozen=True):
    """How a scene becomes an octree, and what that takes."""

    grid: Grid
    side: int | None  # columns per side of a tile; None for all voxels at once
    cache: int  # bytes of memory for blocks, where they are joined on the disk
    estimate: BuildEstimate


def fit_plan(scene: Scene, options: BuildOptions, clock: StageClock, *, on_disk: bool) -> BuildPlan:
    """Fit the grid that options ask for to a scene, and plan its build, in the stage "fit".

    AssetError if the scene has nothing to voxelize or a coordinate that is not finite, DoesNotFitError if it needs more
    than 2**16 voxels per side.
    """
    with clock.stage("fit"):
        depth, voxel_size = options.depth, options.voxel_size
        if depth is None and voxel_size is None:
            depth, voxel_size = (None, scene.voxel_size) if scene.voxel_size else (DEFAULT_DEPTH, None)
        grid = voxelize.fit_grid(
            scene,
            depth=depth,
            voxel_size=voxel_size,
            geometry=options.geometry,
            pow2=options.pow2,
            bounds=None if options.bounds is None else (options.bounds[:3], options.bounds[3:]),
        )
        return plan_build(scene, grid, options, on_disk=on_disk)


def plan_build(scene: Scene, grid: Grid, options: BuildOptions, *, on_disk: bool) -> BuildPlan:
    """Choose the tiles for a build: such that their voxels fit the memory; none where all voxels do.

    `on_disk`: whether tiles may go to the disk.

    Examples
    --------
    >>> from voxrt import BuildOptions, fit_grid, load
    >>> scene = load("examples/house.obj")
    >>> grid = fit_grid(scene, depth=13)
    >>> plan_build(scene, grid, BuildOptions(memory=1 << 40), on_disk=True).side
    >>> plan_build(scene, grid, BuildOptions(memory=1 << 30), on_disk=True).side
    1024
    """
    estimate = estimate_build(scene, grid, options)
    allowed = free_memory() // 2 if options.memory is None else options.memory
    if grid.depth < _LEAST_DEPTH or estimate.bytes <= allowed:
        return BuildPlan(grid, None, 0, estimate)
    side, taken = grid.size, _UNEVEN * estimate.bytes // 2
    while side >= 2 * max(estimate.width, _LEAST_SIDE):  # the scene is in few of such squares
        side //= 2
    while taken > allowed // 2 and side > _LEAST_SIDE:
        side, taken = side // 2, taken // 4
    estimate = _in_tiles(estimate, min(taken, estimate.bytes), allowed // 4, on_disk=on_disk)
    return BuildPlan(grid, side, allowed // 4, estimate)


def _in_tiles(estimate: BuildEstimate, tile: int, cache: int, *, on_disk: bool) -> BuildEstimate:
    """Return what a build takes whose voxels are in memory tile by tile, `tile` bytes each."""
    blocks = int(_BLOCKS_PER_SURFACE_VOXEL * estimate.surface * min(1.0, (2**28 / max(estimate.surface, 1)) ** 0.25))
    if not on_disk:
        return replace(estimate, bytes=estimate.least + tile + _BYTES_PER_JOINED_BLOCK * blocks)
    joined = _BYTES_PER_BLOCK_OF_TABLE * blocks + min(cache, _BYTES_OF_BLOCK * blocks)
    disk = _COPIES_ON_DISK * _BYTES_OF_BLOCK * blocks
    return replace(estimate, bytes=estimate.least + max(tile, joined), disk=disk)
