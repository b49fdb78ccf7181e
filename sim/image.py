"""Frames as picture files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export.atomic import write_atomically
from voxrt.octree.notebook import encode_png

if TYPE_CHECKING:
    import os

    import numpy as np
    from numpy.typing import NDArray


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
