"""How one tile is made, by whichever process."""

from __future__ import annotations

from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt import octree
from voxrt.octree import _native as octree_native
from voxrt.plans.tile_store import Tile, sparse_tallies, tile_name
from voxrt.voxelize import BlockVoxelizer
from voxrt.voxelize import _native as voxelize_native

if TYPE_CHECKING:
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.stage_clock import StageClock
    from voxrt.plans.tile_store import MemoryTiles, TileStore
    from voxrt.voxelize import ColumnBlock, Grid, Scene


def tiles_key(voxelizer: BlockVoxelizer) -> str:
    """Return what tells the tiles of one build from those of another: 32 hexadecimal digits.

    It is of the scene on its grid, and of the native modules that make tiles of it.
    """
    digest = blake2b(voxelizer.key.encode(), digest_size=16)
    for module in (voxelize_native, octree_native):
        digest.update(Path(str(module.__file__)).read_bytes())
    return digest.hexdigest()


def block_voxelizer(scene: Scene, grid: Grid, options: BuildOptions) -> BlockVoxelizer:
    """Make a scene ready to be voxelized tile by tile."""
    return BlockVoxelizer(
        scene, grid, fill=options.fill, geometry=options.geometry, pow2=options.pow2, threads=options.threads
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
