"""Pictures of memories: rendered, and saved as PNG files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np

from voxrt import sim
from voxrt.export import Blob
from voxrt.octree import Rom
from voxrt.octree.camera import refit
from voxrt.options.option import merge
from voxrt.options.render_options import RenderOptions
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.outputs import check_file, writing
from voxrt.views.viewpoint import aim_camera
from voxrt.voxelize.arguments import instance, whole_array

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

    from voxrt.octree.camera import Camera
    from voxrt.options.keywords import RenderKeywords
    from voxrt.sim import Engine, Frame


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """A frame, the camera that saw it and the engine that rendered it.

    Attributes
    ----------
    frame
        The pixels and what they cost.
    camera
        The camera.
    engine
        ``"rtl"`` or ``"model"``.

    Examples
    --------
    >>> import voxrt
    >>> built = voxrt.build("examples/house.obj", depth=4)
    >>> camera = voxrt.aim_camera(built.rom, (64, 48))
    >>> frame = voxrt.render(built.rom, camera, size=(64, 48))
    >>> voxrt.Picture(frame, camera, "model").frame.colour.shape
    (48, 64, 3)
    """

    frame: Frame
    camera: Camera
    engine: Engine


def render(
    rom: Rom, camera: Camera | None = None, options: RenderOptions | None = None, **keywords: Unpack[RenderKeywords]
) -> Frame:
    """Render a picture of a memory.

    Parameters
    ----------
    rom
        The memory and its materials.
    camera
        The camera. None shows the whole scene from the front right and above.
    options
        How to render; None for the defaults.
    **keywords
        The options of :class:`RenderOptions` by name, such as `size` and `engine`. They take precedence over `options`.

    Returns
    -------
    Frame
        The pixels: ``colour`` (uint8, shape (H, W, 3), sRGB; (H, W, 4) on a transparent background), ``material`` and
        ``face``, and what they cost.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong type or out of range.
    SimulatorError
        The installation has no such engine, or the engine cannot hold the memory or the camera, or has no such shading.

    Examples
    --------
    >>> import voxrt
    >>> rom = voxrt.build("examples/house.obj", depth=5).rom
    >>> frame = voxrt.render(rom, size=(64, 48))
    >>> frame.colour.shape
    (48, 64, 3)
    """
    rom = instance("rom", rom, Rom)
    options = merge("render", RenderOptions, options, keywords)
    return sim.render(
        rom, camera or aim_camera(rom, options.size), engine=options.chosen_engine, **options.for_engines()
    )


def animation_camera(blob: Blob, size: tuple[int, int]) -> Camera:
    """Make the camera for all frames of an animation: the author's, or one that sees all of them.

    Parameters
    ----------
    blob
        The memory; one without animation has one frame.
    size
        Width and height of the pictures, pixels.

    Examples
    --------
    >>> import voxrt
    >>> blob = voxrt.build("examples/house.obj", depth=4).blob
    >>> voxrt.animation_camera(blob, (64, 48)) == voxrt.aim_camera(blob.rom, (64, 48))
    True
    """
    blob = instance("blob", blob, Blob)
    if blob.view is not None:
        return refit(blob.view, PREVIEW_SIZE, size)
    if blob.animation is None:
        return aim_camera(blob.rom, size)
    return sim.frame_animation(blob.rom, blob.animation.roots, size)


def save_animation(pictures: Iterable[ArrayLike], path: str | os.PathLike[str], period: float | None = None) -> None:
    """Write pictures as an animation. An interruption leaves the old file or the new one.

    Parameters
    ----------
    pictures
        uint8, shape (H, W, 3), sRGB, all of one size.
    path
        The file: a .webp, an .mp4, which needs imageio-ffmpeg, or else a GIF. Its folder is made if it is missing. GIF
        and WebP files play without end.
    period
        Seconds from one picture to the next, in steps of 1/100; None for 1/20.

    Raises
    ------
    OutputError
        The file cannot be written.
    TypeError, ValueError
        The arrays are no pictures.

    Examples
    --------
    >>> import numpy as np, voxrt
    >>> voxrt.save_animation([np.full((48, 64, 3), grey, np.uint8) for grey in (0, 255)], "blink.gif", 0.5)
    """
    from voxrt.view.animation import write_animation  # noqa: PLC0415 - Pillow comes with it

    arrays = [whole_array("pictures", one, ("H", "W", 3), np.uint8, low=0, high=255) for one in pictures]
    if not arrays or len({array.shape for array in arrays}) > 1:
        raise ValueError("pictures must be one or more, all of one size")
    path = Path(path)
    check_file(path)
    with writing(path):
        write_animation(path, arrays, period)


def save_picture(colour: ArrayLike, path: str | os.PathLike[str]) -> None:
    """Write a picture as a PNG file. An interruption leaves the old file or the new one.

    Parameters
    ----------
    colour
        uint8, shape (H, W, 3), sRGB, or (H, W, 4) with the opacity.
    path
        The file. Its folder is made if it is missing.

    Raises
    ------
    OutputError
        The file cannot be written.
    TypeError, ValueError
        The array is no picture.

    Examples
    --------
    >>> import numpy as np, voxrt
    >>> voxrt.save_picture(np.zeros((48, 64, 3), np.uint8), "black.png")
    """
    channels = 4 if np.shape(colour)[-1:] == (4,) else 3
    pixels = whole_array("colour", colour, ("H", "W", channels), np.uint8, low=0, high=255)
    path = Path(path)
    check_file(path)
    with writing(path):
        sim.write_png(path, pixels)
