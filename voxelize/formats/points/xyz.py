"""XYZ: a point per row, as x, y and z, or as x, y, z, red, green and blue."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import read_asset
from voxrt.voxelize.formats.points.cloud_scene import cloud_scene
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.formats.written_numbers import is_number, not_a_number
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.scene import Scene

_COMMENT = re.compile(rb"(?:#|//)[^\n]*")
_SEPARATORS = bytes.maketrans(b",;\t\r", b"    ")
_DECIMAL_COMMA = re.compile(rb"[+-]?\d*,\d+")
_PLACE = 3  # numbers
_LARGEST_BYTE, _LARGEST_WORD = 255.0, 65535.0
_OF_UNIT_LENGTH = 0.01  # normals differ from it by less
_PART = 1 << 24  # bytes of text that are read at once
_SHOWN = 40
_BLANK, _NEW_LINE = 32, 10


def load_xyz(path: str | Path, *, up: str | None = None, unit: float | None = None, points: int | None = None) -> Scene:
    """Read rows of numbers: x, y, z; then red, green and blue, 0 to 255, or 0 to 1 where none is larger.

    Numbers are apart by blanks, tabs, commas or semicolons. Text after ``#`` or ``//`` is a comment, a first row of
    names is left out, and a first row of one number is the number of points. An intensity or a normal may stand between
    the place and the colour. It is left out and counted, and so is what follows.

    Parameters
    ----------
    path
        The file.
    up
        The file's up axis; None for z, as scanners and surveyors mean it.
    unit
        Metres per unit of the file; None for 1.
    points
        How many points make a voxel solid; None for 1.

    Returns
    -------
    Scene
        One object, of one point cloud.

    Raises
    ------
    AssetError
        The file cannot be read, has no points, rows of different lengths, or a word that is no number.
    """
    path = Path(path)
    log = WarningLog()
    rows = _rows(path, read_asset(path))
    rgb = _colours(rows)
    left = rows.shape[1] - _PLACE - (0 if rgb is None else 3)
    if left:
        log.add("point-attributes", "numbers of a point besides its place and its colour were left out", left)
    return cloud_scene(path, rows[:, :3], rgb, scene_transform(up or "z", unit), least=points, log=log)


def _colours(rows: NDArray[np.float64]) -> NDArray[np.uint8] | None:
    """Return the colours of points, uint8, shape (N, 3); None where no three numbers of theirs can be colours.

    Many programs write normals where others write colours: they have numbers below 0, or all of them unit length.
    """
    before = (1,) if rows.shape[1] == _PLACE + 4 else (0, 3)  # an intensity; nothing, or a normal
    for first in (_PLACE + count for count in before):
        colours = rows[:, first : first + 3]
        if colours.shape[1] < 3 or not ((colours >= 0) & (colours <= _LARGEST_WORD)).all():
            continue
        if (np.abs((colours**2).sum(axis=1) - 1) < _OF_UNIT_LENGTH).all():
            continue
        most = colours.max(initial=0)
        if most > _LARGEST_BYTE:
            return (colours // 256).astype(np.uint8)
        return np.round(colours if most > 1 else colours * _LARGEST_BYTE).astype(np.uint8)
    return None


def _rows(path: Path, data: bytes) -> NDArray[np.float64]:
    """Return the numbers, float64, shape (N, C); AssetError where rows differ in length or a word is no number."""
    text = _COMMENT.sub(b"", data) if b"#" in data or b"//" in data else data
    lines = text.strip().split(b"\n", 2)
    words = _words(lines[0])
    if len(lines) > 1 and (len(words) == 1 or not any(map(is_number, words))):  # a count, or names
        del lines[0]
        words = _words(lines[0])
    whole = lines[0].replace(b";", b" ").split()
    if len(whole) >= _PLACE and (comma := next(filter(_DECIMAL_COMMA.fullmatch, whole), None)):
        raise not_a_number(path, comma, "the first row")
    if not words:
        raise AssetError(path, "has no points", fix="export it again")
    if len(words) < _PLACE:
        raise AssetError(path, f"has rows of {len(words)} numbers, and a point has 3 or more", fix="export it again")
    body = b"\n".join(lines).translate(_SEPARATORS)
    numbers = np.empty((body.count(b"\n") + 1, len(words)))
    at, used = 0, 0
    while at < len(body):
        end = body.find(b"\n", at + _PART) + 1 or len(body)
        found = _numbers(body[at:end], len(words))
        if found is None:
            raise _wrong_row(path, body[at:end], len(words))
        numbers[used : used + len(found)] = found
        at, used = end, used + len(found)
    return numbers[:used]


def _numbers(text: bytes, columns: int) -> NDArray[np.float64] | None:
    """Return rows of numbers, shape (N, C); None where a row has another length, or a word that is no number."""
    stored = np.frombuffer(text, np.uint8)
    begins = stored > _BLANK  # where a word does
    begins[1:] &= stored[:-1] <= _BLANK
    lines = np.concatenate([[0], np.flatnonzero(stored[:-1] == _NEW_LINE) + 1])
    counts = np.add.reduceat(begins, lines, dtype=np.int64)
    if not ((counts == columns) | (counts == 0)).all():
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # what NumPy below 2.3 gives for a word
            return np.fromstring(text, sep=" ").reshape(-1, columns)
    except (ValueError, DeprecationWarning):
        return None


def _words(line: bytes) -> list[bytes]:
    return line.translate(_SEPARATORS).split()


def _wrong_row(path: Path, rows: bytes, columns: int) -> AssetError:
    """Return the error for the first row that is not of so many numbers."""
    for row in filter(None, map(bytes.split, rows.split(b"\n"))):
        shown = b" ".join(row)[:_SHOWN].decode("utf-8", "replace")
        wrong = next((word for word in row if not is_number(word)), None)
        if wrong is not None:
            return not_a_number(path, wrong, f"row {shown!r}")
        if len(row) != columns:
            problem = f"has {len(row)} numbers, and the first row {columns}"
            return AssetError(path, problem, place=f"row {shown!r}", fix="repair it, or export the file again")
    return AssetError(path, "has numbers that cannot be read", fix="export it again")
