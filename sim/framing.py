"""The camera that sees all of a memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import Rom, coarsen, frames_as_octants, leaves
from voxrt.octree.camera import frame_points
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    from collections.abc import Sequence

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


def frame_animation(rom: Rom, roots: Sequence[int], size: tuple[int, int]) -> Camera:
    """Make the camera that sees all solid voxels of all frames of an animation.

    Parameters
    ----------
    rom
        The memory.
    roots
        Those of the frames.
    size
        Columns and rows of the pictures.

    Examples
    --------
    >>> from voxrt.octree import Rom, from_points, join_frames
    >>> from voxrt.voxelize import EMPTY, Material
    >>> memory, roots = join_frames([from_points([[x, 0, 0]], [1], depth=3) for x in range(8)])
    >>> rom = Rom("dot", memory, (EMPTY, Material("red", (255, 0, 0))))
    >>> frame_animation(rom, roots, (64, 48)) == frame_scene(rom, (64, 48))
    False
    """
    instance("rom", rom, Rom)
    return frame_points(outline_frames(rom.octree, roots), size)


def outline_frames(octree: Octree, roots: Sequence[int]) -> NDArray[np.float64]:
    """Return points whose convex hull holds all that is solid in any frame: float64, shape (N, 3), voxels."""
    low, high = _solid_boxes(frames_as_octants(octree, roots), octree.depth)
    return _corners(low & (octree.size - 1), high - low)


def outline(octree: Octree) -> NDArray[np.float64]:
    """Return points whose convex hull holds all that is solid, or the world: float64, shape (N, 3), voxels.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> points = outline(from_points([[1, 2, 3]], [7], depth=2))
    >>> points.min(axis=0).tolist(), points.max(axis=0).tolist()
    ([1.0, 2.0, 3.0], [2.0, 3.0, 4.0])
    """
    low, high = _solid_boxes(octree, octree.depth)
    return _corners(low, high - low)


def _solid_boxes(octree: Octree, depth: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the lowest and highest corners of what is solid, in octants of at most 2**depth voxels per side."""
    coarse = coarsen(octree, max(0, depth - _OUTLINE_LEVELS))
    parts = list(leaves(coarse, solid_only=True))
    low = np.concatenate([part.corners for part in parts]) if parts else np.zeros((1, 3), np.int32)
    levels = np.concatenate([part.levels for part in parts]) if parts else np.array([depth], np.uint8)
    return low.astype(np.int64), low + (1 << np.minimum(levels, depth).astype(np.int64))[:, None]


def _corners(low: NDArray[np.int64], sides: NDArray[np.int64]) -> NDArray[np.float64]:
    return np.concatenate([low + np.where([i & 1, i & 2, i & 4], sides, 0) for i in range(8)]).astype(np.float64)
