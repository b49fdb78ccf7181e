"""Frames as picture files."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

from voxrt.export.atomic import write_atomically

if TYPE_CHECKING:
    import os

    import numpy as np
    from numpy.typing import NDArray


def encode_png(colour: NDArray[np.uint8]) -> bytes:
    """Encode a picture (uint8, shape (H, W, 3), sRGB) as a PNG file's bytes: the same pixels give the same bytes."""
    encoded = io.BytesIO()
    Image.fromarray(colour, "RGB").save(encoded, format="PNG")
    return encoded.getvalue()


def write_png(path: str | os.PathLike[str], colour: NDArray[np.uint8]) -> None:
    """Write a picture, all of it or nothing: an interrupted write leaves the old file.

    Parameters
    ----------
    path
        Where to; the folder exists.
    colour
        uint8, shape (H, W, 3), sRGB. The same pixels give the same bytes.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    write_atomically(Path(path), encode_png(colour))
