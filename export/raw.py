"""``.bin`` files: memory words of 32 bits, least significant byte first, one after another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.export.word_file import WordFile, read_bytes, word_file
from voxrt.octree import RomError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


def raw_bytes(words: NDArray[np.uint32]) -> bytes:
    """Format words (uint32, shape (N,)) as the bytes of a ``.bin`` file."""
    return words.astype("<u4").tobytes()


def write_raw(path: Path, words: NDArray[np.uint32]) -> None:
    """Write words (uint32, shape (N,), already in the dialect of their reader) to `path`, atomically."""
    write_atomically(path, raw_bytes(words))


def read_raw(path: Path) -> WordFile:
    """Read a ``.bin`` file.

    Raises
    ------
    RomError
        Where the file cannot be read or its length is no multiple of 4 bytes.
    """
    data = read_bytes(path)
    if len(data) % 4:
        raise RomError(f"{path}: {len(data)} bytes are not words of 4; the file is cut short, or no octree memory")
    return word_file(np.frombuffer(data, dtype="<u4").astype(np.uint32), None)
