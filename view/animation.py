"""Pictures one after another: GIF and WebP by Pillow, MP4 by FFmpeg where imageio-ffmpeg brings it."""

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

ANIMATION_SUFFIXES = (".gif", ".webp", ".mp4")
PICTURES_A_SECOND = 20

_QUALITY, _EFFORT = 90, 2  # of WebP: more effort takes minutes
_FEW_COLOURS = 255
_PALETTE_PICTURES = 8  # of an animation that give its palette


def write_animation(path: Path, pictures: Iterable[NDArray[np.uint8]], period: float | None = None) -> None:
    """Write pictures as an animation that plays for ever (GIF, WebP) or once (MP4).

    They are uint8, shape (H, W, 3), sRGB, one or more, all of one size; for MP4 of even sides. `period` is the seconds
    from one to the next, in steps of 1/100; None for that of :data:`PICTURES_A_SECOND`. ViewerError for MP4 without
    imageio-ffmpeg; OSError where the file cannot be written.
    """
    milliseconds = 1000 // PICTURES_A_SECOND if period is None else max(20, 10 * round(100 * period))
    if path.suffix.lower() == ".mp4":
        _write_mp4(path, pictures, milliseconds)
    elif path.suffix.lower() == ".webp":
        first, *others = [Image.fromarray(picture) for picture in pictures]
        encoded = io.BytesIO()
        shared = {"quality": _QUALITY, "method": _EFFORT, "duration": milliseconds, "loop": 0}
        first.save(encoded, "WEBP", save_all=True, append_images=others, **shared)
        write_atomically(path, encoded.getvalue())
    else:
        _write_gif(path, pictures, milliseconds)


def _write_gif(path: Path, pictures: Iterable[NDArray[np.uint8]], milliseconds: int) -> None:
    images = [Image.fromarray(picture) for picture in pictures]
    palette = _palette(images)
    frames = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    encoded = io.BytesIO()
    frames[0].save(encoded, "GIF", save_all=True, append_images=frames[1:], duration=milliseconds, loop=0)
    write_atomically(path, encoded.getvalue())


def _palette(images: list[Image.Image]) -> Image.Image:
    """Make one palette for all pictures, so that what stays keeps its colours: exact where 255 colours are enough."""
    seen: set[int] = set()
    for image in images:
        found = image.getcolors(_FEW_COLOURS)
        if found is None or len(seen) > _FEW_COLOURS:
            break
        seen |= {int.from_bytes(bytes(colour), "big") for _, colour in found}  # type: ignore[arg-type]
    else:
        if len(seen) <= _FEW_COLOURS:
            exact = Image.new("P", (1, 1))
            exact.putpalette(b"".join(colour.to_bytes(3, "big") for colour in sorted(seen)))
            return exact
    width, height = images[0].size
    step = max(1, len(images) // _PALETTE_PICTURES)
    some = images[::step]
    strip = Image.new("RGB", (width, height * len(some)))
    for row, image in enumerate(some):
        strip.paste(image, (0, row * height))
    return strip.quantize(_FEW_COLOURS, method=Image.Quantize.MEDIANCUT)


def _write_mp4(path: Path, pictures: Iterable[NDArray[np.uint8]], milliseconds: int) -> None:
    try:
        ffmpeg = import_module("imageio_ffmpeg")
    except ImportError as error:
        raise ViewerError(
            "MP4 needs imageio-ffmpeg, which is not installed; pip install imageio-ffmpeg, or write a .gif"
        ) from error
    first, *others = pictures
    height, width = first.shape[:2]
    rate = f"{1000 / milliseconds:g}"
    pixels = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", rate, "-i", "-")
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
            *_, last_line = done.stderr.decode(errors="replace").strip().splitlines() or ["no reason given"]
            raise ViewerError(f"FFmpeg failed: {last_line}; write a .gif")
        data = film.read_bytes()
    write_atomically(path, data)
