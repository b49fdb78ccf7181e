"""ASCII STL: read by lines where the file has the usual layout, else word by word."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import asset_name
from voxrt.voxelize.formats.obj.text import Text, as_text, real_rows
from voxrt.voxelize.formats.written_numbers import read_reals

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

# A solid's first line; its name may be empty and its end may lack the name.
_SOLID = re.compile(rb"^[ \t]*solid\b[ \t]*(?P<name>[^\r\n]*)", re.IGNORECASE | re.MULTILINE)
# Longer words are not numbers, and each would take the longest one's space in the array.
_VERTEX = re.compile(rb"vertex\s+(\S{1,64})\s+(\S{1,64})\s+(\S{1,64})(?!\S)", re.IGNORECASE)

_FACET = np.frombuffer(b"fovvvee", dtype=np.uint8)  # facet, outer loop, three vertices, endloop, endfacet
_LOWER = 0x20


def ascii_solids(path: Path, data: bytes) -> list[tuple[str, NDArray[np.float64]]]:
    """Return each solid's unique name and its corners (float64, shape (3 * T, 3)).

    Raise AssetError where a facet is not a triangle, or a coordinate is not a number.
    """
    found = _by_lines(as_text(path, data))
    solids = _by_words(path, data) if found is None else found
    used: set[str] = set()
    named = []
    for label, corners in solids:
        stem = label.decode("utf-8", errors="replace").strip() or asset_name(path)
        name, number = stem, 2
        while name in used:
            name, number = f"{stem} ({number})", number + 1
        used.add(name)
        named.append((name, corners))
    return named


def _by_lines(text: Text) -> list[tuple[bytes, NDArray[np.float64]]] | None:
    """Read a file with one statement per line; None where it has another layout or an error."""

    def at(place: int) -> NDArray[np.uint8]:
        return text.buffer[np.minimum(text.starts + place, text.ends)] | np.uint8(_LOWER)

    first, fourth = at(0), at(3)
    blank = text.starts == text.ends
    heads = np.flatnonzero((first == ord("s")) & ~blank)
    ends = (first == ord("e")) & (fourth == ord("s"))
    facets = first[~(blank | ends | (first == ord("s")))]
    if not len(heads) or len(facets) % 7 or not (facets.reshape(-1, 7) == _FACET).all():
        return None
    lines = np.flatnonzero((first == ord("v")) & ~blank)
    if any((at(place)[lines] != letter).any() for place, letter in enumerate(b"vertex ")):
        return None
    if any((at(place)[heads] != letter).any() for place, letter in enumerate(b"solid")):
        return None
    if len(lines) and lines[0] < heads[0]:
        return None
    values, counts = real_rows(text, lines, len("vertex"))
    if (counts != 3).any() or not np.isfinite(values).all():
        return None
    begins = np.searchsorted(lines, heads) * 3
    names = [text.data[text.starts[line] + 5 : text.ends[line]] for line in heads.tolist()]
    return list(zip(names, np.split(values.reshape(-1, 3), begins[1:] // 3), strict=True))


def _by_words(path: Path, data: bytes) -> list[tuple[bytes, NDArray[np.float64]]]:
    # The pattern matches the word at the beginning of a line only, so `endsolid` starts no solid.
    heads = list(_SOLID.finditer(data))
    solids = []
    for head, end in zip(heads, [*(head.start() for head in heads), len(data)][1:], strict=True):
        name, body = head["name"], data[head.end() : end]
        place = f"solid {name.decode('utf-8', errors='replace').strip()!r}"
        words = _VERTEX.findall(body)
        if len(words) % 3 or len(words) // 3 != len(re.findall(rb"\bend[ \t]*facet\b", body, re.IGNORECASE)):
            raise AssetError(path, "has a facet that is not a triangle", place=place, fix="export it again")
        corners = read_reals(path, [word for vertex in words for word in vertex], place).reshape(-1, 3)
        solids.append((name, corners))
    return solids
