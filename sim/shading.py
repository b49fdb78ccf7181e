"""What the shader is asked for beyond the picture by the camera's own light; docs/shading.md says what each gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.export import Lighting
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

    @classmethod
    def of(cls, lighting: Lighting | None) -> Shading:
        """Give what a memory's lighting asks for; None asks for nothing."""
        if lighting is None:
            return cls()
        light = Light(lighting.position, lighting.ambient) if lighting.on else None
        return cls(lighting.flat, light, lighting.bounces)

    @property
    def features(self) -> frozenset[str]:
        """What a ray tracer needs built in: of ``"flat"``, ``"light"`` and ``"mirrors"``."""
        wanted = {"flat": self.flat, "light": self.light is not None, "mirrors": self.bounces > 0}
        return frozenset(name for name, is_wanted in wanted.items() if is_wanted)


PLAIN = Shading()
"""Lit from the camera, no mirrors."""
