"""What the workers of a cluster do: make a tile, join tiles, render a picture.

A worker opens the asset itself, unless it is a fork of the process that did so. It keeps the scene from task to task,
and does one task at a time: the native stages use its threads. Tasks return what failed as text, for not every
exception can travel.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np

from voxrt import octree, voxelize
from voxrt.plans.blockwise import block_voxelizer, finish_tile, tiles_key
from voxrt.plans.stage_clock import StageClock
from voxrt.plans.tile_store import Tile, TileStore, sparse_tallies, sum_tallies, tile_name
from voxrt.sources.object_selection import without_objects
from voxrt.sources.source import load_asset

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from voxrt.options.build_options import BuildOptions
    from voxrt.voxelize import BlockVoxelizer, ColumnBlock, Grid


@dataclass(frozen=True, slots=True)
class TileJob:
    """What all tiles of a build have in common.

    Attributes
    ----------
    asset
        The asset's path, absolute.
    options, grid
        How it is built, and on which grid.
    folder
        Where tiles go.
    key
        What tells them from those of other builds. A worker that finds another key has another asset or program.
    threads
        Threads of the native stages; 0 for those of the worker.
    """

    asset: str
    options: BuildOptions
    grid: Grid
    folder: str
    key: str
    threads: int


@dataclass(frozen=True, slots=True)
class TileDone:
    """A tile, or several that were joined, in the folder.

    Attributes
    ----------
    name
        Its name there.
    bytes
        The size of its words.
    tallies
        As :class:`voxrt.plans.tile_store.Tile` has them.
    """

    name: str
    bytes: int
    tallies: NDArray[np.int64]


_ONE_AT_A_TIME = Lock()
_scene: dict[str, BlockVoxelizer] = {}  # by the key of the build: that of the last one
_part: dict[tuple[str, tuple[int, ...]], BlockVoxelizer] = {}  # and that of its objects that were wanted last
_inherited: dict[str, BlockVoxelizer] = {}  # by the key of the build: of the process that this one is a fork of


@contextmanager
def inherited_scene(key: str, voxelizer: BlockVoxelizer) -> Iterator[None]:
    """Give the scene of a build to all forks of this process that are made in the block."""
    _inherited[key] = voxelizer
    try:
        yield
    finally:
        del _inherited[key]


def make_tile(job: TileJob, block: ColumnBlock, objects: tuple[int, ...]) -> TileDone | str:
    """Voxelize a tile and build its octree, if nobody did yet.

    Parameters
    ----------
    job
        The build.
    block
        The tile.
    objects
        Numbers of the objects that reach it.

    Returns
    -------
    TileDone or str
        The tile, or what is wrong.
    """
    with _ONE_AT_A_TIME:
        try:
            store = _store(job)
            done = store.read(tile_name(block))
            if done is None:
                voxelizer = _voxelizer(job, objects)
                if voxelizer is None:
                    return f"{job.asset}: a worker has another file, or another version of voxrt, than this machine"
                done = finish_tile(voxelizer, block, StageClock(None), store, _threads(job))
        except Exception as error:  # noqa: BLE001 - not every exception can travel
            return _problem(error)
        return TileDone(tile_name(block), done.octree.words.nbytes, done.tallies)


def merge_tiles(job: TileJob, name: str, parts: Sequence[TileDone | str]) -> TileDone | str:
    """Join finished tiles to one, if nobody did yet; returns it, or what is wrong."""
    failed = [part for part in parts if isinstance(part, str)]
    if failed:
        return failed[0]
    with _ONE_AT_A_TIME:
        try:
            store = _store(job)
            done = store.read(name)
            if done is None:
                joined = _joined(job, store, [part.name for part in parts if isinstance(part, TileDone)])
                if isinstance(joined, str):
                    return joined
                store.write(name, joined)
                done = joined
        except Exception as error:  # noqa: BLE001 - as above
            return _problem(error)
        return TileDone(name, done.octree.words.nbytes, done.tallies)


def _joined(job: TileJob, store: TileStore, names: Sequence[str]) -> Tile | str:
    whole = octree.Assembly(job.grid.depth)
    rows = []
    for name in names:
        tile = store.read(name)
        if tile is None:
            return f"{store.path(name)}: is missing or damaged; build again, which makes it anew"
        whole.add(tile.octree)
        rows.append(tile.tallies)
    tallies = np.concatenate(rows)
    return Tile(whole.octree(), sparse_tallies(sum_tallies(tallies, int(tallies[:, 0].max(initial=0)) + 1)))


def _voxelizer(job: TileJob, objects: tuple[int, ...]) -> BlockVoxelizer | None:
    """Return the voxelizer of some objects; None where the scene is another one than that of the job."""
    if (ready := _inherited.get(job.key)) is not None:
        ready.use_threads(_threads(job))
        return ready
    if (part := _part.get((job.key, objects))) is not None:
        return part
    _part.clear()
    whole = _scene.get(job.key)
    if whole is None:
        _scene.clear()
        options = replace(job.options, threads=_threads(job))
        path = Path(job.asset)
        loaded = without_objects(job.asset, load_asset(path, options), options.ignore)
        scene = voxelize.assign_colours(loaded, job.grid, colours=options.colours, geometry=options.geometry)
        whole = block_voxelizer(scene, job.grid, options)
        if tiles_key(whole) != job.key:
            return None
        _scene[job.key] = whole
    _part[job.key, objects] = part = whole.restricted(objects)
    return part


def _threads(job: TileJob) -> int:
    """Return the threads that a task may use: those that its worker was given."""
    if job.threads:
        return job.threads
    from distributed import get_worker  # noqa: PLC0415 - the extra `cluster`; workers have it

    return max(1, get_worker().state.nthreads)


def _store(job: TileJob) -> TileStore:
    return TileStore(Path(job.folder), job.key)


def _problem(error: Exception) -> str:
    if isinstance(error, MemoryError):
        return "a worker is out of memory; give it more, or a smaller --memory"
    return f"a worker failed: {str(error) or type(error).__name__}"
