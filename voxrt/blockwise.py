"""From a scene to its octree: at once, or square by square of columns where the voxels do not fit the memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt import octree, voxelize
from voxrt.estimate import estimate_build
from voxrt.voxelize import VoxelizationReport
from voxrt.voxelize.free_memory import free_memory

if TYPE_CHECKING:
    from voxrt.build_options import BuildOptions
    from voxrt.estimate import BuildEstimate
    from voxrt.octree import Octree
    from voxrt.stage_clock import StageClock
    from voxrt.voxelize import Grid, Scene, Voxels

_LEAST_DEPTH = 11
"""Grids of fewer levels are built at once: their voxels take less memory than the tables of a thread."""

_LEAST_SIDE = 256
_UNEVEN = 8  # a square may have so many times its share of the surface


def block_side(grid: Grid, estimate: BuildEstimate, memory: int | None) -> int | None:
    """Choose the squares in which a scene is voxelized; None for all of it at once.

    Parameters
    ----------
    grid
        The grid.
    estimate
        What the build would take at once.
    memory
        Bytes that it may take; None for half of what is free.

    Examples
    --------
    >>> from voxrt.estimate import BuildEstimate
    >>> from voxrt.voxelize import Grid
    >>> grid = Grid(14, (0, 0, 0), 0.01)
    >>> block_side(grid, BuildEstimate(60, 1 << 30), 4 << 30)
    >>> block_side(grid, BuildEstimate(60, 8 << 30), 4 << 30)
    4096
    """
    allowed = free_memory() // 2 if memory is None else memory
    if estimate.bytes <= allowed:
        return None
    side, taken = grid.size, _UNEVEN * estimate.bytes // 2
    while taken > allowed // 2 and side > _LEAST_SIDE:
        side, taken = side // 2, taken // 4
    return side


def choose_side(scene: Scene, grid: Grid, options: BuildOptions) -> int | None:
    """Choose the squares for a build; None for all of it at once, as small grids are."""
    if grid.depth < _LEAST_DEPTH:
        return None
    return block_side(grid, estimate_build(scene, grid, options), options.memory)


def build_octree(
    scene: Scene, grid: Grid, options: BuildOptions, clock: StageClock
) -> tuple[Octree, VoxelizationReport]:
    """Voxelize a scene and build its octree, in the stages "voxelize" and "octree"; the octree, and the report."""
    side = choose_side(scene, grid, options)
    if side is None:
        with clock.stage("voxelize"):
            made = voxelize.voxelize(
                scene, grid, fill=options.fill, geometry=options.geometry, pow2=options.pow2, threads=options.threads
            )
        with clock.stage("octree"):
            tree = octree.build(made.voxels, threads=options.threads)
        return tree, VoxelizationReport(made.objects, made.warnings, made.seconds)

    whole = octree.Assembly(grid.depth)

    def take(voxels: Voxels) -> None:
        with clock.stage("octree"):
            whole.add(octree.build(voxels, threads=options.threads))

    with clock.stage("voxelize"):
        report = voxelize.voxelize_in_blocks(
            scene,
            grid,
            take,
            block_side=side,
            fill=options.fill,
            geometry=options.geometry,
            pow2=options.pow2,
            threads=options.threads,
        )
    with clock.stage("octree"):
        tree = whole.octree()
    return tree, report
