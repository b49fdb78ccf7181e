"""Triangle soup to shared vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def weld(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Make one vertex of all corners at exactly one place.

    Parameters
    ----------
    corners
        float64, shape (3 * T, 3): the corners of triangle after triangle.

    Returns
    -------
    positions
        float64, shape (V, 3), in order of first appearance.
    triangles
        int32, shape (T, 3).
    """
    exact = np.ascontiguousarray(corners + 0.0)  # -0 becomes 0, which it equals
    keys = exact.view(np.dtype((np.void, 24))).ravel()
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return exact[first[order]], rank[inverse].reshape(-1, 3).astype(np.int32)
