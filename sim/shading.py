"""What the shader is asked for beyond the picture by the camera's own light; docs/shading.md says what each gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.sim.camera import Triple

BOUNCE_LIMIT = 15
"""How often a ray can be asked to be reflected."""


@dataclass(frozen=True, slots=True)
class Light:
    """A point light that casts shadows.

    Attributes
    ----------
    position
        Signed, 1/16 voxel, grid frame; may stand outside the world.
    ambient
        0 … 255, in 1/256: the brightness that no shadow goes below.
    """

    position: Triple
    ambient: int = 32


@dataclass(frozen=True, slots=True)
class Shading:
    """The shader's features.

    Attributes
    ----------
    flat
        Materials show their own colour, whatever the angle.
    light
        Lights the scene in the camera's stead.
    bounces
        0 … 15: how often a ray is reflected by mirror materials; with 0 they are like all others.
    """

    flat: bool = False
    light: Light | None = None
    bounces: int = 0


PLAIN = Shading()
"""Lit from the camera, no mirrors."""
