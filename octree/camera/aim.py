"""Cameras for people: they look at a point, or see all of a scene. All are right-handed, right = look x up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.camera.camera import DIRECTION_LIMIT, POSITION_UNITS, REGISTER_LIMIT, Camera, camera_from_registers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

FIELD_OF_VIEW = 35.0
"""Degrees across a frame's shorter side, by default."""

THREE_QUARTER = (-0.62, -0.68, -1.0)
"""The look of a camera at a scene's front (+z), from its right and above."""

_MARGIN = 0.085  # of the frame's side, left free on each side by eye_that_sees


def look_at(
    eye: ArrayLike,
    target: ArrayLike,
    *,
    size: tuple[int, int],
    field_of_view: float = FIELD_OF_VIEW,
    up: ArrayLike = (0.0, 1.0, 0.0),
    shift: ArrayLike = (0.0, 0.0),
) -> Camera:
    """Make the right-handed camera at `eye` that sees `target` in the middle of the frame.

    Parameters
    ----------
    eye, target
        float, shape (3,), voxels, grid frame.
    size
        Columns and rows of the frame.
    field_of_view
        Degrees across the frame's shorter side, above 0 and below 180.
    up
        float, shape (3,): the direction that points up in the frame.
    shift
        float, shape (2,): how far the middle of the frame lies to the right of `target`, and above it, in pixels.

    Raises
    ------
    ValueError
        `eye` and `target` coincide, `up` points along the line between them, or `field_of_view` is out of range.
    """
    from_eye = np.asarray(target, dtype=np.float64) - np.asarray(eye, dtype=np.float64)
    axes = _axes(from_eye, np.asarray(up, dtype=np.float64))
    focal = focal_length(size, field_of_view)
    axes[0] += np.asarray(shift, dtype=np.float64) / focal @ axes[1:]
    return _scaled(np.asarray(eye, dtype=np.float64), axes, focal, size)


def frame_points(points: ArrayLike, size: tuple[int, int]) -> Camera:
    """Make the camera that sees all points, tightly, from the front right and above.

    Parameters
    ----------
    points
        float, shape (N, 3), voxels, grid frame; at least one.
    size
        Columns and rows of the frame.
    """
    axes = _axes(np.array(THREE_QUARTER), np.array([0.0, 1.0, 0.0]))
    focal = focal_length(size)
    return _scaled(eye_that_sees(points, axes * [[focal], [1], [1]], size), axes, focal, size)


def eye_that_sees(points: ArrayLike, registers: ArrayLike, size: tuple[int, int]) -> NDArray[np.float64]:
    """Give where a camera of these registers sees all points, tightly: float, shape (3,), voxels.

    The points, one or more, are float, shape (N, 3), voxels; the registers float, shape (3, 3): look, right and up as
    rows, linearly independent, of any common scale.
    """
    rows = np.asarray(registers, dtype=np.float64)
    z, x, y = np.linalg.solve(rows.T, np.asarray(points, dtype=np.float64).T)
    # In the frame of the registers the eye (ez, ex, ey) sees x within the slope s when |x - ex| <= s (z - ez): the two
    # tightest corners a side give ez, and half way between them ex.
    slope_x, slope_y = (max(0.5, pixels * (0.5 - _MARGIN) - 1) for pixels in size)
    left, right = np.min(x + slope_x * z), np.max(x - slope_x * z)
    bottom, top = np.min(y + slope_y * z), np.max(y - slope_y * z)
    ez = min((left - right) / (2 * slope_x), (bottom - top) / (2 * slope_y))
    eye: NDArray[np.float64] = np.array([ez, (left + right) / 2, (bottom + top) / 2]) @ rows
    return eye


def frame_world(depth: int, size: tuple[int, int]) -> Camera:
    """Make the camera that sees a whole world of 2**`depth` voxels per side, whatever is in it."""
    axes = _axes(np.array(THREE_QUARTER), np.array([0.0, 1.0, 0.0]))
    focal = focal_length(size)
    side = float(1 << depth)
    # The sphere around the world fills the shorter side.
    distance = side * np.sqrt(3) / 2 / np.sin(np.radians(FIELD_OF_VIEW) / 2)
    return _scaled(np.full(3, side / 2) - distance * axes[0], axes, focal, size)


def refit(camera: Camera, made_for: tuple[int, int], size: tuple[int, int]) -> Camera:
    """Give a camera that was made for frames of one size the same angle across the shorter side of another.

    A camera without a direction stays as it is.
    """
    registers = np.array((camera.look, camera.right, camera.up), dtype=np.float64)
    if size == made_for or not registers.any():
        return camera
    registers[0] *= min(size) / min(made_for)
    eye = np.array(camera.position, dtype=np.float64) / POSITION_UNITS
    return _scaled(eye, registers, 1.0, size)


def focal_length(size: tuple[int, int], field_of_view: float = FIELD_OF_VIEW) -> float:
    """Give the distance, in pixels, from which the frame's shorter side is seen under `field_of_view` degrees."""
    if not 0 < field_of_view < 180:
        raise ValueError(f"a field of view of {field_of_view} degrees is not above 0 and below 180")
    return float(min(size) / (2 * np.tan(np.radians(field_of_view) / 2)))


def _axes(look: NDArray[np.float64], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give look, right, up as orthonormal rows."""
    if not (np.all(np.isfinite(look)) and np.all(np.isfinite(up))):
        raise ValueError("the camera's eye, target or up is not finite; give finite numbers")
    if not np.any(look):
        raise ValueError("the camera's eye and target coincide; move one of them")
    if not np.any(up):
        raise ValueError("the camera's up is 0, 0, 0; give the direction that points up in the picture")
    right = np.cross(look, up)
    if np.linalg.norm(right) < 1e-9 * np.linalg.norm(look) * np.linalg.norm(up):
        raise ValueError("the camera's up points along its look; give another up")
    rows = np.array([look, right, np.cross(right, look)])
    normalized: NDArray[np.float64] = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    return normalized


def _scaled(eye: NDArray[np.float64], axes: NDArray[np.float64], focal: float, size: tuple[int, int]) -> Camera:
    """Take the largest scale at which the triples fit their registers and the directions stay below the limit."""
    look, right, up = axes[0] * focal, axes[1], axes[2]
    width, height = size
    # Rounding moves each register by at most 1/2, and a direction by at most this:
    rounding = 1 + width // 2 + height // 2
    reach = np.abs(look) + np.abs(right) * (width // 2) + np.abs(up) * (height // 2)
    largest_register = max(float(np.max(np.abs(triple))) for triple in (look, right, up))
    scale = min((REGISTER_LIMIT - 1) / largest_register, (DIRECTION_LIMIT - 1 - rounding) / float(np.max(reach)))
    return camera_from_registers(eye, *(np.rint(triple * scale).astype(np.int64) for triple in (look, right, up)))
