"""A rendered frame and what it cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from voxrt.sim.external_memory import CacheCost

FACE_NONE = 3
"""The face of a pixel whose ray crossed none: a miss, or a camera inside a solid."""


@dataclass(frozen=True, slots=True)
class RenderCost:
    """What a frame cost.

    Attributes
    ----------
    rays
        Rays traced: one per pixel and sample. Those of mirrors and shadows are not counted.
    words_read
        Octree words read; None for the model, which reads one word for many rays.
    cycles
        Clock cycles from the start of the frame to its last pixel; None for the model, which has no clock.
    seconds
        Wall seconds.
    cache
        What it cost at the caches; None without caches.
    """

    rays: int
    words_read: int | None
    cycles: int | None
    seconds: float
    cache: CacheCost | None = None


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """A rendered picture; row 0 is the top.

    Attributes
    ----------
    colour
        uint8, shape (H, W, 3), sRGB; on a transparent background (H, W, 4), with the opacity.
    material
        uint8, shape (H, W): the material hit, 0 for a miss.
    face
        uint8, shape (H, W): axis of the face crossed (0 x, 1 y, 2 z) or :data:`FACE_NONE`.
    cost
        Rays, words, cycles and seconds.
    """

    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cost: RenderCost
