"""The cameras of an orbit: all of a scene, from all around."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import Rom
from voxrt.octree.camera import Camera
from voxrt.sim import _model, outline, outline_frames
from voxrt.voxelize.arguments import instance, whole, whole_array

if TYPE_CHECKING:
    from collections.abc import Sequence


def orbit(rom: Rom, size: tuple[int, int], count: int = 128, *, roots: Sequence[int] = (0,)) -> list[Camera]:
    """Make cameras on a circle around a scene: the default view, turned about the vertical in equal steps.

    The first camera sees the upright cylinder around the scene, so the scene fits each picture; so do all frames of an
    animation, whose `roots` are given. The cameras, 1 ... 4096, are counterclockwise, seen from above. TypeError or
    ValueError where an argument is of the wrong type or out of range.

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
    return [
        Camera(*(tuple(triple) for triple in registers))
        for registers in _model.orbit(points, width, height, count).tolist()
    ]
