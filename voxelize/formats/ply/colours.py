"""The colours of rows of a PLY file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.formats.colour_range import clamped
from voxrt.voxelize.formats.ply.format import Column, ListColumn, Table

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.warning_log import WarningLog

# Red, green, blue and alpha of a row, by the names that writers use; the first set that is there counts.
_CHANNELS = (
    ("red", "green", "blue", "alpha"),
    ("diffuse_red", "diffuse_green", "diffuse_blue", "alpha"),
    ("r", "g", "b", "a"),
)
_LIKE_A_COLOUR = re.compile("red|green|blue|colou?r|rgb", re.IGNORECASE)


def linear_colours(table: Table, log: WarningLog) -> NDArray[np.float64] | None:
    """Return linear colour and alpha of rows, float64, shape (N, 4); None where they have none."""
    stored = stored_colours(table, log)
    return None if stored is None else np.column_stack([LINEAR_OF_SRGB8[stored[0]], stored[1]])


def stored_colours(table: Table, log: WarningLog) -> tuple[NDArray[np.uint8], NDArray[np.float64]] | None:
    """Return the sRGB colours of rows, uint8, shape (N, 3), and their alpha, 0 … 1, shape (N,); None for none.

    Whole numbers and reals are sRGB alike.
    """
    columns = {name.lower(): one for name, one in table.items() if not isinstance(one, ListColumn)}
    names = next((names for names in _CHANNELS if columns.keys() >= set(names[:3])), None)
    if names is None:
        left = [name for name in table if _LIKE_A_COLOUR.search(name)]
        log.add(
            "vertex-colour", f"properties {', '.join(left)} were left out: name colours red, green, blue", bool(left)
        )
        return None
    *channels, alpha = (columns.get(name) for name in names)
    stored = [np.round(_unit(one, log) * 255.0).astype(np.uint8) for one in channels if one is not None]
    return np.stack(stored, axis=1), np.ones(len(stored[0])) if alpha is None else _unit(alpha, log)


def _unit(column: Column, log: WarningLog) -> NDArray[np.float64]:
    """Return values of 0 … 1. The declared type alone decides their range; integers of 32 bits hold bytes.

    So do whole numbers of an ASCII file that do not fit their type, and are above the range then.
    """
    full = {"u1": 255.0, "i1": 127.0, "u2": 65535.0, "i2": 32767.0, "i4": 255.0, "u4": 255.0, "i8": 255.0}.get(
        column.dtype.str[1:], 1.0
    )
    return clamped(column.astype(np.float64)[:, None] / full, log)[:, 0]
