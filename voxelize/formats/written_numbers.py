"""Numbers that a text file has as words, and the error for a word that is none."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

LONGEST_NUMBER = 64
"""A longer word is no number: in an array of words each would take its space."""

_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
_MOST_SHOWN = 24


def read_reals(path: Path, words: Sequence[bytes], place: str) -> NDArray[np.float64]:
    """Return words as float64; AssetError for the first that is not a number."""
    if not words:
        return np.zeros(0)
    if max(map(len, words)) <= LONGEST_NUMBER:
        try:
            return np.array(words, dtype=np.bytes_).astype(np.float64)
        except ValueError:
            pass
    raise not_a_number(path, next((word for word in words if not is_number(word)), words[0]), place)


def is_number(word: bytes) -> bool:
    """Tell whether a word is a real number as files write it: Python alone allows underscores in numbers."""
    try:
        float(word)
    except ValueError:
        return False
    return b"_" not in word and len(word) <= LONGEST_NUMBER


def not_a_number(path: Path, word: bytes, place: str) -> AssetError:
    """Return the error for a word that is not a number."""
    text = word.decode("utf-8", "replace")
    shown = repr(text if len(text) <= _MOST_SHOWN else text[:_MOST_SHOWN] + "…")
    if _DECIMAL_COMMA.fullmatch(text):
        fix = f"numbers have a decimal point, not a comma: write {text.replace(',', '.')}"
    else:
        fix = "repair it, or export the file again"
    return AssetError(path, f"{shown} is not a number", place=place, fix=fix)
