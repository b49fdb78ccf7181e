"""Builds on many machines, by dask.distributed: tiles become tasks, and this process writes the result."""

from __future__ import annotations

import logging
import os
import signal
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from multiprocessing import resource_tracker
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from voxrt.blockwise import block_voxelizer, join_tiles, tiles_key
from voxrt.cluster_tasks import TileDone, TileJob, make_tile, merge_tiles
from voxrt.errors import ToolError
from voxrt.tile_store import sum_tallies, tile_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from distributed import Client, Future

    from voxrt.blockwise import BuildPlan
    from voxrt.build_options import BuildOptions
    from voxrt.octree import Octree
    from voxrt.stage_clock import StageClock
    from voxrt.tile_store import TileStore
    from voxrt.voxelize import ColumnBlock, Grid, Scene, VoxelizationReport

T = TypeVar("T")

_WAIT = 60.0
"""Seconds within which a scheduler and its first worker must answer."""

_FAN_IN = 4
"""Tiles along each side of a square that one task joins."""

_LOCAL = {
    "distributed.worker.profile.enabled": False,  # a sampler beside native code
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 28,  # Dask's gives all back after each tile
}
"""Dask's configuration for workers on this machine."""

_LOOK = 0.5
"""Seconds between two questions after the number of workers."""

_MOST_PIECES = 16
"""So many octrees are joined by this process alone."""


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


def cluster_side(grid: Grid, plan: BuildPlan) -> int:
    """Return the columns per side of a tile: a sixteenth of the grid's, or 512; less where the memory asks for it."""
    side = max(512, grid.size // 16)
    return side if plan.side is None else min(side, plan.side)


@contextmanager
def connected(scheduler: str | None, workers: int | None) -> Iterator[Client]:
    """Connect to a scheduler, or, without its address, start workers on this machine.

    Raises
    ------
    ToolError
        dask.distributed is missing, or no scheduler answers, or it has no worker; also in place of what Dask raises in
        the block where a scheduler or its workers are lost.
    """
    try:
        from distributed import Client, LocalCluster  # noqa: PLC0415 - the extra `cluster`
    except ImportError as error:
        raise ToolError(
            f"building on a cluster needs dask.distributed ({error}): pip install 'voxrt-build[cluster]'"
        ) from None
    for name in ("distributed", "tornado", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is said in one line, here
    with ExitStack() as stack:
        address: Any = scheduler
        try:
            if address is None:
                address = stack.enter_context(_local_cluster(LocalCluster, workers or 1))
            client = stack.enter_context(Client(address, timeout=_WAIT, set_as_default=False))  # type: ignore[no-untyped-call]
            client.wait_for_workers(1, timeout=_WAIT)
        except (OSError, TimeoutError, ValueError) as error:
            where = scheduler or "this machine"
            raise ToolError(
                f"{where}: no scheduler with a worker answers ({_line(error)}); start them by "
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
    """Voxelize a scene and build its octree on a cluster: the same bytes as on one machine.

    Parameters
    ----------
    asset
        The file that the workers open, at the same path as here.
    scene, grid, options, clock, plan, store
        As :func:`voxrt.blockwise.build_octree` takes them. The workers write to `store`'s folder.
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
        key = tiles_key(voxelizer)
        blocks = voxelizer.blocks(store.claim(key, cluster_side(grid, plan)))
        shared = replace(options, scheduler=None, workers=None, preview=False, budget=None)
        local_threads = max(1, (os.cpu_count() or 1) // (options.workers or 1)) if options.scheduler is None else 0
        folder = os.fspath(store.folder.resolve())
        job = TileJob(os.fspath(Path(asset).resolve()), shared, grid, folder, key, options.threads or local_threads)
        with connected(options.scheduler, options.workers) as client:
            objects = {block: voxelizer.objects_of(block) for block in blocks}
            done = _run(client, job, objects, told)
    tallies = sum_tallies(np.concatenate([one.tallies for one in done]), len(scene.objects)) if done else None
    report = voxelizer.report(np.zeros((len(scene.objects), 4), np.int64) if tallies is None else tallies)
    del voxelizer
    with clock.stage("octree"):
        return join_tiles([one.name for one in done], grid.depth, store, plan.cache or 1 << 28), report


def in_order(
    task: Callable[..., T], shared: object, arguments: Sequence[object], *, scheduler: str | None, workers: int | None
) -> Iterator[T]:
    """Call task(shared, number, argument) for each argument on a cluster, and yield the results in their order.

    Parameters
    ----------
    task
        A function of a module.
    shared
        Its first argument, sent to each worker once.
    arguments
        Its last argument for each call; `number` counts them from 0.
    scheduler, workers
        As :func:`connected` takes them.

    Raises
    ------
    ToolError
        There is no cluster, or it is lost.
    """
    with connected(scheduler, workers) as client:
        try:
            sent = client.scatter(shared, broadcast=True)  # type: ignore[no-untyped-call]
            futures = [client.submit(task, sent, number, one, pure=False) for number, one in enumerate(arguments)]
            while futures:
                yield futures.pop(0).result()  # then its worker forgets it
        except (ToolError, GeneratorExit):
            raise
        except Exception as error:
            raise ToolError(f"the cluster is lost ({_line(error)}); start it, and this command, again") from error


def _run(
    client: Client,
    job: TileJob,
    objects: dict[ColumnBlock, tuple[int, ...]],
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
    while len(pieces) > _MOST_PIECES:
        level += 1
        pieces = _submit_merges(client, job, pieces, level)
    wanted = {future.key: future for future in (*made, *pieces.values())}
    done: dict[object, TileDone] = {}
    finished, size, workers, looked = 0, 0, 0, 0.0
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
    groups: dict[tuple[int, int], list[Future[Any]]] = {}
    for (x, y), piece in pieces.items():
        groups.setdefault((x // _FAN_IN, y // _FAN_IN), []).append(piece)
    joined: dict[tuple[int, int], Future[Any]] = {}
    for (x, y), parts in groups.items():
        name = f"joined-{level}-{x}-{y}"
        joined[x, y] = client.submit(merge_tiles, job, name, parts, key=f"{name}-{job.key}", pure=False)
    return joined


@contextmanager
def _local_cluster(cluster: Any, workers: int) -> Iterator[Any]:  # noqa: ANN401 - a class of Dask
    """Start workers on this machine. Ctrl-C is for this process alone: it ends them."""
    import dask  # noqa: PLC0415 - the extra `cluster`

    resource_tracker.ensure_running()  # which unblocks SIGINT, and would do so below
    with TemporaryDirectory(prefix="voxrt-") as scratch, ExitStack() as stack:
        stack.enter_context(dask.config.set({"temporary-directory": scratch, **_LOCAL}))
        before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            started = cluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                memory_limit=0,
                local_directory=scratch,
                env={"TMPDIR": scratch},  # what a killed worker leaves goes with it
                silence_logs=logging.CRITICAL,
            )
            stack.enter_context(started)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        yield started


def _line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]
