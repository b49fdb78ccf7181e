"""The lines of an OBJ or MTL file, and their numbers, as arrays."""

from __future__ import annotations

import math
import re
import warnings
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from msgspec import Struct

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import read_asset
from voxrt.voxelize.formats.text_encoding import ascii_compatible

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_Number = TypeVar("_Number", np.float64, np.int64)

# Longer numbers exceed 64 bits.
_INDEX = re.compile(rb"[+-]?\d{1,18}")

_MOST_MARKS = 3  # in a name that a comment may follow


class Text(Struct, frozen=True, eq=False):
    """A file's text with line feeds as line ends; continued lines are joined in place."""

    path: Path
    # Its bytes, ASCII compatible, ending in a line feed. Joining keeps the length; `newlines` keeps the line
    # numbers.
    data: bytes
    buffer: NDArray[np.uint8]  # uint8, shape (len(data),): the same bytes
    # int64, shape (L,): the position of each line's first character that is not blank, else of its line feed.
    starts: NDArray[np.int64]
    ends: NDArray[np.int64]  # int64, shape (L,): the position of each line's line feed
    newlines: NDArray[np.int64]  # int64: positions of all line feeds of the file, joined ones included

    def place(self, line: int) -> str:
        """Return the line number of line `line` (an index into `starts`), for people: ``line 12``."""
        return f"line {int(np.searchsorted(self.newlines, self.starts[line])) + 1}"

    def is_statement(self, keyword: str) -> NDArray[np.bool_]:
        """Tell which lines begin with a keyword of two characters; a blank stands for the end of a word."""
        # A line ends with a line feed, so it has a second character, except the last line.
        first, second = self.buffer[self.starts], self.buffer[np.minimum(self.starts + 1, len(self.buffer) - 1)]
        ends = second <= ord(" ") if keyword[1] == " " else second == ord(keyword[1])
        found: NDArray[np.bool_] = (first == ord(keyword[0])) & ends
        return found

    def value_words(self, line: int) -> list[bytes]:
        """Return the words of line `line` after its keyword, without a comment."""
        return self.data[self.starts[line] : self.ends[line]].partition(b"#")[0].split()[1:]

    def statement(self, line: int) -> tuple[str, str]:
        """Return the keyword of line `line`, in lower case, and its value; two empty strings for a comment.

        A name may contain ``#``: it begins a comment at the beginning of a line or of a value alone, as in the readers
        of Assimp, Blender and tinyobjloader.
        """
        keyword, _, value = decode(self.data[self.starts[line] : self.ends[line]]).replace("\t", " ").partition(" ")
        value = value.strip()
        if keyword.startswith("#"):
            return "", ""
        return keyword.strip().lower(), "" if value.startswith("#") else value


def spellings(value: str) -> list[str]:
    """Return a name, then what it is if a comment follows it, which white space and ``#`` begin: the longest first.

    >>> spellings("Plastic #1 # of the roof")
    ['Plastic #1 # of the roof', 'Plastic #1', 'Plastic']
    """
    ends = [match.start() for match in re.finditer(r"\s+#", value)]
    few = [*ends[:1], *ends[1:][-_MOST_MARKS:]]
    return [value, *(value[:end] for end in reversed(few))]


def decode(raw: bytes) -> str:
    """Return the text of a name: UTF-8, else Windows-1252, which old exporters wrote."""
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


def read_text(path: Path) -> Text:
    """Read a text file of any usual encoding; raise AssetError where its bytes contradict its byte order mark."""
    data = read_asset(path)
    return as_text(path, ascii_compatible(path, data))


def as_text(path: Path, data: bytes) -> Text:
    """Return the lines of ASCII compatible bytes."""
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if not data.endswith(b"\n"):
        data += b"\n"
    newlines = np.flatnonzero(np.frombuffer(data, dtype=np.uint8) == ord("\n"))
    ends = newlines
    if b"\\\n" in data:
        data = data.replace(b"\\\n", b"  ")
        ends = np.flatnonzero(np.frombuffer(data, dtype=np.uint8) == ord("\n"))
        if not len(ends):
            data += b"\n"
            ends = np.array([len(data) - 1])
    buffer = np.frombuffer(data, dtype=np.uint8)
    starts = np.empty_like(ends)
    starts[0] = 0
    starts[1:] = ends[:-1] + 1
    indented = np.flatnonzero((buffer[starts] <= ord(" ")) & (starts != ends))
    if len(indented):
        solid = np.append(np.flatnonzero(buffer > ord(" ")), len(buffer))
        starts[indented] = np.minimum(solid[np.searchsorted(solid, starts[indented])], ends[indented])
    return Text(path, data, buffer, starts, ends, newlines)


