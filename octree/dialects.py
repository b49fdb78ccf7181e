"""The words that mark a leaf, as three generations of hardware read them.

============ ==================== ====================================================
dialect      leaf of material m   read by
============ ==================== ====================================================
``report``   ``0xFFFFFF00 | m``   this project's hardware; the report of the original
``seed-rtl`` ``0xFFFFFFF0 | m``   the original's published bitstreams: the low 3 bits
                                  count, so FFFFFF00 … FFFFFF07 are read as well
``msb``      ``0x80000000 | m``   the C++ program of the original's report
============ ==================== ====================================================

Pointers are the same in all: bit 31 clear, the word address of octant 0 of a block.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np

from voxrt.octree.errors import RomError, place
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Dialect: TypeAlias = Literal["report", "seed-rtl", "msb"]
DIALECTS: tuple[Dialect, ...] = get_args(Dialect)

_LEAF = np.uint32(0x80000000)
_TAGS: dict[Dialect, np.uint32] = {
    "report": np.uint32(0xFFFFFF00),
    "seed-rtl": np.uint32(0xFFFFFFF0),
    "msb": np.uint32(0x80000000),
}


def as_dialect(name: str) -> Dialect:
    """Return the name of a dialect; ValueError if there is none of that name."""
    if name not in DIALECTS:
        raise ValueError(f"no dialect is called {name!r}; choose one of {', '.join(DIALECTS)}")
    return name


def encode(words: NDArray[np.uint32], dialect: str) -> NDArray[np.uint32]:
    """Write report words in `dialect`.

    Parameters
    ----------
    words
        uint32, shape (N,), report dialect: :attr:`Octree.words`.
    dialect
        One of :data:`DIALECTS`.

    Returns
    -------
    NDArray[np.uint32]
        uint32, shape (N,); pointers unchanged.

    Raises
    ------
    DoesNotFitError
        The dialect cannot name a material in use.
    ValueError
        There is no such dialect.

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
    """Read the words of `dialect` as report words, pointers unchanged and unchecked.

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


def detect_dialect(
    words: NDArray[np.uint32], *, source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None
) -> Dialect:
    """Find the dialect of a memory from its leaves.

    ``msb`` leaves look like no others. A memory is ``seed-rtl`` if all leaves lie in FFFFFF00 … 07 and FFFFFFF0 … F7
    and some leaf is FFFFFFF0, the empty space of that dialect: as ``report`` it would use material 240 and none of
    8 … 239. FFFFFFF1 … F7 without FFFFFFF0 is refused. Every other memory of FFFFFFmm is ``report``.

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
    return {"report": report, "seed-rtl": seed, "msb": (words & np.uint32(0xFFFFFF00)) == np.uint32(0x80000000)}
