"""The stage that pictures of octants are taken on: lights, the eye, and what can be drawn on at all."""

from __future__ import annotations

import ctypes
import os
import sys
from typing import TYPE_CHECKING

import numpy as np

from voxrt.view.cells import import_pyvista
from voxrt.view.errors import ViewerError

if TYPE_CHECKING:
    import pyvista
    from numpy.typing import NDArray

TEXT = (230, 233, 238)
THREE_QUARTER = (0.62, 0.55, 1.0)
"""From the scene to the eye: a little to the right of the front, and above."""

_TOWARDS_SUN = (0.35, 1.0, 0.65)
_MARGIN = 0.92


def check_screen(*, off_screen: bool) -> None:
    """Refuse to draw where VTK could not, which it does not survive.

    Raises
    ------
    ViewerError
        There is no screen and one is wanted, or there is neither a screen nor a library that draws without one.
    """
    pv = import_pyvista()
    if not off_screen:
        if not pv.system_supports_plotting():
            raise ViewerError("there is no screen to open a window on; save a picture instead (--screenshot FILE)")
    elif sys.platform == "linux":
        screen = bool(os.environ.get("DISPLAY")) and _loads("libGL.so.1")
        if not (screen or _loads("libEGL.so.1") or _loads("libOSMesa.so.8") or _loads("libOSMesa.so")):
            raise ViewerError("drawing without a screen needs libEGL, which is not installed; apt install libegl1")
        from vtkmodules.vtkCommonCore import vtkLogger  # noqa: PLC0415 - optional

        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # it says that it finds no screen where none is needed


def light_up(plotter: pyvista.Plotter) -> None:
    """Light a renderer by a sun and a lamp at the eye."""
    pv = import_pyvista()
    plotter.add_light(pv.Light(position=_TOWARDS_SUN, light_type="scene light", intensity=0.75), only_active=True)
    plotter.add_light(pv.Light(light_type="headlight", intensity=0.2), only_active=True)


def place_eye(
    plotter: pyvista.Plotter,
    points: NDArray[np.float64],
    towards_eye: tuple[float, float, float] = THREE_QUARTER,
) -> None:
    """Stand where all points (shape (N, 3)) are in the picture, and as near as that allows.

    A point is in the picture when its distance aside is at most `half` times its depth, on both sides and axes: linear
    in where the camera stands.
    """
    width, height = (end - start for start, end in zip(*np.reshape(plotter.renderer.viewport, (2, 2)), strict=True))
    aspect = width * plotter.window_size[0] / (height * plotter.window_size[1])
    look = -np.array(towards_eye) / np.linalg.norm(towards_eye)
    right = np.cross(look, (0, 1, 0))
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    tangent = _MARGIN * np.tan(np.radians(plotter.camera.view_angle) / 2)
    depths = points @ look
    stands = []
    for axis, half in ((right, tangent * aspect), (up, tangent)):
        aside = points @ axis
        low, high = np.min(half * depths - aside), np.min(half * depths + aside)
        stands.append(((low + high) / (2 * half), (high - low) / 2))
    (depth_x, column), (depth_y, row) = stands
    eye = min(depth_x, depth_y) * look + column * right + row * up
    plotter.camera.position = tuple(eye)
    plotter.camera.focal_point = tuple(eye + (np.mean(depths) - min(depth_x, depth_y)) * look)
    plotter.camera.up = (0, 1, 0)
    plotter.renderer.reset_camera_clipping_range()


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
