"""The scale of the level of detail for a camera: the register ``lod.scale``."""

from __future__ import annotations

from math import isqrt
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.octree.camera.camera import Camera

LOD_SCALE_BITS = 20


def lod_scale(camera: Camera, cell: float = 1.0) -> int:
    """Compute 2**20 / (cell |right|), rounded down: what tells rays how wide the cells are that they stop at.

    `cell` is the width of the widest of these, in pixels, above 0; all pixels are as wide as those in the middle, along
    right. The result is 1 … 2**20 - 1, or 0, which switches the level of detail off, if right is zero.

    Examples
    --------
    >>> from voxrt.octree.camera import Camera
    >>> lod_scale(Camera(position=(0, 0, 0), look=(0, 0, 8000), right=(-16, 0, 0), up=(0, 16, 0)))
    65536
    >>> lod_scale(Camera(position=(0, 0, 0), look=(0, 0, 8000), right=(-16, 0, 0), up=(0, 16, 0)), cell=0.5)
    131072
    """
    from fractions import Fraction  # noqa: PLC0415 - slow to import, and most pictures do without

    square = sum(component * component for component in camera.right) * Fraction(cell) ** 2
    return min((1 << LOD_SCALE_BITS) - 1, isqrt((1 << 2 * LOD_SCALE_BITS) // square)) if square else 0
