"""Which coordinates of a file can be computed with."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

FARTHEST = 1e70
"""Products of four larger coordinates, as in the square of a normal, overflow float64."""


def in_range(positions: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Tell which positions, shape (…, 3), have three coordinates that are numbers below :data:`FARTHEST`."""
    inside: NDArray[np.bool_] = (np.abs(positions) < FARTHEST).all(axis=-1)
    return inside
