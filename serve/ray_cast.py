"""One ray through a scene: the voxel that a pixel of the page shows."""

from __future__ import annotations

from dataclasses import dataclass
from math import prod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..board.scene import Scene
    from ..board.view import Triple


@dataclass(frozen=True, slots=True)
class RayHit:
    """The first solid voxel on a ray.

    Attributes
    ----------
    voxel
        Of the grid.
    material
        1 ... 255.
    face
        Axis of the side through which the ray enters it: 0 x, 1 y, 2 z; None where the ray starts in it.
    point
        Where the ray enters it, voxels.
    """

    voxel: Triple
    material: int
    face: int | None
    point: tuple[float, float, float]


def cast_ray(scene: Scene, origin: Triple, direction: Triple, frame: int = 0) -> RayHit | None:
    """Find the first solid voxel on a ray, as the hardware finds it; None where there is none.

    Planes between voxels are ordered by T and axis. T is the distance from the origin along the axis times the two
    other components of the direction (``docs/how-a-ray-walks.md``). All numbers are integers.

    Parameters
    ----------
    scene
        Its octree memory is valid.
    origin
        1/16 voxel, grid frame; it may stand outside the world.
    direction
        Any length.
    frame
        Frame of the scene's animation, counted from 0.
    """
    side = 1 << scene.depth
    mirrored = [component < 0 for component in direction]  # so that the ray goes up on every axis
    start = [16 * side - place if flip else place for place, flip in zip(origin, mirrored, strict=True)]
    lengths = [abs(component) for component in direction]
    scales = [prod(length or 1 for other, length in enumerate(lengths) if other != axis) for axis in range(3)]

    def crossing(axis: int, plane: int) -> tuple[int, int]:
        return (16 * plane - start[axis]) * scales[axis], axis

    def voxel_at(time: int, last: int) -> list[int]:
        """Return the voxel behind all planes up to (time, last)."""
        return [
            (start[axis] * scale + (0 if length == 0 else time - (axis > last))) // (16 * scale)
            for axis, (scale, length) in enumerate(zip(scales, lengths, strict=True))
        ]

    moving = [axis for axis in range(3) if lengths[axis]]
    entered = max(crossing(axis, 0) for axis in moving) if moving else (0, 2)
    inside = entered < (0, 3)
    time, last = (0, 2) if inside else entered
    voxel = voxel_at(time, last)
    while all(0 <= place < side for place in voxel):
        stored = [side - 1 - place if flip else place for place, flip in zip(voxel, mirrored, strict=True)]
        word, level = _leaf(scene.words, scene.roots[frame], scene.depth, stored)
        if material := word & 0xFF:
            x, y, z = stored
            part = time / (lengths[last] * scales[last]) if lengths[last] else 0.0
            at_x, at_y, at_z = (
                (place + component * part) / 16 for place, component in zip(origin, direction, strict=True)
            )
            return RayHit((x, y, z), material, None if inside else last, (at_x, at_y, at_z))
        if not moving:
            return None
        inside = False
        time, last = min(crossing(axis, ((voxel[axis] >> level) + 1) << level) for axis in moving)
        voxel = voxel_at(time, last)
    return None


def _leaf(words: NDArray[np.uint32], root: int, depth: int, voxel: list[int]) -> tuple[int, int]:
    """Find the leaf that holds a voxel: its word, and log2 of its side."""
    word, level = int(words[root]), depth
    while not word >> 31:
        level -= 1
        octant = sum((place >> level & 1) << axis for axis, place in enumerate(voxel))
        word = int(words[word + octant])
    return word, level
