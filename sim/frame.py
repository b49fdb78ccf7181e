"""A rendered frame and what it cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FACE_NONE = 3
"""The face of a pixel that crossed none: a miss, or a camera inside a solid."""


@dataclass(frozen=True, slots=True)
class RenderCost:
    """What a frame cost.

    Attributes
    ----------
    rays
        Rays traced, one a pixel.
    words_read
        Octree words read; None from the model, which reads one word for many rays.
    cycles
        Clocks from the frame's start to its last pixel accepted; None from the model, which has no clock.
    seconds
        Wall seconds.
    """

    rays: int
    words_read: int | None
    cycles: int | None
    seconds: float


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """A frame, row 0 at the top.

    Attributes
    ----------
    colour
        uint8, shape (H, W, 3), sRGB.
    material
        uint8, shape (H, W): the material hit, 0 for a miss.
    face
        uint8, shape (H, W): axis of the face crossed (0 x, 1 y, 2 z) or :data:`FACE_NONE`.
    cost
        What it cost.
    """

    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cost: RenderCost
