"""Coordinates of files: those in range, and their transform to the scene frame (right-handed, metres, y up)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import arguments

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Rotations that turn the named axis upwards; right-handed, so that nothing is mirrored.
_TURNS = {
    "x": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    "y": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "z": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}


FARTHEST = 1e60
"""In the largest unit, products of four larger coordinates overflow float64: the square of a normal."""


def in_range(positions: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Tell which positions, shape (…, 3), have three coordinates that are numbers below :data:`FARTHEST`."""
    inside: NDArray[np.bool_] = (np.abs(positions) < FARTHEST).all(axis=-1)
    return inside


def scene_transform(up: str | None, unit: float | None) -> NDArray[np.float64]:
    """Return the matrix from a file's frame to the scene frame: float64, shape (4, 4), column vectors.

    `up` is the file's up axis, ``"x"``, ``"y"`` or ``"z"``, None for y; `unit` is metres per unit of the file, None for
    1. The matrix is a rotation by quarter turns times a uniform scale.
    """
    axis = "y" if up is None else arguments.choice("up", up, tuple(_TURNS))
    scale = 1.0 if unit is None else arguments.metres_per_unit("unit", unit)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(_TURNS[axis], dtype=np.float64) * scale
    return matrix
