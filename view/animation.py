"""Pictures one after another: GIF by Pillow, MP4 by FFmpeg where imageio-ffmpeg brings it."""

from __future__ import annotations

import io
import subprocess
import tempfile
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from voxrt.export.atomic import write_atomically
from voxrt.view.errors import ViewerError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

ANIMATION_SUFFIXES = (".gif", ".mp4")
PICTURES_A_SECOND = 20


def write_animation(path: Path, pictures: Iterable[NDArray[np.uint8]]) -> None:
    """Write pictures as an animation that plays for ever (GIF) or once (MP4), :data:`PICTURES_A_SECOND`.

    Parameters
    ----------
    path
        The file; its suffix is one of :data:`ANIMATION_SUFFIXES`.
    pictures
        One or more, uint8, shape (H, W, 3), sRGB, all of one size; for MP4 of even sides.

    Raises
    ------
    ViewerError
        MP4 is asked for and imageio-ffmpeg is not installed.
    OSError
        The file cannot be written.
    """
    if path.suffix.lower() == ".mp4":
        _write_mp4(path, pictures)
        return
    # One palette for all, of the first picture: what turns keeps its colours.
    first, *others = (Image.fromarray(picture) for picture in pictures)
    palette = first.quantize(255, method=Image.Quantize.MEDIANCUT)
    frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in (first, *others)]
    encoded = io.BytesIO()
    frames[0].save(encoded, "GIF", save_all=True, append_images=frames[1:], duration=1000 // PICTURES_A_SECOND, loop=0)
    write_atomically(path, encoded.getvalue())


def _write_mp4(path: Path, pictures: Iterable[NDArray[np.uint8]]) -> None:
    try:
        ffmpeg = import_module("imageio_ffmpeg")
    except ImportError as error:
        raise ViewerError(
            "MP4 needs imageio-ffmpeg, which is not installed; pip install imageio-ffmpeg, or write a .gif"
        ) from error
    first, *others = pictures
    height, width = first.shape[:2]
    pixels = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(PICTURES_A_SECOND), "-i", "-")
    coded = ("-an", "-c:v", "libx264", "-crf", "10", "-pix_fmt", "yuv420p")
    with tempfile.TemporaryDirectory(prefix="voxrt-") as folder:
        film = Path(folder, "turntable.mp4")  # FFmpeg goes back in an MP4, so it cannot write to a pipe
        done = subprocess.run(  # noqa: S603 - FFmpeg, by its path
            [ffmpeg.get_ffmpeg_exe(), "-v", "error", *pixels, *coded, film],
            input=b"".join(np.ascontiguousarray(picture).tobytes() for picture in (first, *others)),
            capture_output=True,
            check=False,
        )
        if done.returncode:
            *_, said = done.stderr.decode(errors="replace").strip().splitlines() or ["no reason given"]
            raise ViewerError(f"FFmpeg failed: {said}; write a .gif")
        data = film.read_bytes()
    write_atomically(path, data)
