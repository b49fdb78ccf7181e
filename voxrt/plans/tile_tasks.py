"""How a tile is made, by whichever process, and the tasks of a plan that several workers run: make a tile, join tiles.

A worker loads the source itself, unless it is a fork of the process that did so. It keeps the scene from task to task,
and does one task at a time: the native stages use its threads.
"""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from voxrt import octree, voxelize
from voxrt.errors import ToolError
from voxrt.octree import _native as octree_native
from voxrt.plans.stage_clock import StageClock
from voxrt.plans.tile_store import Tile, add_tile, sparse_tallies, sum_tallies, tile_name
from voxrt.voxelize import BlockVoxelizer
from voxrt.voxelize import _native as voxelize_native

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.tile_store import MemoryTiles, TileStore
    from voxrt.sources.source import Source
    from voxrt.voxelize import ColumnBlock, Grid, Scene


def tiles_key(voxelizer: BlockVoxelizer) -> str:
    """Return what tells the tiles of one build from those of another: 32 hexadecimal digits.

    It is of the scene on its grid, and of the native modules that make tiles of it.
    """
    from hashlib import blake2b  # noqa: PLC0415 - slow to import, and most builds have no tiles

    digest = blake2b(voxelizer.key.encode(), digest_size=16)
    for module in (voxelize_native, octree_native):
        digest.update(Path(str(module.__file__)).read_bytes())
    return digest.hexdigest()


def scene_on_grid(scene: Scene, grid: Grid, options: BuildOptions) -> Scene:
    """Return a scene whose points are meshes and whose colours are materials, as a grid shows them.

    DoesNotFitError if the scene's own materials leave no id for colours.
    """
    colours, fill, geometry = options.colours, options.fill_per_object, options.geometry
    placed = voxelize.place_points(scene, grid, colours=colours, fill=fill, geometry=geometry)
    return voxelize.assign_colours(placed, grid, colours=colours, geometry=geometry)


def block_voxelizer(scene: Scene, grid: Grid, options: BuildOptions) -> BlockVoxelizer:
    """Make a scene ready to be voxelized tile by tile."""
    return BlockVoxelizer(
        scene,
        grid,
        fill=options.fill_per_object,
        rule=options.rule,
        thin=options.thin,
        geometry=options.geometry,
        pow2=options.pow2,
        threads=options.threads,
    )


def finish_tile(
    voxelizer: BlockVoxelizer, block: ColumnBlock, clock: StageClock, tiles: TileStore | MemoryTiles, threads: int
) -> Tile:
    """Return a tile from where tiles are kept, or make it and keep it there."""
    tile = tiles.read(tile_name(block))
    if tile is None:
        with clock.stage("voxelize"):
            voxels, tallies = voxelizer.voxelize(block)
        with clock.stage("octree"):
            tile = Tile(octree.build(voxels, threads=threads), sparse_tallies(tallies))
            tiles.write(tile_name(block), tile)
    return tile


class TileJob(Struct, frozen=True):
    """What all tiles of a build have in common.

    A worker that finds another key than that of the store has another asset or program.
    """

    source: Source  # what each worker loads: a file by its absolute path
    grid: Grid
    store: TileStore  # where tiles go


class TileDone(Struct, frozen=True):
    """A tile, or several that were joined, in the folder."""

    name: str  # its name there
    bytes: int  # the size of its words
    tallies: NDArray[np.int64]  # as :class:`voxrt.plans.tile_store.Tile` has them


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


def make_tile(job: TileJob, block: ColumnBlock, objects: tuple[int, ...]) -> TileDone:
    """Voxelize a tile that these objects reach and build its octree, if nobody did yet.

    ToolError if the scene is another one than that of the job.
    """
    with _ONE_AT_A_TIME:
        tile = job.store.read(tile_name(block))
        if tile is None:
            tile = finish_tile(_voxelizer(job, objects), block, StageClock(None), job.store, _threads(job))
        return TileDone(tile_name(block), tile.octree.words.nbytes, tile.tallies)


def merge_tiles(job: TileJob, name: str, parts: Sequence[TileDone]) -> TileDone:
    """Join finished tiles to one, if nobody did yet; ToolError if one is missing or damaged."""
    with _ONE_AT_A_TIME:
        tile = job.store.read(name)
        if tile is None:
            tile = _joined(job, [part.name for part in parts])
            job.store.write(name, tile)
        return TileDone(name, tile.octree.words.nbytes, tile.tallies)


def _joined(job: TileJob, names: Sequence[str]) -> Tile:
    whole = octree.Assembly(job.grid.depth)
    rows = []
    for name in names:
        tile = job.store.read(name)
        if tile is None:
            raise ToolError(job.store.missing(name))
        add_tile(whole, tile)
        rows.append(tile.tallies)
    tallies = np.concatenate(rows)
    return Tile(whole.octree(), sparse_tallies(sum_tallies(tallies, int(tallies[:, 0].max(initial=0)) + 1)))


def _voxelizer(job: TileJob, objects: tuple[int, ...]) -> BlockVoxelizer:
    """Return the voxelizer of some objects."""
    key, threads = job.store.key, _threads(job)
    if (ready := _inherited.get(key)) is not None:
        ready.use_threads(threads)
        return ready
    if (part := _part.get((key, objects))) is not None:
        return part
    _part.clear()
    whole = _scene.get(key)
    if whole is None:
        _scene.clear()
        options = replace(job.source.options, threads=threads)
        scene = scene_on_grid(job.source.load(), job.grid, options)
        whole = block_voxelizer(scene, job.grid, options)
        if tiles_key(whole) != key:
            raise ToolError(
                f"{job.source.label}: a worker has another file, or another version of voxrt, than this machine"
            )
        _scene[key] = whole
    _part[key, objects] = part = whole.restricted(objects)
    return part


def _threads(job: TileJob) -> int:
    """Return the threads that a task may use: those of the job, or those that its worker was given."""
    if job.source.options.threads:
        return job.source.options.threads
    from distributed import get_worker  # noqa: PLC0415 - the extra `cluster`; workers have it

    return max(1, get_worker().state.nthreads)
