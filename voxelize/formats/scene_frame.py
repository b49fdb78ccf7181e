"""Coordinates of files: those in range, and their transform to the scene frame (right-handed, metres, y up)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import arguments

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.warning_log import WarningLog

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
    x, y, z = np.moveaxis(np.abs(positions) < np.float64(FARTHEST), -1, 0)  # NumPy is slow along short rows
    inside: NDArray[np.bool_] = x & y & z
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


_FLAT_SHARE, _MUCH_MORE, _THIN = 0.02, 4.0, 1e-4
_ENOUGH = 200_000  # triangles that tell


def hint_up_axis(
    up: str | None, positions: NDArray[np.floating], triangles: NDArray[np.int32], log: WarningLog
) -> None:
    """Say so where nobody states the up axis, and a mesh stands on a flat base if z is up, but not if y is.

    `positions` have shape (V, 3), `triangles` (T, 3). A base is flat where 2 % of the surface lie at the
    lower end of the axis, and four times as much as at its upper end and at the lower end of the other axis.
    """
    if up is not None:
        return
    some = positions[triangles[:: max(1, len(triangles) // _ENOUGH)]]
    corners = np.ascontiguousarray(some.transpose(1, 2, 0), np.float64)  # corner, axis, triangle
    low, high = corners.min(axis=(0, 2)), corners.max(axis=(0, 2))
    size = float((high - low).max())
    if not 0 < size < FARTHEST:
        return
    corners = (corners - low[:, None]) / size
    u, v = corners[1] - corners[0], corners[2] - corners[0]
    area = np.sqrt(sum((u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2]) ** 2 for i in range(3)))
    total = area.sum()

    def share(axis: int, end: float) -> float:
        flat = np.abs(corners[:, axis] - end).max(axis=0) < _THIN
        return float(area[flat].sum() / total)

    if total > 0:
        base = share(2, 0.0)
        others = share(2, float((high - low)[2] / size)), share(1, 0.0)
        if base >= _FLAT_SHARE and base > _MUCH_MORE * max(others):
            message = "the file does not state its up axis, and stands on a flat base if z is up: try --up z"
            log.add("up-axis", message)
