"""The camera that sees all of a memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import coarsen, leaves
from voxrt.octree.camera import frame_points

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Octree, Rom
    from voxrt.octree.camera import Camera

_OUTLINE_LEVELS = 6  # what is framed is known to 1/64 of the world: the frame's margin, at little cost


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


def outline(octree: Octree) -> NDArray[np.float64]:
    """Give points whose hull holds all that is solid, or the world: shape (N, 3), voxels."""
    coarse = coarsen(octree, max(0, octree.depth - _OUTLINE_LEVELS))
    parts = list(leaves(coarse, solid_only=True))
    low = np.concatenate([part.corners for part in parts]) if parts else np.zeros((1, 3), np.int32)
    levels = np.concatenate([part.levels for part in parts]) if parts else np.array([octree.depth], np.uint8)
    high = low + (1 << levels.astype(np.int64))[:, None]
    return np.concatenate([np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]).astype(np.float64)
