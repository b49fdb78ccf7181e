"""The 32-bit words of an octree memory. This module alone knows their bits; the others in Python ask it.

A word with bit 31 clear is a pointer: the address of octant 0 of a block of 8 words. Any other word is a leaf, which
holds a material; 0 is empty space. Word 0 is the root; blocks stand at 1 + 8k. The index of an octant in
its block is {z, y, x}, x in bit 0. Four dialects mark leaves:

============ ==================== ====================================================
dialect      leaf of material m   read by
============ ==================== ====================================================
``report``   ``0xFFFFFF00 | m``   this project's hardware; the report of the original
``seed-rtl`` ``0xFFFFFFF0 | m``   the original's published bitstreams: the low 3 bits
                                  count, so FFFFFF00 … FFFFFF07 are read as well
``msb``      ``0x80000000 | m``   the C++ program of the original's report
``lod``      ``0xFFFFFF00 | m``   configurations of this project's hardware with level of detail
============ ==================== ====================================================

In ``lod`` a pointer is 256 times the number of the block, plus its mean material; block k is at address 1 + 8k. Octrees
in memory have the words of ``report``; functions here mean those where they name no dialect.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args, overload

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Dialect: TypeAlias = Literal["report", "seed-rtl", "msb", "lod"]
DIALECTS: tuple[Dialect, ...] = get_args(Dialect)

TAGS: dict[Dialect, int] = {"report": 0xFFFFFF00, "seed-rtl": 0xFFFFFFF0, "msb": 0x80000000, "lod": 0xFFFFFF00}
"""The leaf of material 0 in each dialect."""

EMPTY = TAGS["report"]
"""The leaf of empty space."""

SEED_MATERIALS = 7
"""The highest material of dialect ``seed-rtl``."""

LOD_BLOCKS = (1 << 24) - 1
"""The most blocks of a memory of dialect ``lod``."""

_LAST_BLOCK = 0x7FFFFFF9  # the highest pointer: one to 1 + 8k with bit 31 clear


@overload
def is_leaf(words: int) -> bool: ...
@overload
def is_leaf(words: NDArray[np.uint32]) -> NDArray[np.bool_]: ...
def is_leaf(words: Any) -> Any:
    """Return whether a word is a leaf and no pointer, in the dialects ``report``, ``seed-rtl`` and ``msb``."""
    return words >> 31 != 0


@overload
def material(words: int) -> int: ...
@overload
def material(words: NDArray[np.uint32]) -> NDArray[np.uint32]: ...
def material(words: Any) -> Any:
    """Return the material id of a leaf; 0 is empty space. The dialect is not ``seed-rtl``."""
    return words & 0xFF


@overload
def leaf(materials: int) -> int: ...
@overload
def leaf(materials: NDArray[np.uint32]) -> NDArray[np.uint32]: ...
def leaf(materials: Any) -> Any:
    """Return the leaf of a material id, 0 ... 255."""
    return EMPTY | materials


def move_pointers(words: NDArray[np.uint32], distance: int) -> NDArray[np.uint32]:
    """Return words whose pointers lead `distance` words further; leaves stay."""
    return np.where(is_leaf(words), words, words + np.uint32(distance % (1 << 32)))


def is_leaf_of(words: NDArray[np.uint32], dialect: Dialect) -> NDArray[np.bool_]:
    """Return whether each word is a leaf that `dialect` has."""
    tag = TAGS["msb"] if dialect == "msb" else EMPTY
    found: NDArray[np.bool_] = words >> np.uint32(8) == np.uint32(tag >> 8)
    if dialect == "seed-rtl":
        found &= np.isin(words & np.uint32(0xF8), (0x00, 0xF0))
    return found


def with_tag(leaves: NDArray[np.uint32], dialect: Dialect) -> NDArray[np.uint32]:
    """Return leaves of dialect ``report`` as those of another."""
    return np.uint32(TAGS[dialect]) | material(leaves)


def without_tag(leaves: NDArray[np.uint32], dialect: Dialect) -> NDArray[np.uint32]:
    """Return leaves of a dialect as those of ``report``."""
    return leaf(leaves & np.uint32(SEED_MATERIALS) if dialect == "seed-rtl" else material(leaves))


def lod_words(words: NDArray[np.uint32], means: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """Return words in dialect ``lod``. `means` holds the mean material of each block, one or more."""
    leaves = is_leaf(words)
    blocks = np.where(leaves, 0, words) >> np.uint32(3)
    return np.where(leaves, words, blocks << np.uint32(8) | means[blocks])


def lod_pointers(words: NDArray[np.uint32]) -> tuple[NDArray[np.uint32], NDArray[np.uint8]]:
    """Return the blocks that pointers of dialect ``lod`` lead to, and their mean materials."""
    return words >> np.uint32(8), material(words).astype(np.uint8)


def from_lod_words(words: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Return words of dialect ``lod`` as those of ``report``."""
    # A block behind the memory stays there. One beyond bit 31 would be no pointer at all.
    pointers = np.minimum(8 * (words >> np.uint32(8)).astype(np.uint64) + 1, _LAST_BLOCK).astype(np.uint32)
    return np.where(is_leaf_of(words, "lod"), words, pointers)
