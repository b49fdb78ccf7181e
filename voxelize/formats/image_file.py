"""Image files, decoded by Pillow."""

from __future__ import annotations

import io
import struct
import warnings
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import LFS_POINTER

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.warning_log import WarningLog

MOST_PIXELS = 1 << 26
"""8192 x 8192: a file of a few hundred bytes can claim far more."""

_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TGA", "TIFF", "GIF")

INSTEAD = "; its material's own value was used"
"""What stands in place of a texture that is not read."""

_SAVE = "save it as PNG or JPEG"
_OTHERS = (
    (LFS_POINTER, "is a Git LFS pointer", "run: git lfs pull"),
    (b"DDS ", "is a DDS file", _SAVE),
    (b"\x76\x2f\x31\x01", "is an OpenEXR file", _SAVE),
    (b"#?", "is a Radiance HDR file", _SAVE),
    (b"\xabKTX", "is a KTX file", _SAVE),
    (b"8BPS", "is a Photoshop file", _SAVE),
    (b"<svg", "is an SVG file", _SAVE),
)
"""How files begin that are no images to read, what they are, and what to do."""

_UNKNOWN = ("is broken or of an unknown kind", "save it again as PNG or JPEG")

# What Pillow's decoders raise on broken images.
_BROKEN = (OSError, SyntaxError, ValueError, EOFError, IndexError, struct.error)


def read_image(file: Path, path: Path, place: str, log: WarningLog, faces: int = 1) -> NDArray[np.uint8] | None:
    """Read an image file as :func:`decode_image` does."""
    try:
        data = file.read_bytes()
    except OSError as error:
        problem = f"cannot be read: {error.strerror}"
        raise AssetError(path, problem, place=place, fix="check its permissions") from None
    return decode_image(data, path, place, log, faces)


def decode_image(data: bytes, path: object, place: str, log: WarningLog, faces: int = 1) -> NDArray[np.uint8] | None:
    """Decode an image file to uint8, shape (H, W, 4): sRGB colour and linear alpha; row 0 is the top.

    Return None, with a warning for so many faces, where the image is broken or of a kind that is not read. Raise
    AssetError where it is larger than :data:`MOST_PIXELS`; `path` is the asset, and `place` where it refers to the
    image.
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
    except _BROKEN:
        what, fix = next((words for start, *words in _OTHERS if data.startswith(start)), _UNKNOWN)
        log.add("texture", f"{place}: the image {what} and was not read{INSTEAD}: {fix}", faces)
        return None
