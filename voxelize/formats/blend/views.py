"""Cameras, the sun and the sky of a scene of Blender."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.formats.blend.axes import placed_camera
from voxrt.voxelize.formats.blend.nodes import product, source
from voxrt.voxelize.formats.camera_viewpoint import camera_viewpoint

if TYPE_CHECKING:
    from voxrt.voxelize.scene import Viewpoint
    from voxrt.voxelize.warning_log import WarningLog


@dataclass(frozen=True, slots=True)
class Daylight:
    """The sun and the sky, as the options of baked light and of pictures take them."""

    sun: tuple[float, float, float] | None = None  # the direction towards the first sun, scene frame; None for none
    sky: tuple[int, int, int] | None = None  # the world's colour, sRGB; None where it has no single one

    @property
    def sky_text(self) -> str | None:
        """The sky as options write it: ``"#9db4d0"``."""
        return None if self.sky is None else "#{:02x}{:02x}{:02x}".format(*self.sky)


def read_viewpoint(depsgraph: Any, camera: Any, log: WarningLog) -> Viewpoint | None:  # noqa: ANN401 - of bpy
    """Return the viewpoint of an evaluated camera object; None, with a warning, where it makes no picture."""
    lens = camera.data
    if lens.type != "PERSP":
        log.add("camera", "cameras without perspective were left out")
        return None
    render = depsgraph.scene.render
    matrix = np.array(
        camera.calc_matrix_camera(
            depsgraph,
            x=render.resolution_x,
            y=render.resolution_y,
            scale_x=render.pixel_aspect_x,
            scale_y=render.pixel_aspect_y,
        )
    )
    if render.pixel_aspect_x != render.pixel_aspect_y:
        log.add("camera", "pixels that are not square were taken as square")
    angle = math.degrees(2 * math.atan(1 / matrix[1, 1]))
    # The projection's third column moves the picture by halves of its width and its height.
    across = float(matrix[0, 2]) / 2 * render.resolution_x * render.pixel_aspect_x
    shift = across / (render.resolution_y * render.pixel_aspect_y), float(matrix[1, 2]) / 2
    viewpoint = camera_viewpoint(camera.name, placed_camera(camera.matrix_world), angle, shift)
    if viewpoint is None:
        log.add("camera", "cameras whose transform or field of view makes no picture were left out")
    return viewpoint


def read_daylight(depsgraph: Any) -> Daylight:  # noqa: ANN401 - bpy.types.Depsgraph
    """Return the sun and the sky of an evaluated scene."""
    sun = None
    for instance in depsgraph.object_instances:
        light = instance.object
        if light.type == "LIGHT" and light.data.type == "SUN":
            x, y, z = placed_camera(instance.matrix_world)[:3, 2].tolist()
            sun = (x, y, z)
            break
    return Daylight(sun, _sky(depsgraph.scene.world))


def _sky(world: Any) -> tuple[int, int, int] | None:  # noqa: ANN401 - bpy.types.World
    if world is None:
        return None
    linear: tuple[float, ...] | None = tuple(world.color)
    if world.node_tree is not None:
        output = world.node_tree.get_output_node("ALL")
        found = None if output is None else source(output.inputs["Surface"])
        if found is None:
            return (0, 0, 0)
        node, _, groups = found
        colour = product(node.inputs["Color"], groups) if node.type == "BACKGROUND" else None
        bright = product(node.inputs["Strength"], groups) if node.type == "BACKGROUND" else None
        if colour is None or bright is None or colour.image or bright.image:
            return None
        linear = tuple(one * bright.factor[0] for one in colour.factor)
    red, green, blue = srgb_from_linear(linear).tolist()
    return red, green, blue
