"""The normals of an OBJ file: ``vn``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.obj.text import Text, index_rows, real_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.obj.statements import Statements
    from voxrt.voxelize.warning_log import WarningLog

_IGNORED = "normals that cannot be read, or do not exist, were ignored"


def read_normals(
    text: Text, statements: Statements, log: WarningLog
) -> tuple[NDArray[np.float64], NDArray[np.int32]] | None:
    """Read the normals of all corners; None where the file has none.

    Return the vectors, float64, shape (N, 3), NaN where a number could not be read, and the row of each corner of the
    faces, int32, -1 for a corner without a normal.
    """
    second = text.buffer[np.minimum(text.starts + 1, len(text.buffer) - 1)]
    is_normal = (text.buffer[text.starts] == ord("v")) & (second == ord("n"))
    lines = np.flatnonzero(is_normal)
    if not len(lines):
        return None
    values, widths = real_rows(text, lines, 2)
    if (widths != 3).any():
        log.add("normals", _IGNORED, int((widths != 3).sum()))
        return None
    try:
        numbers, counts = index_rows(text, statements.face_lines, 1, 2)
    except AssetError:
        log.add("normals", _IGNORED)
        return None
    before = np.repeat(np.cumsum(is_normal)[statements.face_lines], counts)
    rows = np.where(numbers < 0, before + numbers, numbers - 1)
    wrong = (numbers != 0) & ((rows < 0) | (rows >= len(lines)))
    log.add("normals", _IGNORED, int(wrong.sum()))
    rows[wrong] = -1
    return values.reshape(-1, 3), rows.astype(np.int32)
