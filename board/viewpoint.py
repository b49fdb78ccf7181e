"""Where a camera stands when nobody says: in front of the world, a little to its right and above."""

from __future__ import annotations

import numpy as np

from .view import Camera

_SIGHT = np.array((-0.62, -0.55, -1.0))
_HALF_ANGLE = 0.315  # tangent: 35 degrees across the frame's shorter side
_REGISTER = (1 << 15) - 1
_DIRECTION = (1 << 20) - 1


def face_world(depth: int, size: tuple[int, int]) -> Camera:
    """Make the right-handed camera that sees a whole world of 2**`depth` voxels a side in a frame of `size`."""
    look = _SIGHT / np.linalg.norm(_SIGHT)
    right = np.cross(look, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    side = float(1 << depth)
    # The sphere around the world, seen under the angle across the shorter side.
    away = side * np.sqrt(3) / 2 / np.sin(np.arctan(_HALF_ANGLE))
    eye = (np.full(3, side / 2) - look * away) * 16
    focal = min(size) / 2 / _HALF_ANGLE
    triples = np.array((look * focal, right, up))
    reach = np.abs(triples[0]) + np.abs(right) * (size[0] // 2) + np.abs(up) * (size[1] // 2)
    rounding = 1 + size[0] // 2 + size[1] // 2
    scale = min(_REGISTER / np.abs(triples).max(), (_DIRECTION - rounding) / float(reach.max()))
    registers = np.rint(np.vstack((eye, triples * scale))).astype(int).tolist()
    return Camera(*(tuple(row) for row in registers))
