"""Octree memories in the words of other hardware: written, read, and told apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.errors import RomError, place
from voxrt.octree.words import (
    DIALECTS,
    LOD_BLOCKS,
    SEED_MATERIALS,
    TAGS,
    Dialect,
    from_lod_words,
    is_leaf,
    is_leaf_of,
    leaf,
    lod_pointers,
    lod_words,
    material,
    with_tag,
    without_tag,
)
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_PIECE = 1 << 20  # words looked at at a time


def as_dialect(name: str) -> Dialect:
    """Return the name of a dialect; ValueError if there is none of that name."""
    if name not in DIALECTS:
        raise ValueError(f"no dialect is called {name!r}; choose one of {', '.join(DIALECTS)}")
    return name


def encode(words: NDArray[np.uint32], dialect: str, means: NDArray[np.uint8] | None = None) -> NDArray[np.uint32]:
    """Write report words in `dialect`.

    Parameters
    ----------
    words
        uint32, shape (N,), report dialect: :attr:`Octree.words`.
    dialect
        One of :data:`DIALECTS`.
    means
        For ``lod``: the mean material of each block, :attr:`Octree.means`.

    Returns
    -------
    NDArray[np.uint32]
        uint32, shape (N,); pointers unchanged, but for ``lod``.

    Raises
    ------
    DoesNotFitError
        The dialect cannot name a material in use, or so many blocks.
    ValueError
        There is no such dialect, or ``lod`` without means.

    Examples
    --------
    >>> import numpy as np
    >>> [hex(word) for word in encode(np.array([1, 0xFFFFFF02], np.uint32), "msb")]
    ['0x1', '0x80000002']
    """
    target = as_dialect(dialect)
    if target == "report":
        return words
    if target == "lod":
        if means is None:
            raise ValueError("the memory has no mean materials: give it some with with_means")
        if len(means) > LOD_BLOCKS:
            raise DoesNotFitError(
                f"dialect lod holds {LOD_BLOCKS:,} blocks and the memory has {len(means):,}; build with less depth"
            )
        return lod_words(words, means) if len(means) else words
    leaves = is_leaf(words)
    if target == "seed-rtl":
        highest = int(material(words)[leaves].max(initial=0))
        if highest > SEED_MATERIALS:
            raise DoesNotFitError(
                f"dialect seed-rtl holds materials 1 ... {SEED_MATERIALS} and the memory uses material {highest}; "
                "write dialect report, or build with fewer materials"
            )
    return np.where(leaves, with_tag(words, target), words)


def leaf_materials(
    words: NDArray[np.uint32], dialect: str, *, source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> NDArray[np.uint32]:
    """Read the words of `dialect` (uint32, shape (N,)) as report words, pointers unchecked.

    RomError, which names a line of `source`, where a word is neither a pointer nor a leaf of that dialect.
    """
    origin = as_dialect(dialect)
    if origin == "lod":
        return from_lod_words(words)
    leaves = is_leaf(words)
    known = ~leaves | is_leaf_of(words, origin)
    if not known.all():
        address = int(np.argmin(known))
        raise RomError(
            f"{place(address, source, lines)}: {int(words[address]):08X} is neither a pointer nor a leaf of dialect "
            f"{dialect}; name the dialect that the memory was written in ({', '.join(DIALECTS)})"
        )
    return np.where(leaves, without_tag(words, origin), words)


def block_means(
    words: NDArray[np.uint32], *, source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> NDArray[np.uint8]:
    """Read the mean material of each block of a memory of dialect ``lod``, all of whose pointers lead into it.

    Return uint8, shape (blocks,), read-only; 0 for a block that nothing points to. RomError, which names a line of
    `source`, where two pointers to one block have different means.
    """
    pointers = np.flatnonzero(~is_leaf_of(words, "lod"))
    blocks, materials = lod_pointers(words[pointers])
    means = np.zeros((len(words) - 1) // 8, np.uint8)
    means[blocks] = materials
    if len(wrong := np.flatnonzero(means[blocks] != materials)):
        address = int(pointers[wrong[0]])
        raise RomError(
            f"{place(address, source, lines)}: {int(words[address]):08X} gives block {blocks[wrong[0]]} "
            "another mean material than a later word does; build it again"
        )
    means.flags.writeable = False
    return means


def detect_dialect(
    words: NDArray[np.uint32], *, source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> Dialect:
    """Find the dialect of a memory from its leaves.

    ``msb`` leaves look like no others. A memory is ``seed-rtl`` if all leaves lie in FFFFFF00 … 07 and FFFFFFF0 … F7
    and some leaf is FFFFFFF0, the empty space of that dialect: as ``report`` it would use material 240 and none of
    8 … 239. FFFFFFF1 … F7 without FFFFFFF0 is refused. Every other memory of FFFFFFmm is ``report``. The leaves of
    ``lod`` are those of ``report``: only a manifest tells it.

    Parameters
    ----------
    words
        uint32, shape (N,).
    source, lines
        The file that the words come from and the line of each, for the error.

    Raises
    ------
    RomError
        The leaves fit no dialect, or several with different meanings.

    Examples
    --------
    >>> import numpy as np
    >>> detect_dialect(np.array([1, *[0x80000000] * 7, 0x80000002], np.uint32))
    'msb'
    """
    try:
        return _dialect_of(_different_leaves(words))
    except RomError:
        return _dialect_of(words, source, lines)  # again, for the address


def _different_leaves(words: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Return the leaves of a memory, each once, without arrays of its size."""
    found = [np.zeros(0, np.uint32)]
    for first in range(0, len(words), _PIECE):
        piece = words[first : first + _PIECE]
        leaves = piece[is_leaf(piece)]
        tagged = is_leaf_of(leaves, "report")
        found.append(leaf(np.flatnonzero(np.bincount(material(leaves[tagged]))).astype(np.uint32)))
        found.append(np.unique(leaves[~tagged]))
    return np.unique(np.concatenate(found))


def _dialect_of(
    words: NDArray[np.uint32], source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> Dialect:
    leaves = is_leaf(words)
    if leaves.any() and is_leaf_of(words[leaves], "msb").all():
        return "msb"
    report = is_leaf_of(words, "report")
    if not report[leaves].all():
        address = int(np.argmax(leaves & ~report))
        raise RomError(
            f"{place(address, source, lines)}: {int(words[address]):08X} and the other leaves of the memory fit no "
            f"dialect ({', '.join(DIALECTS)}); check that the file is an octree memory"
        )
    high = leaves & (material(words) >= material(TAGS["seed-rtl"])) & is_leaf_of(words, "seed-rtl")
    if not is_leaf_of(words[leaves], "seed-rtl").all() or not high.any():
        return "report"
    if (words[high] == TAGS["seed-rtl"]).any():
        return "seed-rtl"
    address = int(np.argmax(high))
    word = int(words[address])
    raise RomError(
        f"{place(address, source, lines)}: {word:08X} is material {material(word)} in dialect report and "
        f"{word & SEED_MATERIALS} in dialect seed-rtl, and nothing else in the memory tells which; name the dialect"
    )
