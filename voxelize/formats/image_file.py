"""Image files, decoded by Pillow."""

from __future__ import annotations

import io
import struct
import warnings
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

MOST_PIXELS = 1 << 26
"""8192 x 8192: a file of a few hundred bytes can claim far more."""

_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TGA", "TIFF", "GIF")

# What Pillow's decoders raise on broken images.
_BROKEN = (OSError, SyntaxError, ValueError, EOFError, IndexError, struct.error)


def read_image(file: Path, path: Path, place: str) -> NDArray[np.uint8]:
    """Read an image file as :func:`decode_image` does."""
    try:
        data = file.read_bytes()
    except OSError as error:
        problem = f"cannot be read: {error.strerror}"
        raise AssetError(path, problem, place=place, fix="check its permissions") from None
    return decode_image(data, path, place)


def decode_image(data: bytes, path: object, place: str) -> NDArray[np.uint8]:
    """Decode an image file to uint8, shape (H, W, 4): sRGB colour and linear alpha; row 0 is the top.

    Raise AssetError where the image is broken, of an unknown kind, or larger than :data:`MOST_PIXELS`; `path` is the
    asset, and `place` where it refers to the image.
    """
    from PIL import Image  # noqa: PLC0415 - many files have no images, and it is slow to import

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # the limit below replaces Pillow's
            with Image.open(io.BytesIO(data), formats=_FORMATS) as opened:
                if opened.width * opened.height > MOST_PIXELS:
                    raise Image.DecompressionBombError  # noqa: TRY301 -- Pillow raises it from twice its own limit
                if opened.mode.startswith("I"):  # 16 bits of grey, which Pillow would clip
                    grey = (np.asarray(opened).astype(np.uint32) >> 8).astype(np.uint8)
                    return np.dstack([grey, grey, grey, np.full_like(grey, 255)])
                return np.array(opened.convert("RGBA"))
    except Image.DecompressionBombError:
        raise AssetError(
            path, f"the image has more than {MOST_PIXELS:,} pixels", place=place, fix="scale it down"
        ) from None
    except _BROKEN as error:
        problem = f"the image cannot be decoded ({type(error).__name__})"
        raise AssetError(path, problem, place=place, fix="save the image again as PNG or JPEG") from None
