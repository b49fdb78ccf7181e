"""The camera that sees all of a memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import Rom, coarsen, leaves
from voxrt.octree.camera import frame_points
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Octree
    from voxrt.octree.camera import Camera

_OUTLINE_LEVELS = 6  # what is framed is known to 1/64 of the world: the frame's margin, at little cost


def frame_scene(rom: Rom, size: tuple[int, int]) -> Camera:
    """Make the camera that sees all solid voxels of a memory, or the whole world if there are none.

    Parameters
    ----------
    rom
        The memory.
    size
        Columns and rows of the frame.

    Returns
    -------
    Camera
        It looks from the front right and above, as that of :func:`frame_points`.

    Examples
    --------
    >>> import voxrt
    >>> camera = frame_scene(voxrt.build("examples/house.obj", depth=4).rom, (64, 48))
    >>> camera.position[2] > 16 * 16
    True
    """
    instance("rom", rom, Rom)
    return frame_points(outline(rom.octree), size)


def outline(octree: Octree) -> NDArray[np.float64]:
    """Return points whose convex hull holds all that is solid, or the world: float64, shape (N, 3), voxels.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> points = outline(from_points([[1, 2, 3]], [7], depth=2))
    >>> points.min(axis=0).tolist(), points.max(axis=0).tolist()
    ([1.0, 2.0, 3.0], [2.0, 3.0, 4.0])
    """
    coarse = coarsen(octree, max(0, octree.depth - _OUTLINE_LEVELS))
    parts = list(leaves(coarse, solid_only=True))
    low = np.concatenate([part.corners for part in parts]) if parts else np.zeros((1, 3), np.int32)
    levels = np.concatenate([part.levels for part in parts]) if parts else np.array([octree.depth], np.uint8)
    high = low + (1 << levels.astype(np.int64))[:, None]
    return np.concatenate([np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]).astype(np.float64)
