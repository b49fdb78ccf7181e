"""Frames as picture files."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export.atomic import write_atomically

if TYPE_CHECKING:
    import os

    import numpy as np
    from numpy.typing import NDArray


def encode_png(colour: NDArray[np.uint8]) -> bytes:
    """Return a picture, as :func:`write_png` takes it, as the bytes of a PNG file. Equal pixels give equal bytes."""
    from PIL import Image  # noqa: PLC0415 - slow to import, and pictures are rare

    encoded = io.BytesIO()
    Image.fromarray(colour).save(encoded, format="PNG")
    return encoded.getvalue()


def write_png(path: str | os.PathLike[str], colour: NDArray[np.uint8]) -> None:
    """Write a picture as a PNG file. An interruption leaves the old file or the new one.

    Parameters
    ----------
    path
        The file, in a folder that exists.
    colour
        uint8, shape (H, W, 3), sRGB, or (H, W, 4) with the opacity. Equal pixels give equal bytes.

    Raises
    ------
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import numpy as np
    >>> write_png("black.png", np.zeros((48, 64, 3), np.uint8))
    """
    write_atomically(Path(path), encode_png(colour))
