"""Pictures as PNG files, and in a window or a notebook."""

from __future__ import annotations

import io
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export.atomic import write_atomically
from voxrt.export.outputs import check_file, writing
from voxrt.sim.errors import SimulatorError

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


def save_png(path: str | os.PathLike[str], colour: NDArray[np.uint8]) -> None:
    """Write a picture as :func:`write_png` does, and make its folder; OutputError if that is not possible.

    Examples
    --------
    >>> import numpy as np
    >>> save_png("pictures/black.png", np.zeros((48, 64, 3), np.uint8))
    """
    path = Path(path)
    check_file(path)
    with writing(path):
        write_png(path, colour)


def show_picture(colour: NDArray[np.uint8]) -> None:
    """Show a picture in the notebook's cell, or in the program that opens pictures.

    SimulatorError if there is no such program.
    """
    from PIL import Image, ImageShow  # noqa: PLC0415 - as above

    ipython = sys.modules.get("IPython")
    if ipython is not None and hasattr(ipython.get_ipython(), "kernel"):
        ipython.display.display(ipython.display.Image(data=encode_png(colour)))
    elif not ImageShow.show(Image.fromarray(colour)):
        raise SimulatorError("no program here shows pictures; write a file: save('picture.png')")
