"""Pictures of octants, and turntables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.sim.image import write_png
from voxrt.view.drawing import draw
from voxrt.view.pane import Aspect, Pane
from voxrt.view.window import Window

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from voxrt.octree.query import Corner
    from voxrt.octree.rom import Rom
    from voxrt.view.pane import Preview


def plot(
    *roms: Rom,
    high: Corner | None = None,
    by: Aspect = "material",
    size: tuple[int, int] = (1024, 768),
    screenshot: str | os.PathLike[str] | None = None,
) -> None:
    """Show the octants of memories, side by side, in a window until it is closed; or save a picture of them.

    A click on an octant shows its address, word, level, bounds and material.

    Parameters
    ----------
    *roms
        The memories and their materials.
    high
        Show only octants that overlap the voxels below this (x, y, z); None shows all.
    by
        What the colours show: ``"material"`` or ``"level"``.
    size
        Width and height, pixels.
    screenshot
        A picture to write instead of opening a window.

    Raises
    ------
    ViewerError
        PyVista is not installed, or there is nothing to draw on.
    DoesNotFitError
        Too many octants.

    Examples
    --------
    >>> import voxrt
    >>> plot(voxrt.build("examples/house.obj", depth=4).rom, by="level", screenshot="house.png")
    """
    panes = [Pane(rom, high, by=by) for rom in roms]
    if screenshot is None:
        Window(panes, size).show()
        return
    write_png(screenshot, picture(panes, size))


def picture(
    panes: Sequence[Pane], size: tuple[int, int] = (1024, 768), *, preview: Preview | None = None
) -> NDArray[np.uint8]:
    """Draw panes side by side.

    Parameters
    ----------
    panes
        One or more; one if there is a preview.
    size
        Width and height of all together, pixels.
    preview
        A picture whose chosen pixel's ray is drawn through the octants.

    Returns
    -------
    NDArray[np.uint8]
        Shape (H, W, 3), sRGB.

    Raises
    ------
    ViewerError
        PyVista is not installed, or there is nothing to draw on.

    Examples
    --------
    >>> import voxrt
    >>> from voxrt.view import Pane
    >>> picture([Pane(voxrt.build("examples/house.obj", depth=4).rom)], (64, 48)).shape
    (48, 64, 3)
    """
    plotter, _ = draw(panes, size, preview=preview, off_screen=True)
    pixels = np.array(plotter.screenshot(None, return_img=True)[..., :3], np.uint8)
    plotter.close()
    return pixels


def turntable(panes: Sequence[Pane], size: tuple[int, int], frames: int) -> Iterator[NDArray[np.uint8]]:
    """Draw panes from all sides: one turn around the upright axis.

    Parameters
    ----------
    panes
        One or more.
    size
        Width and height of all together, pixels.
    frames
        Number of pictures.

    Yields
    ------
    NDArray[np.uint8]
        The next picture, as :func:`picture` returns it.

    Examples
    --------
    >>> import voxrt
    >>> from voxrt.view import Pane
    >>> len(list(turntable([Pane(voxrt.build("examples/house.obj", depth=4).rom)], (64, 48), 4)))
    4
    """
    plotter, grids = draw(panes, size, off_screen=True)
    corners = np.concatenate([np.asarray(grid.points, np.float64).reshape(-1, 3) for grid in grids])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2 if len(corners) else np.zeros(3)
    radius = float(np.linalg.norm(corners - middle, axis=1).max()) if len(corners) else 1.0
    for renderer in plotter.renderers:  # a ball that holds all is in the picture from everywhere
        camera = renderer.camera
        aspect = min(1.0, size[0] / len(panes) / size[1])
        away = radius / np.sin(np.arctan(aspect * np.tan(np.radians(camera.view_angle) / 2)))
        back = np.array(camera.direction) * -away
        camera.focal_point, camera.position = tuple(middle), tuple(middle + back)
        renderer.reset_camera_clipping_range()
    for _ in range(frames):
        plotter.render()
        yield np.array(plotter.screenshot(None, return_img=True)[..., :3], np.uint8)
        for renderer in plotter.renderers if len(panes) == 1 else plotter.renderers[:1]:  # linked ones share an eye
            renderer.camera.Azimuth(360 / frames)
    plotter.close()
