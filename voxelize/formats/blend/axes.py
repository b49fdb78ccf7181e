"""Blender's frame, z up, to the scene frame, y up: (x, y, z) becomes (x, z, -y), as in Blender's own glTF exporter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_TO_SCENE = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
_TO_BLENDER = _TO_SCENE.T


def turned_points(points: NDArray[np.float32]) -> NDArray[np.float32]:
    """Turn points or directions, shape (N, 3), of an object's frame."""
    turned = points[:, [0, 2, 1]]
    turned[:, 2] *= -1
    return turned


def placed(matrix: Any) -> NDArray[np.float64]:
    """Return the transform of an object whose points are turned: float64, shape (4, 4)."""
    turned: NDArray[np.float64] = _TO_SCENE @ np.array(matrix, np.float64) @ _TO_BLENDER
    return turned


def placed_camera(matrix: Any) -> NDArray[np.float64]:
    """Return the transform of a camera or a light, whose own frame stays: float64, shape (4, 4)."""
    turned: NDArray[np.float64] = _TO_SCENE @ np.array(matrix, np.float64)
    return turned
