"""The camera's registers, and makers of cameras for people."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import coarsen, leaves

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from voxrt.octree import Octree, Rom

Triple = tuple[int, int, int]

POSITION_UNITS = 16
"""Camera positions count in this fraction of a voxel."""

DIRECTION_LIMIT = 1 << 20
"""Every component of a pixel's direction is smaller than this."""

_REGISTER_LIMIT = 1 << 15
FIELD_OF_VIEW = 35.0
"""Degrees across a frame's shorter side, where nobody says."""

THREE_QUARTER = (-0.62, -0.68, -1.0)
"""The look of a camera at a scene's front (+z), from its right and above."""

_MARGIN = 0.04  # of the frame's side, left free on each side by eye_that_sees
_OUTLINE_LEVELS = 6  # what is framed is known to 1/64 of the world: the frame's margin, at little cost


@dataclass(frozen=True, slots=True)
class Camera:
    """What the ray generator reads: direction = look + right * (column - W // 2) + up * (H // 2 - row).

    Attributes
    ----------
    position
        Signed, 1/16 voxel, grid frame; may stand outside the world.
    look, right, up
        Signed 16 bit each, grid axes, any common scale. Cameras made for people are right-handed: right = look x up.
    """

    position: Triple
    look: Triple
    right: Triple
    up: Triple


def camera_from_registers(position: ArrayLike, look: ArrayLike, right: ArrayLike, up: ArrayLike) -> Camera:
    """Make a camera of raw direction triples, of either handedness.

    Parameters
    ----------
    position
        float, shape (3,), voxels, grid frame; rounded to 1/16 voxel.
    look, right, up
        int, shape (3,), signed 16 bit.

    Raises
    ------
    ValueError
        A value that its register cannot hold.
    """
    place = np.asarray(position, dtype=np.float64)
    if place.shape != (3,) or not np.all(np.abs(place) < 2**31 / POSITION_UNITS - 1):
        raise ValueError(f"camera position {place.tolist()} is not three numbers that fit signed 32 bits of 1/16 voxel")
    return Camera(
        position=_triple(np.rint(place * POSITION_UNITS)),
        look=_register("look", look),
        right=_register("right", right),
        up=_register("up", up),
    )


def look_at(
    eye: ArrayLike,
    target: ArrayLike,
    *,
    size: tuple[int, int],
    field_of_view: float = FIELD_OF_VIEW,
    up: ArrayLike = (0.0, 1.0, 0.0),
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

    Raises
    ------
    ValueError
        `eye` and `target` coincide, `up` points along the line between them, or `field_of_view` is out of range.
    """
    from_eye = np.asarray(target, dtype=np.float64) - np.asarray(eye, dtype=np.float64)
    axes = _axes(from_eye, np.asarray(up, dtype=np.float64))
    return _scaled(np.asarray(eye, dtype=np.float64), axes, focal_length(size, field_of_view), size)


def frame_scene(rom: Rom, size: tuple[int, int]) -> Camera:
    """Make the camera that sees all solid voxels of a memory, or the whole world where there are none.

    Parameters
    ----------
    rom
        What is to be seen, as :func:`frame_points` sees points.
    size
        Columns and rows of the frame.
    """
    return frame_points(outline(rom.octree), size)


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

    Parameters
    ----------
    points
        float, shape (N, 3), voxels, grid frame; at least one.
    registers
        float, shape (3, 3): look, right and up as rows, linearly independent, of any common scale.
    size
        Columns and rows of the frame.
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


def outline(octree: Octree) -> NDArray[np.float64]:
    """Give points whose hull holds all that is solid, or the world: shape (N, 3), voxels."""
    coarse = coarsen(octree, max(0, octree.depth - _OUTLINE_LEVELS))
    parts = list(leaves(coarse, solid_only=True))
    low = np.concatenate([part.corners for part in parts]) if parts else np.zeros((1, 3), np.int32)
    levels = np.concatenate([part.levels for part in parts]) if parts else np.array([octree.depth], np.uint8)
    high = low + (1 << levels.astype(np.int64))[:, None]
    return np.concatenate([np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]).astype(np.float64)


def focal_length(size: tuple[int, int], field_of_view: float = FIELD_OF_VIEW) -> float:
    """Give the distance, in pixels, from which the frame's shorter side is seen under `field_of_view` degrees."""
    if not 0 < field_of_view < 180:
        raise ValueError(f"a field of view of {field_of_view} degrees is not above 0 and below 180")
    return float(min(size) / (2 * np.tan(np.radians(field_of_view) / 2)))


def pixel_directions(camera: Camera, size: tuple[int, int]) -> NDArray[np.int64]:
    """Give the direction of every pixel's ray, shape (H, W, 3), raw units, as the ray generator makes them."""
    width, height = size
    look, right, up = (np.array(triple, dtype=np.int64) for triple in (camera.look, camera.right, camera.up))
    columns = np.arange(width, dtype=np.int64) - width // 2
    rows = height // 2 - np.arange(height, dtype=np.int64)
    directions: NDArray[np.int64] = look + right * columns[None, :, None] + up * rows[:, None, None]
    return directions


def _axes(look: NDArray[np.float64], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give look, right, up as orthonormal rows."""
    right = np.cross(look, up)
    if not np.all(np.isfinite(right)) or np.linalg.norm(right) < 1e-9 * np.linalg.norm(look) * np.linalg.norm(up):
        raise ValueError("the camera's up points along its look, or one of them has no length")
    if not np.any(right):
        raise ValueError("the camera's eye and target coincide; move one of them")
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
    scale = min((_REGISTER_LIMIT - 1) / largest_register, (DIRECTION_LIMIT - 1 - rounding) / float(np.max(reach)))
    return camera_from_registers(eye, *(np.rint(triple * scale).astype(np.int64) for triple in (look, right, up)))


def _register(name: str, values: ArrayLike) -> Triple:
    array = np.asarray(values)
    if array.shape != (3,) or not np.all(array == np.rint(array)) or not np.all(np.abs(array) < _REGISTER_LIMIT):
        raise ValueError(f"camera {name} {array.tolist()} is not three whole numbers of signed 16 bits")
    return _triple(array)


def _triple(values: NDArray[np.generic]) -> Triple:
    x, y, z = (int(value) for value in values.tolist())
    return x, y, z
