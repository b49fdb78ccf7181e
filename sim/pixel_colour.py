"""How a pixel comes by its colour: the surfaces that its ray meets, their brightness and the light on them."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Literal

import numpy as np

from voxrt.octree import Rom
from voxrt.octree.camera import PLAIN_LIGHTING
from voxrt.sim import _model
from voxrt.sim.engine_arguments import palette_of, shading_of
from voxrt.sim.frame import FACE_NONE
from voxrt.sim.rendering import check_lighting
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    from voxrt.octree.camera import Lighting, Triple
    from voxrt.sim.path import RayPath

_REGISTERS = ("lower_faces", "upper_faces")


@dataclass(frozen=True, slots=True)
class Surface:
    """A surface that a ray met.

    Attributes
    ----------
    material
        Its material.
    face
        Axis of the face (0 x, 1 y, 2 z), or :data:`~voxrt.sim.FACE_NONE` if the camera stands in the solid.
    is_upper
        Whether the face looks along the positive axis.
    cell
        The voxel.
    """

    material: int
    face: int
    is_upper: bool
    cell: Triple

    @property
    def side(self) -> str | None:
        """Where the face looks, such as ``"+y"``; None for a camera in the solid."""
        return None if self.face == FACE_NONE else f"{'-+'[self.is_upper]}{'xyz'[self.face]}"

    @property
    def register(self) -> str | None:
        """The register that has the brightness of the face, such as ``"upper_faces.y"``."""
        return None if self.face == FACE_NONE else f"{_REGISTERS[self.is_upper]}.{'xyz'[self.face]}"


@dataclass(frozen=True, slots=True)
class PixelColour:
    """The colour of a pixel and how it comes about, as :func:`explain_colour` returns it.

    Attributes
    ----------
    colour
        sRGB, 0 … 255 each.
    mirrors
        The mirrors that reflected the ray, in order.
    surface
        What ended the ray; None if it left the world, or had no reflections left at a mirror.
    light
        What the point light does on the surface; ``"none"`` without one.
    brightness
        The colour of the surface's material times this is the pixel's.
    is_mean
        Whether the colour is the mean of the mirrors', because the ray had no reflections left.
    """

    colour: Triple
    mirrors: tuple[Surface, ...]
    surface: Surface | None
    light: Literal["none", "lit", "turned away", "shadowed"]
    brightness: Fraction
    is_mean: bool


def explain_colour(rom: Rom, path: RayPath, lighting: Lighting = PLAIN_LIGHTING) -> PixelColour:
    """Tell how the pixel of a ray comes by its colour, by the exact model: ``docs/shading.md`` defines it.

    Parameters
    ----------
    rom
        The memory and its materials.
    path
        The ray, from :func:`~voxrt.sim.follow_pixel`.
    lighting
        Brightness of faces, point light and mirrors.

    Returns
    -------
    PixelColour
        The colour, which is that of :func:`~voxrt.sim.render`, and what it is made of.

    Raises
    ------
    TypeError, SimulatorError
        An argument has the wrong type, or the light is out of range.

    Examples
    --------
    >>> from voxrt.octree import Rom, from_points
    >>> from voxrt.sim import follow_ray
    >>> from voxrt.voxelize import EMPTY, Material
    >>> rom = Rom("dot", from_points([[1, 1, 1]], [1], depth=2), (EMPTY, Material("red", (255, 0, 0))))
    >>> found = explain_colour(rom, follow_ray(rom.octree, (24, 60, 24), (0, -1, 0)))
    >>> found.colour, found.surface.side, found.brightness
    ((255, 0, 0), '+y', Fraction(1, 1))
    """
    rom = instance("rom", rom, Rom)
    check_lighting(lighting)
    found = _model.Memory(rom.octree.words, rom.octree.depth).explain(
        palette_of(rom),
        np.array(path.origin, np.int32),
        np.array(path.direction, np.int32),
        **shading_of(rom, lighting),
    )
    return PixelColour(
        colour=found.colour,
        mirrors=tuple(Surface(*one) for one in found.mirrors),
        surface=None if found.surface is None else Surface(*found.surface),
        light=found.light,
        brightness=Fraction(found.part, found.whole),
        is_mean=found.is_mean,
    )
