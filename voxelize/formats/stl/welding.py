"""Welding: equal corners of triangles become one vertex."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def weld(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return the distinct corners as vertices, and the triangles over them.

    `corners`, float64, shape (3 * T, 3), are those of triangle after triangle. The vertices, float64, shape (V, 3), are
    in order of first appearance; the triangles are int32, shape (T, 3).
    """
    exact = np.ascontiguousarray(corners + 0.0)  # -0 becomes 0, which it equals
    _, first, inverse = np.unique(_hashes(exact), return_index=True, return_inverse=True)
    if not np.array_equal(exact[first][inverse], exact):  # two positions share a hash: compare all bytes, which is slow
        keys = exact.view(np.dtype((np.void, 24))).ravel()
        _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return exact[first[order]], rank[inverse].reshape(-1, 3).astype(np.int32)


def _hashes(exact: NDArray[np.float64]) -> NDArray[np.uint64]:
    """Mix the bits of each row: odd multipliers, as in Knuth's multiplicative hashing, and shifts of the high bits."""
    bits = exact.view(np.uint64)
    mixed = np.zeros(len(exact), dtype=np.uint64)
    for column, odd in enumerate((0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)):
        mixed = (mixed ^ bits[:, column]) * np.uint64(odd)
        mixed ^= mixed >> np.uint64(29)
    return mixed
