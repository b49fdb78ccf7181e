"""Where pictures of octants are taken from, and what can be drawn on at all."""

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

_MARGIN = 0.92


def check_screen(*, off_screen: bool) -> None:
    """Refuse to draw where VTK could not, which it does not survive.

    ViewerError without a screen where one is wanted, or with neither a screen nor a library that draws without one.
    """
    pv = import_pyvista()
    if not off_screen:
        if (sys.platform == "linux" and not _reaches_x_server()) or not pv.system_supports_plotting():
            raise ViewerError("there is no screen to open a window on; save a picture instead (--screenshot FILE)")
    elif sys.platform == "linux":
        screen = bool(os.environ.get("DISPLAY")) and _loads("libGL.so.1")
        if not (screen or _loads("libEGL.so.1") or _loads("libOSMesa.so.8") or _loads("libOSMesa.so")):
            raise ViewerError("drawing without a screen needs libEGL, which is not installed; apt install libegl1")
        from vtkmodules.vtkCommonCore import vtkLogger  # noqa: PLC0415 - optional

        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # it says that it finds no screen where none is needed


def place_eye(
    plotter: pyvista.Plotter,
    points: NDArray[np.float64],
    towards_eye: tuple[float, float, float] = THREE_QUARTER,
    *,
    room: tuple[float, float, float, float] = (0, 0, 0, 0),
) -> None:
    """Stand where all points (shape (N, 3)) are in the picture, and as near as that allows.

    `room` is what is kept free of the picture's left, right, bottom and top: parts of its width and height.

    A point is in the picture when its distance aside is at most a part of its depth, on both sides and axes: linear in
    where the camera stands.
    """
    look, right, up, tangents = _axes(plotter, towards_eye)
    depths = points @ look
    found = []
    for axis, tangent, before, after in ((right, tangents[0], *room[:2]), (up, tangents[1], *room[2:])):
        middle, half = before - after, _MARGIN * (1 - before - after)
        low, high = tangent * (middle - half), tangent * (middle + half)
        aside = points @ axis
        first, last = np.max(aside - high * depths), np.min(aside - low * depths)
        found.append(((last - first) / (high - low), first, last, low, high))
    depth = min(stand[0] for stand in found)
    column, row = ((first + last + (low + high) * depth) / 2 for _, first, last, low, high in found)
    _stand(plotter, depth * look + column * right + row * up, look, float(np.mean(depths) - depth))


def place_eye_around(
    plotter: pyvista.Plotter,
    middle: NDArray[np.float64],
    points: NDArray[np.float64],
    towards_eye: tuple[float, float, float],
) -> None:
    """Stand where `middle` (shape (3,)) is in the middle of the picture, and as near as all points are in it."""
    look, right, up, tangents = _axes(plotter, towards_eye)
    from_middle = points - middle
    needed = [
        np.abs(from_middle @ axis) / (_MARGIN * tangent) - from_middle @ look
        for axis, tangent in zip((right, up), tangents, strict=True)
    ]
    away = float(np.max(needed))
    _stand(plotter, middle - away * look, look, away)


def _axes(
    plotter: pyvista.Plotter, towards_eye: tuple[float, float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], tuple[float, float]]:
    """Return look, right and up, and the tangents of half the angles across and down the current subplot."""
    width, height = (end - start for start, end in zip(*np.reshape(plotter.renderer.viewport, (2, 2)), strict=True))
    aspect = width * plotter.window_size[0] / (height * plotter.window_size[1])
    look = -np.array(towards_eye) / np.linalg.norm(towards_eye)
    right = np.cross(look, (0, 1, 0))
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    tangent = float(np.tan(np.radians(plotter.camera.view_angle) / 2))
    return look, right, up, (tangent * aspect, tangent)


def _stand(plotter: pyvista.Plotter, eye: NDArray[np.float64], look: NDArray[np.float64], ahead: float) -> None:
    plotter.camera.position = tuple(eye)
    plotter.camera.focal_point = tuple(eye + ahead * look)
    plotter.camera.up = (0, 1, 0)
    plotter.renderer.reset_camera_clipping_range()


def _reaches_x_server() -> bool:
    """PyVista also counts a library that draws without a screen; windows need an X server."""
    try:
        x11 = ctypes.CDLL("libX11.so.6")
    except OSError:
        return False
    x11.XOpenDisplay.restype = ctypes.c_void_p
    display = x11.XOpenDisplay(None)
    if display:
        x11.XCloseDisplay(ctypes.c_void_p(display))
    return bool(display)


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
