"""The path of one ray through the octree: each word that it reads, in order."""

from __future__ import annotations

from fractions import Fraction
from math import prod
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import Octree
from voxrt.octree.camera import DIRECTION_LIMIT, POSITION_UNITS
from voxrt.octree.words import is_leaf, material
from voxrt.sim import _model
from voxrt.sim.errors import SimulatorError
from voxrt.voxelize.arguments import instance, whole_array
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from voxrt.octree.camera import Camera, Triple


class Reading(Value, frozen=True):
    """A word that the ray read.

    Attributes
    ----------
    address
        Of the word.
    word
        Report dialect.
    level
        log2 of the side of the word's octant, voxels.
    corner
        The octant's lowest voxel (x, y, z), grid frame.
    axis
        Axis of the plane that the ray crossed last (0 x, 1 y, 2 z), or :data:`~voxrt.sim.FACE_NONE` if it has crossed
        none since it left the camera.
    time
        The integer T of that crossing: the distance along the axis, in 1/16 voxel, times the product of the other two
        components of the direction. A zero component counts as 1. 0 if no plane was crossed.
    """

    address: int
    word: int
    level: int
    corner: Triple
    axis: int
    time: int

    @property
    def is_leaf(self) -> bool:
        """Whether the word is a material and not a pointer."""
        return is_leaf(self.word)

    @property
    def material(self) -> int:
        """Material id of a leaf, 0 for empty space."""
        return material(self.word)

    @property
    def end(self) -> Triple:
        """One voxel behind the octant's highest."""
        x, y, z = self.corner
        side = 1 << self.level
        return x + side, y + side, z + side


class RayPath(Value, frozen=True):
    """A ray and all that it read, as :func:`follow_ray` and :func:`follow_pixel` return it.

    Attributes
    ----------
    origin
        1/16 voxel, grid frame.
    direction
        Raw units of the camera's registers.
    root
        Word 0. It is kept between rays, so no ray reads it.
    readings
        The words read, in order.
    material, face
        The material hit and the face crossed, as in :class:`~voxrt.sim.Frame`.
    cell
        The voxel hit; None for a miss.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> path = follow_ray(from_points([[5, 2, 2]], [7], depth=3), (0, 40, 40), (1, 0, 0))
    >>> path
    <RayPath: 5 words read, hits material 7 at voxel (5, 2, 2)>
    >>> path.point(path.readings[-1].time)
    (5.0, 2.5, 2.5)
    """

    origin: Triple
    direction: Triple
    root: int
    readings: tuple[Reading, ...]
    material: int
    face: int
    cell: Triple | None

    def __repr__(self) -> str:
        end = f"hits material {self.material} at voxel {self.cell}" if self.cell else "leaves the world"
        return f"<RayPath: {len(self.readings)} words read, {end}>"

    def point(self, time: int) -> tuple[float, float, float]:
        """Return the point of the ray (voxels, grid frame) at the T of a crossing."""
        scale = prod(abs(component) or 1 for component in self.direction)
        x, y, z = (
            float((start + Fraction(time * component, scale)) / POSITION_UNITS)
            for start, component in zip(self.origin, self.direction, strict=True)
        )
        return x, y, z


def follow_pixel(octree: Octree, camera: Camera, size: tuple[int, int], pixel: tuple[int, int]) -> RayPath:
    """Follow the ray of one pixel of a frame.

    Parameters
    ----------
    octree
        The memory.
    camera
        The camera.
    size
        Columns and rows of the frame.
    pixel
        Column and row, from the frame's upper left.

    Returns
    -------
    RayPath
        The words that the ray reads, and what it hits.

    Raises
    ------
    TypeError, ValueError
        The size or the pixel is not two integers.
    SimulatorError
        The pixel lies outside the frame, or the camera's directions are too large.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> from voxrt.sim import look_at
    >>> tree = from_points([[5, 2, 2]], [7], depth=3)
    >>> camera = look_at((5.5, 2.5, 20), (5.5, 2.5, 2.5), size=(9, 9))
    >>> follow_pixel(tree, camera, (9, 9), (4, 4)).cell
    (5, 2, 2)
    """
    width, height = whole_array("size", size, (2,), np.int64, low=1, high=1 << 14).tolist()
    column, row = whole_array("pixel", pixel, (2,), np.int64, low=-(1 << 31), high=1 << 31).tolist()
    if not (0 <= column < width and 0 <= row < height):
        raise SimulatorError(
            f"pixel {column},{row} lies outside the frame of {width}x{height}; columns go to {width - 1}, rows to "
            f"{height - 1}"
        )
    across, above = column - width // 2, height // 2 - row
    x, y, z = (
        look + right * across + up * above for look, right, up in zip(camera.look, camera.right, camera.up, strict=True)
    )
    return follow_ray(octree, camera.position, (x, y, z))


def follow_ray(octree: Octree, origin: ArrayLike, direction: ArrayLike) -> RayPath:
    """Follow a ray through an octree, exactly as the hardware traces it.

    Parameters
    ----------
    octree
        The memory.
    origin
        Three integers, 1/16 voxel, grid frame, signed 32 bit.
    direction
        Three integers below 2**20, not all zero.

    Returns
    -------
    RayPath
        The words that the ray reads, and what it hits.

    Raises
    ------
    TypeError, ValueError
        The origin or the direction is not three integers, or the direction is zero.
    SimulatorError
        A component of the direction is too large.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> tree = from_points([[5, 2, 2]], [7], depth=3)
    >>> [(hex(step.word), step.level) for step in follow_ray(tree, (80, 40, 40), (0, 0, 1)).readings]
    [('0x9', 2), ('0x11', 1), ('0xffffff07', 0)]
    """
    instance("octree", octree, Octree)
    start = _registers("origin", origin)
    way = _registers("direction", direction)
    if not any(way):
        raise ValueError("direction must not be zero")
    if max(map(abs, way)) >= DIRECTION_LIMIT:
        raise SimulatorError(f"the ray's direction {way} is not below 2**20; scale it down")
    memory = _model.Memory(octree.words, octree.depth)
    hit, face, cell, readings = memory.follow(np.array(start, np.int32), np.array(way, np.int32))
    return RayPath(
        origin=start,
        direction=way,
        root=int(octree.words[0]),
        readings=tuple(Reading(*reading) for reading in readings),
        material=hit,
        face=face,
        cell=cell if hit else None,
    )


def _registers(name: str, value: ArrayLike) -> Triple:
    x, y, z = whole_array(name, value, (3,), np.int64, low=-(1 << 31), high=(1 << 31) - 1).tolist()
    return x, y, z
