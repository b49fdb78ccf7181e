"""Files that hold memory words and nothing else, whatever their syntax."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import RomError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_DIGITS = np.frombuffer(b"0123456789ABCDEF", dtype=np.uint8)


@dataclass(frozen=True, eq=False, slots=True)
class WordFile:
    """What a file of words holds.

    Attributes
    ----------
    words
        uint32, shape (N,), as they stand in the file, whatever they mean.
    lines
        int64, shape (N,): the line of each word, counted from 1; None in binary files.
    crc32
        What a manifest knows them by: the CRC-32 (ISO 3309, as zlib computes it) of a ``.mem`` file's bytes, of other
        files that of the ``.mem`` file with the same words.
    """

    words: NDArray[np.uint32]
    lines: NDArray[np.int64] | None
    crc32: int


def word_file(words: NDArray[np.uint32], lines: NDArray[np.int64] | None) -> WordFile:
    """Make the value for words from a file that is no ``.mem``."""
    return WordFile(words, lines, zlib.crc32(mem_bytes(words)))


def mem_bytes(words: NDArray[np.uint32]) -> bytes:
    """Format words (uint32, shape (N,)) as the bytes of a ``.mem`` file."""
    text = np.empty((len(words), 9), dtype=np.uint8)
    for digit in range(8):
        text[:, digit] = _DIGITS[(words >> np.uint32(28 - 4 * digit)) & np.uint32(15)]
    text[:, 8] = ord("\n")
    return text.tobytes()


def read_bytes(path: Path) -> bytes:
    """Read a whole file; RomError where that fails."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise RomError(f"{path}: cannot be read: {error.strerror}; name an octree memory") from None
