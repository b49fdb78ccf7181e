"""``.bin`` files: memory words of 32 bits, least significant byte first, one after another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.export.word_file import WordFile, mapped_bytes, word_file
from voxrt.octree import RomError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray


_PIECE = 1 << 20
"""Words that are converted at a time."""


def raw_bytes(words: NDArray[np.uint32]) -> Iterator[bytes]:
    """Return words (uint32, shape (N,)) as the bytes of a ``.bin`` file, piece by piece."""
    for first in range(0, len(words), _PIECE):
        yield words[first : first + _PIECE].astype("<u4").tobytes()


def write_raw(path: Path, words: NDArray[np.uint32]) -> None:
    """Write words as a ``.bin`` file; parameters and errors are those of :func:`write_mem`.

    Examples
    --------
    >>> from pathlib import Path
    >>> write_raw(Path("dot.bin"), np.array([1, *[0xFFFFFF07] * 8], np.uint32))
    """
    write_atomically(path, raw_bytes(words))


def read_raw(path: Path) -> WordFile:
    """Read a ``.bin`` file. A large one is mapped: its words take memory as they are read, and can be let go again.

    A mapped file may be replaced, as voxrt replaces files, but nobody may write into it or cut it while it is in use.

    Raises
    ------
    RomError
        The file cannot be read or its length is no multiple of 4 bytes.

    Examples
    --------
    >>> from pathlib import Path
    >>> write_raw(Path("dot.bin"), np.array([1, *[0xFFFFFF07] * 8], np.uint32))
    >>> len(read_raw(Path("dot.bin")).words)
    9
    """
    data = mapped_bytes(path)
    if len(data) % 4:
        raise RomError(f"{path}: {len(data)} bytes are not words of 4; the file is cut short, or no octree memory")
    return word_file(np.frombuffer(data, dtype="<u4").astype(np.uint32, copy=False), None)
