"""How a pixel comes by its colour: the surfaces that its ray meets, their brightness and the light on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from msgspec import Struct

from voxrt.octree import Rom
from voxrt.octree.camera import FACES, PLAIN_LIGHTING
from voxrt.sim import _model
from voxrt.sim.engine_arguments import palette_of, shading_of
from voxrt.sim.frame import FACE_NONE
from voxrt.sim.rendering import check_lighting
from voxrt.voxelize.arguments import instance
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from voxrt.octree.camera import Lighting, Triple
    from voxrt.sim.path import RayPath


class Surface(Struct, frozen=True):
    """A surface that a ray met.

    Attributes
    ----------
    material, name
        Id and name of its material.
    face
        Where the side looks, such as ``"+y"``; None if the camera stands in the solid.
    voxel
        The voxel.
    """

    material: int
    name: str
    face: str | None
    voxel: tuple[int, int, int]


class PixelColour(Value, frozen=True):
    """The colour of a pixel and how it comes about, as :func:`explain_colour` returns it.

    Attributes
    ----------
    rgb
        The colour: sRGB, 0 … 255 each.
    shading
        ``"faces"``, ``"report"`` or ``"flat"``.
    mirrors
        The mirrors that reflected the ray, in order.
    surface
        What ended the ray; None if it left the world, or had no reflections left at a mirror.
    is_mean
        Whether the colour is the mean of the mirrors', because the ray had no reflections left.
    face_brightness
        The register of the side's brightness, 0 … 255, with the shading ``"faces"``; else None.
    light
        What the point light does on the surface; ``"none"`` without one.
    brightness
        The colour of the surface's material times this is the pixel's; 1 without a surface.
    """

    rgb: tuple[int, int, int]
    shading: str
    mirrors: tuple[Surface, ...]
    surface: Surface | None
    is_mean: bool
    face_brightness: int | None
    light: Literal["none", "lit", "turned away", "shadowed"]
    brightness: float


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
    >>> found.rgb, found.surface.face, found.brightness
    ((255, 0, 0), '+y', 1.0)
    """
    rom = instance("rom", rom, Rom)
    check_lighting(lighting)
    rgb, mirrors, met, light, part, whole, is_mean = _model.Memory(rom.octree.words, rom.octree.depth).explain(
        palette_of(rom.materials),
        np.array(path.origin, np.int32),
        np.array(path.direction, np.int32),
        **shading_of(rom, lighting),
    )
    surface = register = None
    if met is not None:
        surface = _surface(rom, *met)
        _, axis, is_upper, _ = met
        if axis != FACE_NONE and lighting.shading == "faces":
            register = (lighting.faces or FACES)[2 * axis + is_upper]
    reflecting = tuple(_surface(rom, *one) for one in mirrors)
    return PixelColour(rgb, lighting.shading, reflecting, surface, is_mean, register, light, part / whole)


def _surface(rom: Rom, material: int, face: int, is_upper: bool, cell: Triple) -> Surface:
    side = None if face == FACE_NONE else f"{'-+'[is_upper]}{'xyz'[face]}"
    return Surface(material, rom.materials[material].name, side, cell)
