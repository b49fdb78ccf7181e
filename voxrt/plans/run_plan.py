"""Plans become octrees here, whoever runs them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt import octree, voxelize
from voxrt.plans.tile_making import block_voxelizer, finish_tile, tiles_key
from voxrt.plans.tile_store import MemoryTiles, sum_tallies, tile_name
from voxrt.voxelize import VoxelizationReport

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.octree import Octree
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.by_workers import ClusterProgress
    from voxrt.plans.plan import BuildPlan
    from voxrt.plans.stage_clock import StageClock
    from voxrt.plans.tile_store import TileStore
    from voxrt.sources.source import Source
    from voxrt.voxelize import Scene


def run_plan(
    plan: BuildPlan,
    scene: Scene,
    source: Source,
    clock: StageClock,
    *,
    store: TileStore | None = None,
    clustered: Callable[[ClusterProgress], None] | None = None,
) -> tuple[Octree, VoxelizationReport]:
    """Voxelize a scene and build its octree, in the stages "voxelize" and "octree": the same bytes whoever does so.

    Parameters
    ----------
    plan, scene, clock
        What is to be done, with colours reduced to materials, and what counts the stages.
    source
        Its options name who runs the plan: this process, several of this machine, or a cluster.
    store
        Where tiles and words go that do not fit the memory; None to keep them in memory all the same. The words of the
        octree may be those of a file there.
    clustered
        Called as workers finish tiles.

    Raises
    ------
    OutputError
        The disk is full, or the folder is in use.
    ToolError
        There is no cluster, it is lost, or a worker fails.
    """
    options = source.options
    if store is not None and (options.scheduler, options.workers) != (None, None):
        from voxrt.plans.by_workers import run_by_workers  # noqa: PLC0415 - few builds do this

        return run_by_workers(plan, scene, source, clock, store=store, clustered=clustered)
    if plan.side is not None:
        tiles = MemoryTiles(plan.grid.depth) if store is None else store
        return _run_in_tiles(plan, scene, options, clock, tiles)
    with clock.stage("voxelize"):
        made = voxelize.voxelize(
            scene, plan.grid, fill=options.fill, geometry=options.geometry, pow2=options.pow2, threads=options.threads
        )
    with clock.stage("octree"):
        tree = octree.build(made.voxels, threads=options.threads)
    return tree, VoxelizationReport(made.objects, made.warnings, made.seconds)


def _run_in_tiles(
    plan: BuildPlan, scene: Scene, options: BuildOptions, clock: StageClock, tiles: TileStore | MemoryTiles
) -> tuple[Octree, VoxelizationReport]:
    assert plan.side is not None
    with clock.stage("voxelize"):
        voxelizer = block_voxelizer(scene, plan.grid, options)
        blocks = voxelizer.blocks(tiles.claim(tiles_key(voxelizer), plan.side))
    tallies = np.zeros((len(scene.objects), 4), np.int64)
    for block in blocks:
        tile = finish_tile(voxelizer, block, clock, tiles, options.threads)
        tallies += sum_tallies(tile.tallies, len(tallies))
    report = voxelizer.report(tallies)
    del voxelizer  # to make room for the blocks
    with clock.stage("octree"):
        return tiles.join(map(tile_name, blocks), plan.grid.depth, plan.cache), report
