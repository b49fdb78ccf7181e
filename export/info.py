"""The facts of a memory at a glance."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from msgspec import Struct

from voxrt.octree import BOARDS, census, shared_words, solid_bounds
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from voxrt.octree import Rom

Corner: TypeAlias = tuple[int, int, int]


class LevelInfo(Struct, frozen=True):
    """How many leaves of 2**level voxels per side are solid, and how many are empty."""

    level: int
    solid: int
    empty: int


class MaterialInfo(Struct, frozen=True):
    """A material and the voxels that have it."""

    id: int
    name: str
    colour: tuple[int, int, int]
    voxels: int


class BoardInfo(Struct, frozen=True):
    """A board, the words that its octree memory holds, and whether these fit."""

    name: str
    words: int
    fits: bool


class RomInfo(Value, frozen=True):
    """The facts of a memory, as :func:`rom_info` returns them.

    Attributes
    ----------
    name, depth, words, blocks
        As in the manifest.
    shared_words
        Words once equal blocks are shared: fewer than `words` if the memory stores a block twice.
    unshared_blocks
        Blocks without sharing: one per octant that is not uniform.
    voxels
        Solid voxels.
    bounds
        The smallest box that holds them: its lowest voxel, and one behind its highest. None if all is empty.
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
    """Return the facts of a memory. A shared block counts once for each place where it stands.

    Examples
    --------
    >>> import voxrt
    >>> facts = rom_info(voxrt.build("examples/house.obj", depth=4).rom)
    >>> facts.words, facts.voxels, facts.bounds, facts.boards[0].fits
    (721, 2504, ((0, 0, 0), (16, 16, 16)), True)
    """
    counts = census(rom.octree)
    voxels = counts.voxels
    leaves = [int(row.sum()) for row in counts.leaves]
    words = len(rom.octree.words)
    return RomInfo(
        name=rom.name,
        depth=rom.octree.depth,
        words=words,
        blocks=rom.octree.blocks,
        shared_words=shared_words(rom.octree),
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
