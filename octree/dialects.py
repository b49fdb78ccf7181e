"""The words that mark a leaf, as three generations of hardware read them.

============ ==================== ====================================================
dialect      leaf of material m   read by
============ ==================== ====================================================
``report``   ``0xFFFFFF00 | m``   this project's hardware; the report of the original
``seed-rtl`` ``0xFFFFFFF0 | m``   the original's published bitstreams: the low 3 bits
                                  count, so FFFFFF00 … FFFFFF07 are read as well
``msb``      ``0x80000000 | m``   the C++ program of the original's report
``lod``      ``0xFFFFFF00 | m``   configurations of this project's hardware with level of detail
============ ==================== ====================================================

Pointers are the same in the first three: bit 31 clear, the word address of octant 0 of a block. In ``lod`` a pointer is
256 times the number of the block, plus its mean material; block k is at address 1 + 8 k.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np

from voxrt.octree.errors import RomError, place
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Dialect: TypeAlias = Literal["report", "seed-rtl", "msb", "lod"]
DIALECTS: tuple[Dialect, ...] = get_args(Dialect)

_LEAF = np.uint32(0x80000000)
_PIECE = 1 << 20  # words looked at at a time
_TAGS: dict[Dialect, np.uint32] = {
    "report": np.uint32(0xFFFFFF00),
    "seed-rtl": np.uint32(0xFFFFFFF0),
    "msb": np.uint32(0x80000000),
    "lod": np.uint32(0xFFFFFF00),
}
_LOD_BLOCKS = (1 << 24) - 1


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
    tag = _TAGS[as_dialect(dialect)]
    if dialect == "report":
        return words
    leaves = (words & _LEAF) != 0
    if dialect == "lod":
        if means is None:
            raise ValueError("the memory has no mean materials: give it some with with_means")
        if len(means) > _LOD_BLOCKS:
            raise DoesNotFitError(
                f"dialect lod holds {_LOD_BLOCKS:,} blocks and the memory has {len(means):,}; build with less depth"
            )
        if len(means) == 0:
            return words
        blocks = np.where(leaves, 0, words) >> np.uint32(3)
        return np.where(leaves, words, blocks << np.uint32(8) | means[blocks])
    materials = words & np.uint32(0xFF)
    if dialect == "seed-rtl":
        highest = int(materials[leaves].max(initial=0))
        if highest > 7:
            raise DoesNotFitError(
                f"dialect seed-rtl holds materials 1 ... 7 and the memory uses material {highest}; "
                "write dialect report, or build with fewer materials"
            )
    return np.where(leaves, tag | materials, words)


def leaf_materials(
    words: NDArray[np.uint32], dialect: str, *, source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> NDArray[np.uint32]:
    """Read the words of `dialect` as report words, pointers unchecked.

    Parameters
    ----------
    words
        uint32, shape (N,).
    dialect
        One of :data:`DIALECTS`.
    source, lines
        The file that the words come from and the line of each, for the error.

    Returns
    -------
    NDArray[np.uint32]
        uint32, shape (N,), report dialect.

    Raises
    ------
    RomError
        A word is neither a pointer nor a leaf of that dialect.
    """
    if dialect == "lod":
        leaves = _lod_leaves(words)
        pointers = 8 * (words >> np.uint32(8)).astype(np.uint64) + 1
        # What leads beyond the memory stays so; what is beyond bit 31 would be no pointer at all.
        return np.where(leaves, words, np.minimum(pointers, 0x7FFFFFF9).astype(np.uint32))
    leaves = (words & _LEAF) != 0
    known = ~leaves | _leaf_words(words)[as_dialect(dialect)]
    if not known.all():
        address = int(np.argmin(known))
        raise RomError(
            f"{place(address, source, lines)}: {int(words[address]):08X} is neither a pointer nor a leaf of dialect "
            f"{dialect}; name the dialect that the memory was written in ({', '.join(DIALECTS)})"
        )
    materials = words & np.uint32(0x07 if dialect == "seed-rtl" else 0xFF)
    return np.where(leaves, _TAGS["report"] | materials, words)


def block_means(
    words: NDArray[np.uint32], *, source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> NDArray[np.uint8]:
    """Read the mean material of each block of a memory of dialect ``lod``.

    Parameters
    ----------
    words
        uint32, shape (1 + 8 * blocks,); every pointer leads into the memory.
    source, lines
        The file that the words come from and the line of each, for the error.

    Returns
    -------
    NDArray[np.uint8]
        uint8, shape (blocks,), read-only; 0 for a block that nothing points to.

    Raises
    ------
    RomError
        Two pointers to one block have different means.
    """
    pointers = np.flatnonzero(~_lod_leaves(words))
    blocks, materials = words[pointers] >> np.uint32(8), (words[pointers] & np.uint32(0xFF)).astype(np.uint8)
    means = np.zeros((len(words) - 1) // 8, np.uint8)
    means[blocks] = materials
    if len(wrong := np.flatnonzero(means[blocks] != materials)):
        address = int(pointers[wrong[0]])
        raise RomError(
            f"{place(address, source, lines)}: {int(words[address]):08X} gives block {int(words[address]) >> 8} "
            "another mean material than a later word does; build it again"
        )
    means.flags.writeable = False
    return means


def _lod_leaves(words: NDArray[np.uint32]) -> NDArray[np.bool_]:
    leaves: NDArray[np.bool_] = (words >> np.uint32(8)) == np.uint32(0xFFFFFF)
    return leaves


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
        leaves = piece[(piece & _LEAF) != 0]
        tagged = leaves >= _TAGS["report"]
        found.append(_TAGS["report"] | np.flatnonzero(np.bincount(leaves[tagged] & np.uint32(0xFF))).astype(np.uint32))
        found.append(np.unique(leaves[~tagged]))
    return np.unique(np.concatenate(found))


def _dialect_of(
    words: NDArray[np.uint32], source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> Dialect:
    leaves = (words & _LEAF) != 0
    masks = _leaf_words(words)
    if masks["msb"][leaves].all() and leaves.any():
        return "msb"
    if not masks["report"][leaves].all():
        address = int(np.argmax(leaves & ~masks["report"]))
        raise RomError(
            f"{place(address, source, lines)}: {int(words[address]):08X} and the other leaves of the memory fit no "
            f"dialect ({', '.join(DIALECTS)}); check that the file is an octree memory"
        )
    high = leaves & ((words & np.uint32(0xF8)) == np.uint32(0xF0))
    if not masks["seed-rtl"][leaves].all() or not high.any():
        return "report"
    if (words[high] == _TAGS["seed-rtl"]).any():
        return "seed-rtl"
    address = int(np.argmax(high))
    word = int(words[address])
    raise RomError(
        f"{place(address, source, lines)}: {word:08X} is material {word & 0xFF} in dialect report and {word & 7} in "
        "dialect seed-rtl, and nothing else in the memory tells which; name the dialect"
    )


def _leaf_words(words: NDArray[np.uint32]) -> dict[Dialect, NDArray[np.bool_]]:
    report = (words & np.uint32(0xFFFFFF00)) == np.uint32(0xFFFFFF00)
    seed = report & ((words & np.uint32(0x08)) == 0) & np.isin(words & np.uint32(0xF0), (0x00, 0xF0))
    return {
        "report": report,
        "seed-rtl": seed,
        "lod": report,
        "msb": (words & np.uint32(0xFFFFFF00)) == np.uint32(0x80000000),
    }
