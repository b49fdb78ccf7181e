"""Frames as picture files."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

if TYPE_CHECKING:
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
    target = Path(path)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".tmp")
    unfinished = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            Image.fromarray(colour, "RGB").save(file, format="PNG")
        umask = os.umask(0)
        os.umask(umask)
        unfinished.chmod(0o666 & ~umask)  # mkstemp makes files that only their owner reads
        unfinished.replace(target)
    finally:
        unfinished.unlink(missing_ok=True)
