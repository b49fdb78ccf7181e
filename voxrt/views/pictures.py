"""Pictures of memories: rendered, shown and saved."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np

from voxrt import sim
from voxrt.export import Blob
from voxrt.export.outputs import check_file, writing
from voxrt.octree import Rom
from voxrt.octree.camera import refit
from voxrt.options.option import merge
from voxrt.options.render_options import RenderOptions
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.sim.backgrounds import background_of
from voxrt.sim.image import save_png
from voxrt.views.viewpoint import aim_camera
from voxrt.voxelize.arguments import instance, whole_array
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable

    from numpy.typing import ArrayLike

    from voxrt.octree.camera import Camera, Lighting
    from voxrt.options.keywords import RenderKeywords
    from voxrt.sim import Background, Engine, Frame

_SAMPLES = 4  # rays per pixel of a preview, on each axis


class Picture(Value, frozen=True, eq=False):
    """A frame, the camera that saw it and the engine that rendered it. A notebook shows it.

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
    >>> voxrt.Picture(frame, camera, "model")
    <Picture: 64x48 pixels, 5 materials, by model>
    """

    frame: Frame
    camera: Camera
    engine: Engine

    def __repr__(self) -> str:
        return f"<Picture{repr(self.frame)[len('<Frame') : -1]}, by {self.engine}>"

    def _repr_png_(self) -> bytes:
        return self.frame._repr_png_()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture as :meth:`Frame.save` does."""
        self.frame.save(path)

    def show(self) -> None:
        """Show the picture as :meth:`Frame.show` does."""
        self.frame.show()


def render(
    rom: Rom,
    camera: Camera | None = None,
    options: RenderOptions | None = None,
    *,
    progress: Callable[[int, int], None] | None = None,
    **keywords: Unpack[RenderKeywords],
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
    progress
        Called now and then with the rows that are done and those of all samples.
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
        rom,
        camera or aim_camera(rom, options.size),
        engine=options.chosen_engine,
        progress=progress,
        **options.for_engines(),
    )


def preview(
    blob: Blob,
    camera: Camera,
    size: tuple[int, int] = PREVIEW_SIZE,
    *,
    engine: Engine = "model",
    samples: int | None = None,
    background: Background | str | None = None,
    threads: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> Picture:
    """Render a memory as it is best seen: lit as its author says, smooth if the model does it, on a light background.

    `progress` is called with the rows that are done and with all rows.
    SimulatorError if the engine cannot hold the memory, the camera or the light.

    Examples
    --------
    >>> import voxrt
    >>> blob = voxrt.build("examples/house.obj", depth=4).blob
    >>> preview(blob, voxrt.animation_camera(blob, (64, 48)), (64, 48))
    <Picture: 64x48 pixels, 5 materials, by model>
    """
    frame = render(
        blob.rom,
        camera,
        size=size,
        engine=engine,
        config=config_of(blob.lighting),
        lighting=blob.lighting,
        samples=samples or (1 if engine == "rtl" else _SAMPLES),
        background=background or background_of(blob.rom.materials[0].colour),
        threads=threads,
        progress=progress,
    )
    return Picture(frame, camera, engine)


def config_of(lighting: Lighting | None) -> str:
    """Return the smallest configuration of the hardware that has such a light.

    Examples
    --------
    >>> config_of(None)
    'tiny'
    """
    return "lit" if lighting is not None and lighting.features else "tiny"


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


def save_picture(picture: Frame | Picture | ArrayLike, path: str | os.PathLike[str]) -> None:
    """Write a picture as a PNG file. An interruption leaves the old file or the new one.

    Parameters
    ----------
    picture
        A frame, a picture, or an array: uint8, shape (H, W, 3), sRGB, or (H, W, 4) with the opacity.
    path
        The file. Its folder is made if it is missing.

    Raises
    ------
    OutputError
        The file cannot be written.
    TypeError, ValueError
        It is no picture.

    Examples
    --------
    >>> import numpy as np, voxrt
    >>> voxrt.save_picture(np.zeros((48, 64, 3), np.uint8), "black.png")
    """
    if isinstance(picture, sim.Frame | Picture):
        picture.save(path)
        return
    channels = 4 if np.shape(picture)[-1:] == (4,) else 3
    save_png(path, whole_array("picture", picture, ("H", "W", channels), np.uint8, low=0, high=255))
