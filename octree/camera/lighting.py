"""How a picture is lit: ``docs/shading.md`` says what each setting does to a pixel."""

from __future__ import annotations

from dataclasses import dataclass

from .camera import Triple  # noqa: TC001 - manifests are read by the annotations of this class

BOUNCE_LIMIT = 15
"""The most reflections per ray."""

FEATURES = ("flat", "light", "mirrors")
"""What a ray tracer can have built in besides the light of the camera, in the order that people see it."""


@dataclass(frozen=True, slots=True)
class Lighting:
    """How to shade a picture.

    Attributes
    ----------
    position
        The point light: signed, 1/16 voxel, grid frame; it may stand outside the world.
    ambient
        0 … 255, in 1/256: the brightness that no shadow of the point light goes below.
    on
        The point light shines and casts shadows; else the light is in the camera.
    flat
        Materials show their own colour, whatever the angle.
    bounces
        0 … 15: the most reflections per ray by mirror materials; with 0 they are like all others.

    Examples
    --------
    >>> Lighting((160, 800, 160), on=True, bounces=2).features == {"light", "mirrors"}
    True
    """

    position: Triple = (0, 0, 0)
    ambient: int = 32
    on: bool = False
    flat: bool = False
    bounces: int = 0

    @property
    def features(self) -> frozenset[str]:
        """Those of :data:`FEATURES` that a ray tracer needs for it."""
        wanted = {"flat": self.flat, "light": self.on, "mirrors": self.bounces > 0}
        return frozenset(name for name, is_wanted in wanted.items() if is_wanted)


CAMERA_LIGHT = Lighting()
"""A light in the camera, no mirrors."""
