"""Default cameras: one for a world without a camera, and one for a frame of another size."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .view import Camera

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .view import Triple

_SIGHT = np.array((-0.62, -0.55, -1.0))
_HALF_ANGLE = 0.315  # tangent: 35 degrees across the frame's shorter side
_REGISTER = (1 << 15) - 1
_DIRECTION = (1 << 20) - 1


def face_world(depth: int, size: tuple[int, int]) -> Camera:
    """Make the right-handed camera that sees a whole world of 2**`depth` voxels per side in a frame of `size`."""
    look = _SIGHT / np.linalg.norm(_SIGHT)
    right = np.cross(look, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    side = float(1 << depth)
    # The sphere around the world, seen under the angle across the shorter side.
    away = side * np.sqrt(3) / 2 / np.sin(np.arctan(_HALF_ANGLE))
    eye = (np.full(3, side / 2) - look * away) * 16
    x, y, z = np.rint(eye).astype(int).tolist()
    return _largest((x, y, z), np.array((look * min(size) / 2 / _HALF_ANGLE, right, up)), size)


def refit(camera: Camera, made_for: tuple[int, int], size: tuple[int, int]) -> Camera:
    """Give a camera that was made for frames of one size the same angle across the shorter side of another."""
    triples = np.array((camera.look, camera.right, camera.up), dtype=np.float64)
    triples[0] *= min(size) / min(made_for)
    return camera if size == made_for or not triples.any() else _largest(camera.position, triples, size)


def _largest(position: Triple, triples: NDArray[np.float64], size: tuple[int, int]) -> Camera:
    """Take the largest scale of look, right and up whose directions stay below 2**20."""
    reach = np.abs(triples[0]) + np.abs(triples[1]) * (size[0] // 2) + np.abs(triples[2]) * (size[1] // 2)
    rounding = 1 + size[0] // 2 + size[1] // 2
    scale = min(_REGISTER / np.abs(triples).max(), (_DIRECTION - rounding) / float(reach.max()))
    look, right, up = ((x, y, z) for x, y, z in np.rint(triples * scale).astype(int).tolist())
    return Camera(position, look, right, up)
