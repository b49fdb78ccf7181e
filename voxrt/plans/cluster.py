"""Builds by several processes: tiles become tasks, of dask.distributed or here, and this process writes the result."""

from __future__ import annotations

import logging
import os
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from voxrt.errors import ToolError
from voxrt.plans.blockwise import block_voxelizer, join_tiles, tiles_key
from voxrt.plans.cluster_tasks import TileDone, TileJob, inherited_scene, make_tile, merge_tiles
from voxrt.plans.local_workers import completed
from voxrt.plans.tile_store import sum_tallies, tile_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from distributed import Client, Future

    from voxrt.octree import Octree
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.blockwise import BuildPlan
    from voxrt.plans.stage_clock import StageClock
    from voxrt.plans.tile_store import TileStore
    from voxrt.voxelize import BlockVoxelizer, ColumnBlock, Grid, Scene, VoxelizationReport

T = TypeVar("T")

_WAIT = 60.0
"""Seconds within which a scheduler and its first worker must answer."""

_FAN_IN = 4
"""Tiles along each side of a square that one task joins."""

_LOOK = 0.5
"""Seconds between two questions after the number of workers."""

_MOST_PIECES = 16
"""This process joins up to so many octrees alone."""

_JOINERS = 8
"""With fewer workers, this process joins all tiles: joins by few workers take longer than they save."""

_TILES_PER_WORKER = 4
"""Enough to even out their work. More tiles store more blocks twice, which the join removes again."""

_LEAST_SIDE = 512


@dataclass(frozen=True, slots=True)
class ClusterProgress:
    """How far a cluster is with a build.

    Attributes
    ----------
    done, tiles
        Finished tiles, and all.
    workers
        Workers that are connected.
    bytes
        Bytes of the finished tiles.
    """

    done: int
    tiles: int
    workers: int
    bytes: int


def cluster_side(voxelizer: BlockVoxelizer, grid: Grid, plan: BuildPlan, workers: int) -> int:
    """Return the columns per side of a tile: a few tiles per worker, more where the memory asks for it."""
    side = grid.size if plan.side is None else plan.side
    while side > _LEAST_SIDE and len(voxelizer.blocks(side)) < _TILES_PER_WORKER * workers:
        side //= 2
    return side


