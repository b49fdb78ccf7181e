"""Points whose convex hull is a cylinder, a cone or a capsule along y: colliders that have no class of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_AROUND = 128
_FROM_POLE = 32


def cylinder_points(top: float, bottom: float, height: float) -> NDArray[np.float64]:
    """Return points of a cylinder, or of a cone: the radii of its ends, and its height. float64, shape (256, 3)."""
    return np.concatenate([_ring(top, height / 2), _ring(bottom, -height / 2)])


def capsule_points(top: float, bottom: float, height: float) -> NDArray[np.float64]:
    """Return points of a capsule: the radii of its ends, and the distance of their centres. float64, shape (V, 3)."""
    return np.concatenate([_half_ball(top, height, 1.0), _half_ball(bottom, height, -1.0)])


def _ring(radius: float, height: float) -> NDArray[np.float64]:
    """Return points on a circle about y, shape (128, 3)."""
    angles = np.arange(_AROUND) * (2 * np.pi / _AROUND)
    return np.column_stack([radius * np.cos(angles), np.full(_AROUND, height), radius * np.sin(angles)])


def _half_ball(radius: float, height: float, side: float) -> NDArray[np.float64]:
    """Return points on the upper (`side` 1) or lower (-1) half ball of a capsule."""
    angles = np.arange(_FROM_POLE + 1) * (np.pi / 2 / _FROM_POLE)
    return np.concatenate(
        [_ring(radius * np.cos(angle), side * (height / 2 + radius * np.sin(angle))) for angle in angles]
    )
