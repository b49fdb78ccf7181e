"""The way of one ray through the octree: each word that it reads, in order."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import prod
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.camera import DIRECTION_LIMIT, POSITION_UNITS
from voxrt.sim import _model
from voxrt.sim.errors import SimulatorError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Octree
    from voxrt.octree.camera import Camera, Triple


@dataclass(frozen=True, slots=True)
class Reading:
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
        Axis of the plane that the ray crossed last (0 x, 1 y, 2 z), or :data:`~voxrt.sim.FACE_NONE` where it has
        crossed none since it left the camera.
    time
        The integer T of that crossing: distance along the axis in 1/16 voxel times the product of the other two
        components of the direction, a zero component counting as 1. 0 where no plane was crossed.
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
        return self.word >> 31 == 1

    @property
    def end(self) -> Triple:
        """One voxel behind the octant's highest."""
        x, y, z = self.corner
        side = 1 << self.level
        return x + side, y + side, z + side


@dataclass(frozen=True, slots=True)
class RayPath:
    """A ray and all that it read.

    Attributes
    ----------
    origin
        1/16 voxel, grid frame.
    direction
        Raw units of the camera's registers.
    root
        Word 0, which is kept between rays and not read by each.
    readings
        The words read, in order.
    material, face
        What was hit, as in :class:`~voxrt.sim.Frame`.
    cell
        The voxel hit, None at a miss.
    """

    origin: Triple
    direction: Triple
    root: int
    readings: tuple[Reading, ...]
    material: int
    face: int
    cell: Triple | None

    def point(self, time: int) -> tuple[float, float, float]:
        """Give the point of the ray (voxels, grid frame) at the T of a crossing."""
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
        Where from.
    size
        Columns and rows of the frame.
    pixel
        Column and row, from the frame's upper left.

    Raises
    ------
    SimulatorError
        The pixel lies outside the frame, or the camera's directions are too large.
    """
    (column, row), (width, height) = pixel, size
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


def follow_ray(octree: Octree, origin: Triple, direction: Triple) -> RayPath:
    """Follow a ray through an octree, exactly as the hardware traces it.

    Parameters
    ----------
    octree
        The memory.
    origin
        1/16 voxel, grid frame, signed 32 bit.
    direction
        Components below 2**20.

    Raises
    ------
    SimulatorError
        A component of the direction is too large.
    """
    if max(map(abs, direction)) >= DIRECTION_LIMIT:
        raise SimulatorError(f"the ray's direction {direction} is not below 2**20; scale it down")
    followed = _model.Memory(octree.words, octree.depth).follow(_int32(origin), _int32(direction))
    material = followed.material
    return RayPath(
        origin=origin,
        direction=direction,
        root=int(octree.words[0]),
        readings=tuple(Reading(**reading._asdict()) for reading in followed.readings),
        material=material,
        face=followed.face,
        cell=followed.cell if material else None,
    )


def _int32(triple: Triple) -> NDArray[np.int32]:
    return np.array(triple, np.int32)
