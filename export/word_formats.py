"""The formats of files of words, by suffix. What reads and writes one is imported when a file has it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from voxrt.export.word_file import mem_pieces

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.export.word_file import WordFile

WORD_SUFFIXES = (".mem", ".coe", ".mif", ".bin")
"""The files of words that are read and written."""

_NAMES = {".mem": "mem", ".coe": "coe", ".mif": "mif", ".bin": "raw"}


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
