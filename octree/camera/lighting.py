"""How a picture is lit: ``docs/shading.md`` says what each setting does to a pixel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from msgspec.structs import replace

from voxrt.octree.camera.camera import Triple  # noqa: TC001 - manifests are read by the annotations of this class
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

BOUNCE_LIMIT = 15
"""The most reflections per ray."""

FEATURES = ("light", "mirrors")
"""What a ray tracer can have built in besides brightness by face, in the order that people see it."""

Shading: TypeAlias = Literal["faces", "report", "flat"]
"""What brightness depends on: the face, the angle (as in the report on the original hardware), or nothing."""

Faces: TypeAlias = tuple[int, int, int, int, int, int]
"""Brightness of the faces that look along -x, +x, -y, +y, -z and +z: 0 … 255, in 1/255."""

FACES: Faces = (189, 189, 140, 255, 219, 219)
"""The default: the top (+y) is the brightest, the bottom the darkest, and the sides differ."""


class Lighting(Value, frozen=True):
    """How to shade a picture.

    Attributes
    ----------
    position
        The point light: signed, 1/16 voxel, grid frame; it may stand outside the world.
    ambient
        0 … 255, in 1/256: the brightness of shadows of the point light. With brightness by the angle, also the least
        brightness.
    on
        The point light shines and casts shadows.
    flat
        Materials show their own colour on every face; `faces` does not count.
    bounces
        0 … 15: the most reflections per ray by mirror materials; with 0 they are like all others.
    faces
        The brightness of each face. None: it depends on the angle to the camera, or to the point light.

    Examples
    --------
    >>> Lighting((160, 800, 160), on=True, bounces=2).features == {"light", "mirrors"}
    True
    >>> Lighting().shading, Lighting(faces=None).shading
    ('faces', 'report')
    """

    position: Triple = (0, 0, 0)
    ambient: int = 90
    on: bool = False
    flat: bool = False
    bounces: int = 0
    faces: Faces | None = FACES

    @property
    def features(self) -> frozenset[str]:
        """Those of :data:`FEATURES` that a ray tracer needs for it."""
        wanted = {"light": self.on, "mirrors": self.bounces > 0}
        return frozenset(name for name, is_wanted in wanted.items() if is_wanted)

    def within(self, features: AbstractSet[str]) -> Lighting:
        """Give the same lighting without what needs others of :data:`FEATURES` than these."""
        return replace(self, on=self.on and "light" in features, bounces=self.bounces if "mirrors" in features else 0)

    @property
    def shading(self) -> Shading:
        """What brightness depends on."""
        return "flat" if self.flat else "report" if self.faces is None else "faces"

    def shaded(self, shading: Shading) -> Lighting:
        """Give the same lighting with another shading; faces that had no brightness get the default one."""
        faces = None if shading == "report" else self.faces or FACES
        return replace(self, flat=shading == "flat", faces=faces)


PLAIN_LIGHTING = Lighting()
"""Brightness by face, no light, no mirrors."""
