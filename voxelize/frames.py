"""From a file's axes and unit to the scene frame (right-handed, metres, y up)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Rotations that bring the named axis up; right-handed, so that nothing is mirrored.
_TURNS = {
    "x": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    "y": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "z": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}


def scene_transform(up: str | None, unit: float | None) -> NDArray[np.float64]:
    """Return the matrix from a file's frame to the scene frame.

    Parameters
    ----------
    up
        The file's up axis, ``"x"``, ``"y"`` or ``"z"``; None means y.
    unit
        Metres per unit of the file, positive and finite; None means 1.

    Returns
    -------
    float64, shape (4, 4), column vectors: a rotation by quarter turns times a uniform scale.

    Raises
    ------
    ValueError
        Another axis, or a unit that is no length.
    """
    if up not in (None, *_TURNS):
        raise ValueError(f"up axis {up!r} is none of x, y, z")
    if unit is not None and not (math.isfinite(unit) and unit > 0):
        raise ValueError(f"unit {unit!r} is not a positive number of metres")
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(_TURNS[up or "y"], dtype=np.float64) * (1.0 if unit is None else unit)
    return matrix
