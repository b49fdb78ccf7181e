"""Files that hold memory words and nothing else, whatever their syntax.

What reads and writes a format is imported when a file has its suffix.
"""

from __future__ import annotations

import os
from importlib import import_module
from stat import S_ISDIR, S_ISREG
from typing import TYPE_CHECKING

from voxrt.octree import RomError, _native
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from mmap import mmap
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

WORD_SUFFIXES = (".mem", ".coe", ".mif", ".bin")
"""The files of words that are read and written."""

_NAMES = {".mem": "mem", ".coe": "coe", ".mif": "mif", ".bin": "raw"}

_PIECE = 1 << 20
"""Words that are formatted at a time."""

_MAPPED = 1 << 24
"""Bytes from which a file is mapped: copies of smaller ones cost nothing, and cannot change."""


class WordFile(Value, frozen=True, eq=False):
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
    return WordFile(words, lines, mem_crc32(words))


def mem_crc32(words: NDArray[np.uint32]) -> int:
    """Return the CRC-32 of the ``.mem`` file that would hold `words` (uint32, shape (N,))."""
    return _native.mem_text_crc32(words)


def mem_pieces(words: NDArray[np.uint32]) -> Iterator[bytes]:
    """Format words (uint32, shape (N,)) as the bytes of a ``.mem`` file, piece by piece."""
    for first in range(0, len(words), _PIECE):
        yield _native.mem_text(words[first : first + _PIECE])


def read_bytes(path: Path) -> bytes:
    """Read a whole file; RomError where that fails. Pipes and devices may never end, and are refused."""
    try:
        status = path.stat()
        if not (S_ISREG(status.st_mode) or S_ISDIR(status.st_mode)):
            raise RomError(f"{path}: is a pipe or a device; save it to a file, and name that")
        return path.read_bytes()
    except OSError as error:
        raise RomError(f"{path}: cannot be read: {error.strerror}; name an octree memory") from None


def mapped_bytes(path: Path) -> bytes | mmap:
    """Map a large file, or read another one whole; RomError where that fails.

    A mapped file may be replaced, as voxrt replaces files, but nobody may write into it or cut it while it is in use.
    """
    try:
        if path.is_file():
            with path.open("rb") as file:
                if os.fstat(file.fileno()).st_size >= _MAPPED:
                    from mmap import ACCESS_READ, mmap  # noqa: PLC0415 - for large files alone

                    return mmap(file.fileno(), 0, access=ACCESS_READ)
    except OSError:
        pass  # reading says why
    return read_bytes(path)


def read_word_file(path: Path) -> WordFile:
    """Read a file of words, by its suffix; RomError where it cannot be read or is damaged."""
    name = _NAMES[path.suffix.lower()]
    found: WordFile = getattr(import_module(f"voxrt.export.{name}"), f"read_{name}")(path)
    return found


def format_words(words: NDArray[np.uint32], suffix: str) -> bytes | Iterable[bytes]:
    """Return words (uint32, shape (N,)) as the bytes of a file of that suffix, whole or in pieces."""
    if suffix == ".mem":
        return mem_pieces(words)
    name = _NAMES[suffix]
    made: bytes | Iterable[bytes] = getattr(import_module(f"voxrt.export.{name}"), f"{name}_bytes")(words)
    return made
