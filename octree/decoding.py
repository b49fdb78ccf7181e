"""The validating reader: words of any dialect to an octree, or one line that names the wrong word.

Time and memory grow with the number of words, whatever the words say.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.dialects import block_means, leaf_materials
from voxrt.octree.errors import RomError, place
from voxrt.octree.octree import MAX_DEPTH, Octree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_PROBLEMS = {
    "misaligned": "pointer {word:08X} does not stand at the start of a block (1 + 8k)",
    "range": "pointer {word:08X} leads behind the last of {count} words",
    "cycle": "pointer {word:08X} leads back to a block that it lies in",
    "too-deep": "pointer {word:08X} lies below depth {depth}; the memory has {least} levels",
}
_FIXES = {
    "misaligned": "the file is damaged, or was written for another layout",
    "range": "the file is cut short or damaged",
    "cycle": "the file is damaged",
    "too-deep": "name a depth of {least} or more",
}


def decode(
    words: NDArray[np.uint32],
    dialect: str,
    depth: int | None,
    *,
    source: str = "",
    lines: Sequence[int] | NDArray[np.int64] | None = None,
) -> Octree:
    """Read memory words, checking every one.

    A memory that is valid without being canonical (blocks repeated, in another order, or reached from nowhere) keeps
    its words where they are; they change to the report dialect. Dialect ``lod`` gives mean materials, too.

    Parameters
    ----------
    words
        uint32, shape (N,).
    dialect
        One of :data:`voxrt.octree.DIALECTS`; :func:`detect_dialect` finds it from the words.
    depth
        Levels of the world, 1 … 16; None takes the least that the memory needs.
    source, lines
        The file that the words come from and the line of each, for errors.

    Returns
    -------
    Octree
        With words of its own, read-only. Words of dialect ``report`` that are read-only, such as those of a mapped
        file, are not copied.

    Raises
    ------
    RomError
        A pointer is out of range, misaligned, part of a cycle or below `depth`, or a word is none of the dialect, or
        pointers to one block have different mean materials. The
        message names the address of the word.
    ValueError
        The words are no such array, or there is no such dialect.

    Examples
    --------
    >>> import numpy as np
    >>> decode(np.array([1, *[0xFFFFFF00] * 7, 0xFFFFFF02], np.uint32), "report", None)
    <Octree: depth 1, 9 words>
    >>> decode(np.array([1, 0xFFFFFF00], np.uint32), "report", None)
    Traceback (most recent call last):
        ...
    voxrt.octree.errors.RomError: memory: 2 words are not a root and blocks of 8 (1 + 8k); the file is cut short, or ...
    """
    if words.ndim != 1 or words.dtype != np.uint32:
        raise ValueError(f"words must be uint32 of shape (N,), not {words.dtype} of shape {words.shape}")
    if depth is not None and not 1 <= depth <= MAX_DEPTH:
        raise RomError(
            f"{source or 'memory'}: depth {depth} is outside 1 ... {MAX_DEPTH}; name the depth it was built with"
        )
    if len(words) == 0:
        raise RomError(f"{source or 'memory'}: there is no word in it; an octree memory has at least its root")
    limit = MAX_DEPTH if depth is None else depth
    verdict = _native.validate(words, limit) if dialect == "report" else None
    if verdict is None or verdict.fault:
        report = leaf_materials(words, dialect, source=source, lines=lines)
        verdict = _native.validate(report, limit)
    else:  # the words are read once, and large memories stay where they are
        report = words if not words.flags.writeable else words.copy()
    if verdict.fault == "length":
        raise RomError(
            f"{source or 'memory'}: {len(words)} words are not a root and blocks of 8 (1 + 8k); the file is cut short, "
            "or holds more than an octree memory"
        )
    if verdict.fault:
        facts = {"word": int(words[verdict.address]), "count": len(words), "depth": limit, "least": verdict.least_depth}
        problem, fix = _PROBLEMS[verdict.fault].format(**facts), _FIXES[verdict.fault].format(**facts)
        raise RomError(f"{place(verdict.address, source, lines)}: {problem}; {fix}")
    report.flags.writeable = False
    means = block_means(words, source=source, lines=lines) if dialect == "lod" else None
    return Octree(max(1, verdict.least_depth) if depth is None else depth, report, means)
