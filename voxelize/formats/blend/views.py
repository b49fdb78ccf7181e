"""Cameras, the sun and the sky of a scene of Blender."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct

from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.formats.blend.axes import placed_camera
from voxrt.voxelize.formats.blend.nodes import output_of, product, source
from voxrt.voxelize.formats.camera_viewpoint import camera_viewpoint

if TYPE_CHECKING:
    from voxrt.voxelize.scene import Viewpoint
    from voxrt.voxelize.warning_log import WarningLog


class Daylight(Struct, frozen=True):
    """The sun and the sky, as the options of baked light and of pictures take them."""

    sun: tuple[float, float, float] | None = None  # the direction towards the first sun, scene frame; None for none
    sky: tuple[int, int, int] | None = None  # the world's colour, sRGB; None where it has no single one

    @property
    def sky_text(self) -> str | None:
        """The sky as options write it: ``"#9db4d0"``."""
        return None if self.sky is None else "#{:02x}{:02x}{:02x}".format(*self.sky)


def read_viewpoint(depsgraph: Any, camera: Any, log: WarningLog) -> Viewpoint | None:
    """Return the viewpoint of an evaluated camera object; None, with a warning, where it makes no picture."""
    lens = camera.data
    if lens.type != "PERSP":
        log.add("camera", "cameras without perspective were left out")
        return None
    render = depsgraph.scene.render
    matrix = camera.calc_matrix_camera(
        depsgraph,
        x=render.resolution_x,
        y=render.resolution_y,
        scale_x=render.pixel_aspect_x,
        scale_y=render.pixel_aspect_y,
    )
    if render.pixel_aspect_x != render.pixel_aspect_y:
        log.add("camera", "pixels that are not square were taken as square")
    size = render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y
    viewpoint = projected_viewpoint(camera.name, camera.matrix_world, matrix, size)
    if viewpoint is None:
        log.add("camera", "cameras whose transform or field of view makes no picture were left out")
    return viewpoint


def projected_viewpoint(name: str, place: Any, projection: Any, size: tuple[float, float]) -> Viewpoint | None:
    """Return the viewpoint of a projection matrix, for pictures of so wide and so high; None where it makes none.

    `place` takes the frame in which one looks along -z to Blender's.
    """
    matrix = np.array(projection, np.float64)
    if matrix[3, 3] != 0 or not matrix[1, 1] > 0:
        return None
    angle = math.degrees(2 * math.atan(1 / matrix[1, 1]))
    # The third column moves the picture by halves of its width and its height.
    shift = float(matrix[0, 2]) / 2 * size[0] / size[1], float(matrix[1, 2]) / 2
    return camera_viewpoint(name, placed_camera(place), angle, shift)


def read_daylight(depsgraph: Any) -> Daylight:
    """Return the sun and the sky of an evaluated scene."""
    sun = None
    for instance in depsgraph.object_instances:
        light = instance.object
        if light.type == "LIGHT" and light.data.type == "SUN":
            x, y, z = placed_camera(instance.matrix_world)[:3, 2].tolist()
            sun = (x, y, z)
            break
    return Daylight(sun, _sky(depsgraph.scene.world))


def _sky(world: Any) -> tuple[int, int, int] | None:
    if world is None:
        return None
    linear: tuple[float, ...] = tuple(world.color)
    output = output_of(world)
    if output is not None:
        found = source(output.inputs["Surface"])
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