@contextmanager
def connected(scheduler: str) -> Iterator[Client]:
    """Connect to a scheduler.

    Raises
    ------
    ToolError
        dask.distributed is missing, or no scheduler answers, or it has no worker; also in place of what Dask raises in
        the block where a scheduler or its workers are lost.
    """
    try:
        from distributed import Client  # noqa: PLC0415 - the extra `cluster`
    except ImportError as error:
        raise ToolError(
            f"building on a cluster needs dask.distributed ({error}): pip install 'voxrt-build[cluster]'"
        ) from None
    for name in ("distributed", "tornado", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is said in one line, here
    with ExitStack() as stack:
        try:
            client = stack.enter_context(Client(scheduler, timeout=_WAIT, set_as_default=False))  # type: ignore[no-untyped-call]
            client.wait_for_workers(1, timeout=_WAIT)
        except (OSError, TimeoutError, ValueError) as error:
            raise ToolError(
                f"{scheduler}: no scheduler with a worker answers ({_line(error)}); start them by "
                "'dask scheduler' and 'dask worker ADDRESS'"
            ) from None
        yield client


def build_on_cluster(
    asset: str | os.PathLike[str],
    scene: Scene,
    grid: Grid,
    options: BuildOptions,
    clock: StageClock,
    *,
    plan: BuildPlan,
    store: TileStore,
    told: Callable[[ClusterProgress], None] | None = None,
) -> tuple[Octree, VoxelizationReport]:
    """Voxelize a scene and build its octree on a cluster, or by processes of this machine: the same bytes as by one.

    Parameters
    ----------
    asset
        The file that the workers open, at the same path as here.
    scene, grid, options, clock, plan, store
        As :func:`voxrt.plans.blockwise.build_octree` takes them. The workers write to `store`'s folder.
    told
        Called as tiles are finished.

    Raises
    ------
    ToolError
        There is no scheduler, it is lost, or a worker fails.
    OutputError
        The result cannot be written.
    """
    with clock.stage("voxelize"):
        voxelizer = block_voxelizer(scene, grid, options)
        voxelizer.prepare()
        key = tiles_key(voxelizer)
        shared = replace(options, scheduler=None, workers=None, preview=False, budget=None)
        threads = options.threads
        if options.workers is not None:
            threads = threads or max(1, (os.cpu_count() or 1) // options.workers)
        job = TileJob(os.fspath(Path(asset).resolve()), shared, grid, os.fspath(store.folder.resolve()), key, threads)
        with ExitStack() as stack:
            workers = options.workers or 1
            client = None if options.scheduler is None else stack.enter_context(connected(options.scheduler))
            if client is None:
                stack.enter_context(inherited_scene(key, voxelizer))
            else:
                workers = len(client.scheduler_info(n_workers=-1)["workers"])
            blocks = voxelizer.blocks(store.claim(key, cluster_side(voxelizer, grid, plan, workers)))
            objects = {block: voxelizer.objects_of(block) for block in blocks}
            if client is None:
                done = _run_here(job, objects, workers, told)
            else:
                done = _run(client, job, objects, workers, told)
    tallies = sum_tallies(np.concatenate([one.tallies for one in done]), len(scene.objects)) if done else None
    report = voxelizer.report(np.zeros((len(scene.objects), 4), np.int64) if tallies is None else tallies)
    del voxelizer
    with clock.stage("octree"):
        return join_tiles([one.name for one in done], grid.depth, store, plan.cache), report


def in_order(
    task: Callable[..., T], shared: object, arguments: Sequence[object], *, scheduler: str | None, workers: int | None
) -> Iterator[T]:
    """Call task(shared, number, argument) for each argument, and yield the results in their order.

    Parameters
    ----------
    task
        A function of a module.
    shared
        Its first argument, sent to each worker once.
    arguments
        Its last argument for each call; `number` counts them from 0.
    scheduler, workers
        Of the cluster that does so; without, so many processes of this machine.

    Raises
    ------
    ToolError
        There is no cluster, or it is lost.
    """
    if scheduler is None:
        yield from _in_order_here(task, shared, arguments, workers or 1)
        return
    with connected(scheduler) as client:
        try:
            sent = client.scatter(shared, broadcast=True)  # type: ignore[no-untyped-call]
            futures = [client.submit(task, sent, number, one, pure=False) for number, one in enumerate(arguments)]
            while futures:
                yield futures.pop(0).result()  # then its worker forgets it
        except (ToolError, GeneratorExit):
            raise
        except Exception as error:
            raise ToolError(f"the cluster is lost ({_line(error)}); start it, and this command, again") from error


def _in_order_here(task: Callable[..., T], shared: object, arguments: Sequence[object], workers: int) -> Iterator[T]:
    early: dict[int, T] = {}
    wanted = 0
    for number, result in completed(task, shared, list(enumerate(arguments)), workers):
        early[number] = result
        while wanted in early:
            yield early.pop(wanted)
            wanted += 1


def _run_here(
    job: TileJob,
    objects: dict[ColumnBlock, tuple[int, ...]],
    workers: int,
    told: Callable[[ClusterProgress], None] | None,
) -> list[TileDone]:
    """Make all tiles by processes of this machine, and join them to few where many processes can; returns these."""
    places = [(block.x // block.side, block.y // block.side) for block in objects]
    made: dict[tuple[int, int], TileDone] = {}
    size = 0
    for number, result in completed(make_tile, job, list(objects.items()), workers):
        made[places[number]] = tile = _checked(result)
        size += tile.bytes
        if told is not None:
            told(ClusterProgress(len(made), len(places), workers, size))
    pieces, level = {place: made[place] for place in places}, 0
    while workers >= _JOINERS and len(pieces) > _MOST_PIECES:
        level += 1
        groups = _squares(pieces)
        calls = [(_square_name(level, place), parts) for place, parts in groups.items()]
        joined = dict(completed(merge_tiles, job, calls, workers))
        pieces = {place: _checked(joined[number]) for number, place in enumerate(groups)}
    return list(pieces.values())


def _run(
    client: Client,
    job: TileJob,
    objects: dict[ColumnBlock, tuple[int, ...]],
    workers: int,
    told: Callable[[ClusterProgress], None] | None,
) -> list[TileDone]:
    """Make all tiles and join them to few; returns these."""
    from distributed import as_completed  # noqa: PLC0415 - the extra `cluster`

    tiles: dict[tuple[int, int], Future[Any]] = {}
    for block, reached in objects.items():
        future = client.submit(make_tile, job, block, reached, key=f"tile-{tile_name(block)}-{job.key}", pure=False)
        tiles[block.x // block.side, block.y // block.side] = future
    made = list(tiles.values())
    pieces, level = tiles, 0
    while workers >= _JOINERS and len(pieces) > _MOST_PIECES:
        level += 1
        pieces = _submit_merges(client, job, pieces, level)
    wanted = {future.key: future for future in (*made, *pieces.values())}
    done: dict[object, TileDone] = {}
    finished, size, looked = 0, 0, 0.0
    names = {future.key for future in made}
    try:
        for future in as_completed(list(wanted.values()), loop=client.loop):  # type: ignore[no-untyped-call]
            done[future.key] = tile = _checked(future.result())
            if future.key in names:
                finished, size = finished + 1, size + tile.bytes
                if told is not None:
                    if monotonic() - looked > _LOOK:
                        workers, looked = len(client.scheduler_info(n_workers=-1)["workers"]), monotonic()
                    told(ClusterProgress(finished, len(made), workers, size))
        return [done[future.key] for future in pieces.values()]
    except ToolError:
        raise
    except Exception as error:
        raise ToolError(
            f"the cluster is lost ({_line(error)}); finished tiles stay in {job.folder}, and the same build goes on "
            "from them"
        ) from error


def _checked(result: TileDone | str) -> TileDone:
    if isinstance(result, str):
        raise ToolError(result)
    return result


def _submit_merges(
    client: Client, job: TileJob, pieces: dict[tuple[int, int], Future[Any]], level: int
) -> dict[tuple[int, int], Future[Any]]:
    """Submit tasks that join the pieces of each square; pieces that stand alone stay as they are."""
    joined: dict[tuple[int, int], Future[Any]] = {}
    for place, parts in _squares(pieces).items():
        name = _square_name(level, place)
        joined[place] = client.submit(merge_tiles, job, name, parts, key=f"{name}-{job.key}", pure=False)
    return joined


def _squares(pieces: dict[tuple[int, int], T]) -> dict[tuple[int, int], list[T]]:
    groups: dict[tuple[int, int], list[T]] = {}
    for (x, y), piece in pieces.items():
        groups.setdefault((x // _FAN_IN, y // _FAN_IN), []).append(piece)
    return groups


def _square_name(level: int, place: tuple[int, int]) -> str:
    return f"joined-{level}-{place[0]}-{place[1]}"


def _line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]
