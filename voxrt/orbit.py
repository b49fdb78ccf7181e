"""The cameras of an orbit: all of a scene, from all around."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import Rom
from voxrt.octree.camera import POSITION_UNITS, frame_points, look_at
from voxrt.sim import outline, outline_frames
from voxrt.voxelize.arguments import instance, whole, whole_array

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt.octree.camera import Camera

_CORNERS = 64  # of the polygon that stands for the circle around the scene


def orbit(rom: Rom, size: tuple[int, int], count: int = 128, *, roots: Sequence[int] = (0,)) -> list[Camera]:
    """Make cameras on a circle around a scene: the default view, turned about the vertical in equal steps.

    The scene fits each picture: the first camera sees the upright cylinder around it.

    Parameters
    ----------
    rom
        The scene.
    size
        Columns and rows of the pictures.
    count
        How many cameras, 1 ... 4096.
    roots
        Those of the frames of an animation: all of them fit.

    Returns
    -------
    list of Camera
        Counterclockwise, seen from above.

    Raises
    ------
    TypeError, ValueError
        An argument is not of the right type or out of range.

    Examples
    --------
    >>> import voxrt
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> cameras = orbit(rom, (640, 480), 4)
    >>> cameras[0].position[1] == cameras[2].position[1], cameras[0].look == cameras[2].look
    (True, False)
    """
    instance("rom", rom, Rom)
    count = whole("count", count, 1, 4096)
    width, height = whole_array("size", size, (2,), np.int64, low=1, high=1 << 14).tolist()
    points = outline(rom.octree) if len(roots) == 1 else outline_frames(rom.octree, roots)
    low, high = points.min(axis=0), points.max(axis=0)
    centre = (low + high) / 2
    radius = np.hypot(*(points[:, [0, 2]] - centre[[0, 2]]).T).max() / np.cos(np.pi / _CORNERS)
    corners = 2 * np.pi * np.arange(_CORNERS) / _CORNERS
    x, z = centre[0] + radius * np.cos(corners), centre[2] + radius * np.sin(corners)
    cylinder = np.concatenate([np.stack([x, np.full(_CORNERS, y), z], axis=1) for y in (low[1], high[1])])
    first = frame_points(cylinder, (width, height))
    eye = np.array(first.position) / POSITION_UNITS - centre
    look = np.array(first.look, dtype=np.float64)
    cameras = []
    for angle in 2 * np.pi * np.arange(count) / count:
        cosine, sine = np.cos(angle), np.sin(angle)
        turn = np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])
        place = centre + turn @ eye
        cameras.append(look_at(place, place + turn @ look, size=(width, height)))
    return cameras
