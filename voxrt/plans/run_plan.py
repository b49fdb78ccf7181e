"""Who runs a plan: this process, or others."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from voxrt import octree, voxelize
from voxrt.plans.tile_store import MemoryTiles, sum_tallies, tile_name
from voxrt.plans.tile_tasks import block_voxelizer, finish_tile, tiles_key
from voxrt.voxelize import VoxelizationReport
from voxrt.voxelize.block_voxelizer import TALLIES

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

RunPlan: TypeAlias = "Callable[[BuildPlan, Scene, StageClock], tuple[Octree, VoxelizationReport]]"
"""Voxelizes a scene, whose colours are reduced to materials, and builds its octree as planned.

The stages are "voxelize" and "octree". The bytes are the same whoever runs the plan. The words may be those of a file
in the folder of the tiles. It raises OutputError where the disk is full or the folder is in use, and ToolError where
there is no cluster, it is lost, or a worker fails.
"""


def choose_runner(
    source: Source, store: TileStore | None, clustered: Callable[[ClusterProgress], None] | None
) -> RunPlan:
    """Choose who runs the plan of a source by its options: this process, several of this machine, or a cluster.

    `store` takes tiles and words that do not fit the memory; with None they are kept in memory all the same.
    `clustered` is called as workers finish tiles.
    """
    if store is None or (source.options.scheduler, source.options.workers) == (None, None):
        return partial(run_here, options=source.options, store=store)
    from voxrt.plans.by_workers import run_by_workers  # noqa: PLC0415 - few builds do this

    return partial(run_by_workers, source=source, store=store, clustered=clustered)


def run_here(
    plan: BuildPlan, scene: Scene, clock: StageClock, *, options: BuildOptions, store: TileStore | None = None
) -> tuple[Octree, VoxelizationReport]:
    """Run a plan by this process, as :data:`RunPlan` does."""
    if plan.side is not None:
        tiles = MemoryTiles(plan.grid.depth) if store is None else store
        return _run_in_tiles(plan, scene, options, clock, tiles)
    with clock.stage("voxelize"):
        made = voxelize.voxelize(
            scene,
            plan.grid,
            fill=options.fill_per_object,
            rule=options.rule,
            thin=options.thin,
            geometry=options.geometry,
            pow2=options.pow2,
            threads=options.threads,
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
    tallies = np.zeros((len(scene.objects), TALLIES), np.int64)
    for block in blocks:
        tile = finish_tile(voxelizer, block, clock, tiles, options.threads)
        tallies += sum_tallies(tile.tallies, len(tallies))
    report = voxelizer.report(tallies)
    del voxelizer  # to make room for the blocks
    with clock.stage("octree"):
        return tiles.join(map(tile_name, blocks), plan.grid.depth, plan.cache), report
