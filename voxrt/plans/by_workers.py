"""A plan that several processes run: its tiles become tasks, and this process joins them."""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from voxrt.plans.open_workers import open_workers
from voxrt.plans.tile_store import TileStore, sum_tallies
from voxrt.plans.tile_tasks import TileJob, block_voxelizer, inherited_scene, make_tile, merge_tiles, tiles_key
from voxrt.sources.source import open_source
from voxrt.voxelize.block_voxelizer import TALLIES

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.octree import Octree
    from voxrt.plans.plan import BuildPlan
    from voxrt.plans.stage_clock import StageClock
    from voxrt.plans.tile_tasks import TileDone
    from voxrt.plans.workers import Workers
    from voxrt.sources.source import Source
    from voxrt.voxelize import BlockVoxelizer, ColumnBlock, Scene, VoxelizationReport

T = TypeVar("T")

FAN_IN = 4
"""Tiles along each side of a square that one task joins."""

MOST_PIECES = 16
"""This process joins up to so many octrees alone."""

JOINERS = 8
"""With fewer workers, this process joins all tiles: joins by few workers take longer than they save."""

_TILES_PER_WORKER = 4
"""Enough to even out their work. More tiles store more blocks twice, which the join removes again."""

_LEAST_SIDE = 512


class ClusterProgress(Struct, frozen=True):
    """How far a cluster is with a build."""

    done: int  # finished tiles
    tiles: int  # all of them
    workers: int  # that are connected
    bytes: int  # of the finished tiles
    silent: int = 0  # workers that have not been heard of for a quarter of a minute


def run_by_workers(
    plan: BuildPlan,
    scene: Scene,
    clock: StageClock,
    *,
    source: Source,
    store: TileStore,
    clustered: Callable[[ClusterProgress], None] | None,
) -> tuple[Octree, VoxelizationReport]:
    """Run a plan by the workers that the options of the source name, as :data:`voxrt.plans.run_plan.RunPlan` does.

    The workers load the file of `source`, at the same path as here, and write to `store`'s folder.
    """
    with clock.stage("voxelize"):
        voxelizer = block_voxelizer(scene, plan.grid, source.options)
        voxelizer.prepare()
        key = tiles_key(voxelizer)
        job = TileJob(_workers_source(source), plan.grid, TileStore(store.folder.resolve(), key))
        remedy = f"finished tiles stay in {job.store.folder}, and the same build goes on from them"
        options = source.options
        with (
            open_workers(options.scheduler, options.workers, remedy=remedy) as workers,
            inherited_scene(key, voxelizer),
        ):
            blocks = voxelizer.blocks(store.claim(key, cluster_side(voxelizer, plan, workers.count)))
            tiles = _made(workers, job, {block: voxelizer.objects_of(block) for block in blocks}, clustered)
    rows = [np.zeros((0, 1 + TALLIES), np.int64), *(tile.tallies for tile in tiles)]
    report = voxelizer.report(sum_tallies(np.concatenate(rows), len(scene.objects)))
    del voxelizer  # to make room for the blocks
    with clock.stage("octree"):
        return store.join([tile.name for tile in tiles], plan.grid.depth, plan.cache), report


def cluster_side(voxelizer: BlockVoxelizer, plan: BuildPlan, workers: int) -> int:
    """Return the columns per side of a tile: a few tiles per worker, more where the memory asks for it."""
    side = plan.grid.size if plan.side is None else plan.side
    while side > _LEAST_SIDE and len(voxelizer.blocks(side)) < _TILES_PER_WORKER * workers:
        side //= 2
    return side


def _workers_source(source: Source) -> Source:
    """Return the source as workers open it: its file by the absolute path, and their share of the threads."""
    options = source.options
    threads = options.threads
    if options.workers is not None:
        threads = threads or max(1, (os.cpu_count() or 1) // options.workers)
    options = replace(options, scheduler=None, workers=None, preview=False, budget=None, threads=threads)
    assert source.file is not None
    return open_source(source.file.resolve(), options)


def _made(
    workers: Workers,
    job: TileJob,
    objects: dict[ColumnBlock, tuple[int, ...]],
    clustered: Callable[[ClusterProgress], None] | None,
) -> list[TileDone]:
    """Make all tiles, and join them to few where many workers can; returns these."""
    places = [(block.x // block.side, block.y // block.side) for block in objects]
    made: dict[tuple[int, int], TileDone] = {}
    size = 0

    def report() -> None:
        if clustered is not None:
            clustered(ClusterProgress(len(made), len(places), workers.count, size, workers.silent))

    for number, tile in workers.completed(partial(make_tile, job), list(objects.items()), waiting=report):
        made[places[number]] = tile
        size += tile.bytes
        report()
    pieces, level = {place: made[place] for place in places}, 0
    while workers.count >= JOINERS and len(pieces) > MOST_PIECES:
        level += 1
        groups = squares(pieces)
        calls = [(f"joined-{level}-{x}-{y}", parts) for (x, y), parts in groups.items()]
        joined = dict(workers.completed(partial(merge_tiles, job), calls))
        pieces = {place: joined[number] for number, place in enumerate(groups)}
    return list(pieces.values())


def squares(pieces: dict[tuple[int, int], T]) -> dict[tuple[int, int], list[T]]:
    """Return the pieces of each square that one task joins, by the square's place."""
    groups: dict[tuple[int, int], list[T]] = {}
    for (x, y), piece in pieces.items():
        groups.setdefault((x // FAN_IN, y // FAN_IN), []).append(piece)
    return groups