def real_rows(text: Text, lines: NDArray[np.int64], keyword: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Read the reals of many lines at once: `lines` are ascending indices, each begins with `keyword` characters.

    Return the values, float64, flat, NaN for what is no number, and the numbers per line, int64, shape (len(lines),).
    """
    if not len(lines):
        return np.zeros(0), np.zeros(0, dtype=np.int64)
    characters, counts = _gathered(text, lines, keyword)
    values = _parsed(characters, int(counts.sum()), np.float64)
    if values is None:
        words = (word for row in characters.tobytes().split(b"\n") for word in row.split())
        values = np.array([_real(word) for word in words])
    return values, counts


def index_rows(
    text: Text, lines: NDArray[np.int64], keyword: int, field: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Read one field of the corners of many faces at once: ``12/7/3`` is 12 in field 0, 7 in field 1 and 3 in field 2.

    A corner without field 1 or 2 gives 0, which is no index in OBJ files. Return as :func:`real_rows` does, but int64.
    Raise AssetError for an index that is no integer, or a corner without field 0.
    """
    if not len(lines):
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    characters, counts = _gathered(text, lines, keyword)
    rows = characters.tobytes()
    slashes = np.flatnonzero(characters == ord("/"))
    if len(slashes):
        _keep_field(characters, slashes, field)
    elif field:
        return np.zeros(int(counts.sum()), dtype=np.int64), counts
    values = _parsed(characters, int(counts.sum()), np.int64)
    if values is None:
        values = np.array(_slow_indices(text, lines, rows, field), dtype=np.int64)
    return values, counts


def _keep_field(characters: NDArray[np.uint8], slashes: NDArray[np.int64], field: int) -> None:
    """Blank all of each word but one of its fields, which slashes separate."""
    solid = characters > ord(" ")
    begins = np.flatnonzero(solid[1:] & ~solid[:-1]) + 1
    ends = np.flatnonzero(~solid[1:] & solid[:-1]) + 1
    before = np.searchsorted(slashes, begins)
    padded = np.append(slashes, [len(characters), len(characters)])
    stops = np.minimum(padded[np.minimum(before + field, len(padded) - 1)], ends)
    # +1 where a stretch to blank begins and -1 where it ends; their running sum says what lies within.
    steps = np.zeros(len(characters) + 1, dtype=np.int8)
    np.add.at(steps, stops, np.int8(1))
    if field:
        starts = np.minimum(padded[np.minimum(before + field - 1, len(padded) - 1)] + 1, ends)
        np.add.at(steps, begins, np.int8(1))
        np.subtract.at(steps, starts, np.int8(1))
    np.subtract.at(steps, ends, np.int8(1))
    characters[np.cumsum(steps[:-1], dtype=np.int8) > 0] = ord(" ")


def _gathered(text: Text, lines: NDArray[np.int64], keyword: int) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return the lines joined, with keywords and comments blanked, and the number of words in each."""
    # Consecutive lines are copied as one piece.
    breaks = np.flatnonzero(np.diff(lines) != 1) + 1
    first = lines[np.concatenate([[0], breaks])]
    last = lines[np.concatenate([breaks - 1, [len(lines) - 1]])]
    data = text.data
    pieces = [data[a : b + 1] for a, b in zip(text.starts[first].tolist(), text.ends[last].tolist(), strict=True)]
    characters = np.frombuffer(bytearray(b"".join(pieces)), dtype=np.uint8)
    line_ends = np.flatnonzero(characters == ord("\n"))
    np.maximum(characters, ord(" "), out=characters)  # control characters become blanks
    characters[line_ends] = ord("\n")
    line_starts = np.empty_like(line_ends)
    line_starts[0] = 0
    line_starts[1:] = line_ends[:-1] + 1
    if len(breaks) + 1 != len(lines):  # inside a piece, lines keep their indentation
        piece_starts = np.cumsum([0] + [len(piece) for piece in pieces[:-1]])
        line_starts += text.starts[lines] - _line_begins(text, lines)
        line_starts[np.searchsorted(lines, first)] = piece_starts
    for offset in range(keyword):
        characters[line_starts + offset] = ord(" ")
    _blank_comments(characters)
    solid = characters > ord(" ")
    begins = np.flatnonzero(solid[1:] & ~solid[:-1]) + 1
    return characters, np.diff(np.searchsorted(begins, line_ends), prepend=0)


def _line_begins(text: Text, lines: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return where lines begin, with their indentation."""
    begins = np.zeros(len(lines), dtype=np.int64)
    begins[lines > 0] = text.ends[lines[lines > 0] - 1] + 1
    return begins


def _blank_comments(characters: NDArray[np.uint8]) -> None:
    marks = characters == ord("#")
    if marks.any():
        seen = np.cumsum(marks, dtype=np.int64)
        before = np.maximum.accumulate(np.where(characters == ord("\n"), seen, 0))
        characters[(seen > before) & (characters != ord("\n"))] = ord(" ")


def _parsed(characters: NDArray[np.uint8], total: int, kind: type[_Number]) -> NDArray[_Number] | None:
    """Return all numbers; None where one of the `total` words is not a number."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # older NumPy warns when it stops early
        try:
            # A word more at the end: older NumPy stops within a word that is no number, and keeps what it has of it.
            values = np.fromstring(characters.tobytes() + b" 0", dtype=kind, sep=" ")
        except ValueError:
            return None
    return values[:-1] if len(values) == total + 1 else None


def _real(word: bytes) -> float:
    try:
        return math.nan if b"_" in word else float(word)  # Python allows underscores in numbers
    except ValueError:
        return math.nan


def _slow_indices(text: Text, lines: NDArray[np.int64], rows: bytes, field: int) -> list[int]:
    """Return the indices, read word by word, so that an error can name its line."""
    indices: list[int] = []
    for line, row in zip(lines.tolist(), rows.split(b"\n"), strict=False):
        for word in row.split():
            fields = word.split(b"/")
            digits = fields[field] if field < len(fields) else b""
            if field and not digits:
                indices.append(0)
                continue
            if not _INDEX.fullmatch(digits):
                raise AssetError(
                    text.path,
                    f"{decode(word)!r} is not a corner of a face",
                    place=text.place(line),
                    fix="repair the face",
                )
            indices.append(int(digits))
    return indices
