"""What there is to know of a memory at a glance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from voxrt.octree import BOARDS, census, share, solid_bounds

if TYPE_CHECKING:
    from voxrt.octree import Rom

    Corner = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class LevelInfo:
    """Leaves of side 2**level voxels: how many are solid, how many empty."""

    level: int
    solid: int
    empty: int


@dataclass(frozen=True, slots=True)
class MaterialInfo:
    """A material and the voxels that have it."""

    id: int
    name: str
    colour: tuple[int, int, int]
    voxels: int


@dataclass(frozen=True, slots=True)
class BoardInfo:
    """A board, the words that its octree memory holds, and whether these fit."""

    name: str
    words: int
    fits: bool


@dataclass(frozen=True, slots=True)
class RomInfo:
    """What there is to know of a memory.

    Attributes
    ----------
    name, depth, words, blocks
        As in the manifest.
    shared_words
        Words once equal blocks are shared: fewer than `words` where the memory repeats itself.
    unshared_blocks
        Blocks that it would take without sharing, a block a mixed octant.
    voxels
        Solid voxels.
    bounds
        The smallest box (lowest voxel, one behind the highest) that holds them; None where all is empty.
    levels
        From the largest octants to the smallest.
    materials
        Those in the table, by id.
    boards
        The boards known.
    """

    name: str
    depth: int
    words: int
    blocks: int
    shared_words: int
    unshared_blocks: int
    voxels: int
    bounds: tuple[Corner, Corner] | None
    levels: tuple[LevelInfo, ...]
    materials: tuple[MaterialInfo, ...]
    boards: tuple[BoardInfo, ...]


def rom_info(rom: Rom) -> RomInfo:
    """Tell what there is to know of `rom`, counting shared blocks wherever they stand."""
    counts = census(rom.octree)
    voxels = counts.voxels
    leaves = [int(row.sum()) for row in counts.leaves]
    words = len(rom.octree.words)
    return RomInfo(
        name=rom.name,
        depth=rom.octree.depth,
        words=words,
        blocks=rom.octree.blocks,
        shared_words=len(share(rom.octree).words),
        unshared_blocks=(sum(leaves) - 1) // 7,
        voxels=counts.solid_voxels,
        bounds=solid_bounds(rom.octree),
        levels=tuple(
            LevelInfo(level, leaves[level] - int(counts.leaves[level, 0]), int(counts.leaves[level, 0]))
            for level in reversed(range(len(leaves)))
        ),
        materials=tuple(
            MaterialInfo(i, entry.name, entry.colour, voxels.get(i, 0)) for i, entry in enumerate(rom.materials)
        ),
        boards=tuple(BoardInfo(name, size, words <= size) for name, size in BOARDS.items()),
    )
