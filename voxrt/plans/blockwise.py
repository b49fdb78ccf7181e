"""From a scene to its octree: at once, or tile by tile where the voxels do not fit the memory.

A tile is a square of columns of the grid. Its octree is made alone; the octrees of the tiles are joined to the same
words as those of all voxels at once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt import octree, voxelize
from voxrt.octree import _native as octree_native
from voxrt.outputs import OutputError
from voxrt.plans.estimate import estimate_build
from voxrt.plans.tile_store import Tile, TileStore, sparse_tallies, sum_tallies, tile_name
from voxrt.voxelize import BlockVoxelizer, VoxelizationReport
from voxrt.voxelize import _native as voxelize_native
from voxrt.voxelize.free_memory import free_memory

if TYPE_CHECKING:
    from collections.abc import Iterable

    from voxrt.octree import Octree
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.estimate import BuildEstimate
    from voxrt.plans.stage_clock import StageClock
    from voxrt.voxelize import ColumnBlock, Grid, Scene

_LEAST_DEPTH = 11
"""Grids of fewer levels are built at once: their voxels take less memory than the tables of a thread."""

_LEAST_SIDE = 256
_UNEVEN = 8  # a square may have so many times its share of the surface
_BLOCKS_PER_SURFACE_VOXEL = 0.0132  # of a scan with 2**28 surface voxels; it halves with 16 times as many
_BYTES_PER_JOINED_BLOCK = 60
_BYTES_PER_BLOCK_OF_TABLE = 20
_BYTES_OF_BLOCK = 32
_COPIES_ON_DISK = 3  # the tiles, the blocks that are joined, and the words


@dataclass(frozen=True, slots=True)
class BuildPlan:
    """How a scene becomes an octree, and what that takes.

    Attributes
    ----------
    side
        Columns per side of a tile; None for all voxels at once.
    cache
        Bytes of memory for blocks, where they are joined on the disk.
    estimate
        What the build takes so.
    """

    side: int | None
    cache: int
    estimate: BuildEstimate


def plan_build(scene: Scene, grid: Grid, options: BuildOptions, *, on_disk: bool) -> BuildPlan:
    """Choose the tiles for a build: such that their voxels fit the memory; none where all voxels do.

    Parameters
    ----------
    scene, grid, options
        What is built, on which grid, and how.
    on_disk
        Whether tiles may go to the disk.

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
        return BuildPlan(None, 0, estimate)
    side, taken = grid.size, _UNEVEN * estimate.bytes // 2
    while side >= 2 * max(estimate.width, _LEAST_SIDE):  # the scene is in few of such squares
        side //= 2
    while taken > allowed // 2 and side > _LEAST_SIDE:
        side, taken = side // 2, taken // 4
    return BuildPlan(side, allowed // 4, _in_tiles(estimate, min(taken, estimate.bytes), allowed // 4, on_disk=on_disk))


def tiles_key(voxelizer: BlockVoxelizer) -> str:
    """Return what tells the tiles of one build from those of another: 32 hexadecimal digits.

    It is of the scene on its grid, and of the native modules that make tiles of it.
    """
    digest = blake2b(voxelizer.key.encode(), digest_size=16)
    for module in (voxelize_native, octree_native):
        digest.update(Path(str(module.__file__)).read_bytes())
    return digest.hexdigest()


def block_voxelizer(
    scene: Scene, grid: Grid, options: BuildOptions, objects: Iterable[int] | None = None
) -> BlockVoxelizer:
    """Make a scene ready to be voxelized tile by tile; `objects`: as :class:`voxrt.voxelize.BlockVoxelizer` has it."""
    return BlockVoxelizer(
        scene,
        grid,
        fill=options.fill,
        geometry=options.geometry,
        pow2=options.pow2,
        threads=options.threads,
        objects=objects,
    )


def finish_tile(
    voxelizer: BlockVoxelizer, block: ColumnBlock, clock: StageClock, store: TileStore | None, threads: int
) -> Tile:
    """Return a tile from the store, or make it and keep it there."""
    tile = None if store is None else store.read(tile_name(block))
    if tile is not None:
        return tile
    with clock.stage("voxelize"):
        voxels, found = voxelizer.voxelize(block)
    with clock.stage("octree"):
        tile = Tile(octree.build(voxels, threads=threads), sparse_tallies(found))
        if store is not None:
            store.write(tile_name(block), tile)
    return tile


def build_octree(
    scene: Scene,
    grid: Grid,
    options: BuildOptions,
    clock: StageClock,
    *,
    plan: BuildPlan | None = None,
    store: TileStore | None = None,
) -> tuple[Octree, VoxelizationReport]:
    """Voxelize a scene and build its octree, in the stages "voxelize" and "octree".

    Parameters
    ----------
    scene, grid, options
        What is built, on which grid, and how.
    clock
        Counts the stages.
    plan
        Of :func:`plan_build`; None to make one.
    store
        Where tiles and words go that do not fit the memory; None to keep them in memory all the same.

    Returns
    -------
    octree
        The octree. Its words may be those of a file in `store`.
    report
        How each object was voxelized.

    Raises
    ------
    OutputError
        The disk is full.
    """
    plan = plan_build(scene, grid, options, on_disk=store is not None) if plan is None else plan
    if plan.side is not None:
        return _build_tiles(scene, grid, options, clock, tiling=(plan.side, plan.cache), store=store)
    with clock.stage("voxelize"):
        made = voxelize.voxelize(
            scene, grid, fill=options.fill, geometry=options.geometry, pow2=options.pow2, threads=options.threads
        )
    with clock.stage("octree"):
        tree = octree.build(made.voxels, threads=options.threads)
    return tree, VoxelizationReport(made.objects, made.warnings, made.seconds)


def join_tiles(names: Iterable[str], depth: int, store: TileStore, cache: int) -> Octree:
    """Join finished tiles to the octree of the world.

    Parameters
    ----------
    names, depth, store
        The tiles, the levels of the world, and where tiles are.
    cache
        Bytes of memory for blocks: these go to the disk, and the words to the store's file. 0 to join in memory.

    Raises
    ------
    OutputError
        A tile is missing or damaged, or the disk is full.
    """
    try:
        whole: octree.DiskAssembly | octree.Assembly
        if cache:
            whole = octree.DiskAssembly(depth, store.folder, cache=cache)
        else:
            names = tuple(names)
            blocks = sum(path.stat().st_size for path in map(store.path, names) if path.exists()) // _BYTES_OF_BLOCK
            whole = octree.Assembly(depth, expected_blocks=min(blocks, 1 << 28))
        for name in names:
            tile = store.read(name)
            if tile is None:
                raise OutputError(f"{store.path(name)}: is missing or damaged; build again, which makes it anew")
            whole.add(tile.octree)
        return whole.octree() if isinstance(whole, octree.Assembly) else whole.octree(store.words)
    except OSError as error:
        raise OutputError(
            f"{store.folder}: cannot be written: {error.strerror or error}; finished tiles stay, and the same build "
            "goes on from them"
        ) from error


def _build_tiles(
    scene: Scene,
    grid: Grid,
    options: BuildOptions,
    clock: StageClock,
    *,
    tiling: tuple[int, int],  # columns per side of a tile, and the cache
    store: TileStore | None,
) -> tuple[Octree, VoxelizationReport]:
    side, cache = tiling
    with clock.stage("voxelize"):
        voxelizer = block_voxelizer(scene, grid, options)
        if store is not None:
            side = store.claim(tiles_key(voxelizer), side)
        blocks = voxelizer.blocks(side)
    tallies = np.zeros((len(scene.objects), 4), np.int64)
    whole = octree.Assembly(grid.depth)
    for block in blocks:
        tile = finish_tile(voxelizer, block, clock, store, options.threads)
        if store is None:
            with clock.stage("octree"):
                whole.add(tile.octree)
        tallies += sum_tallies(tile.tallies, len(tallies))
    report = voxelizer.report(tallies)
    del voxelizer  # to make room for the blocks
    with clock.stage("octree"):
        if store is None:
            return whole.octree(), report
        return join_tiles(map(tile_name, blocks), grid.depth, store, cache), report


def _in_tiles(estimate: BuildEstimate, tile: int, cache: int, *, on_disk: bool) -> BuildEstimate:
    """Return what a build takes whose voxels are in memory tile by tile, `tile` bytes each."""
    blocks = int(_BLOCKS_PER_SURFACE_VOXEL * estimate.surface * min(1.0, (2**28 / max(estimate.surface, 1)) ** 0.25))
    if not on_disk:
        return replace(estimate, bytes=estimate.least + tile + _BYTES_PER_JOINED_BLOCK * blocks)
    joined = _BYTES_PER_BLOCK_OF_TABLE * blocks + min(cache, _BYTES_OF_BLOCK * blocks)
    disk = _COPIES_ON_DISK * _BYTES_OF_BLOCK * blocks
    return replace(estimate, bytes=estimate.least + max(tile, joined), disk=disk)
