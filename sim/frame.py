"""A rendered frame and what it cost."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.sim.image import encode_png, save_png, show_picture
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

    from voxrt.sim.external_memory import CacheCost

FACE_NONE = 3
"""The face of a pixel whose ray crossed none: a miss, or a camera inside a solid."""


class RenderCost(Value, frozen=True):
    """What a frame cost.

    Attributes
    ----------
    rays
        Rays traced: one per pixel and sample. Those of mirrors and shadows are not counted.
    words_read
        Octree words read; None for the model, which reads one word for many rays.
    cycles
        Clock cycles from the start of the frame to its last pixel; None for the model, which has no clock.
    seconds
        Wall seconds.
    cache
        What it cost at the caches; None without caches.
    """

    rays: int
    words_read: int | None
    cycles: int | None
    seconds: float
    cache: CacheCost | None = None


class Frame(Value, frozen=True, eq=False):
    """A rendered picture; row 0 is the top. A notebook shows it.

    Attributes
    ----------
    colour
        uint8, shape (H, W, 3), sRGB; on a transparent background (H, W, 4), with the opacity.
    material
        uint8, shape (H, W): the material hit, 0 for a miss.
    face
        uint8, shape (H, W): axis of the face crossed (0 x, 1 y, 2 z) or :data:`FACE_NONE`.
    cost
        Rays, words, cycles and seconds.

    Examples
    --------
    >>> import voxrt
    >>> frame = voxrt.render(voxrt.build("examples/house.obj", depth=4).rom, size=(64, 48))
    >>> frame
    <Frame: 64x48 pixels, 5 materials>
    >>> frame.save("house.png")
    """

    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cost: RenderCost

    def __repr__(self) -> str:
        height, width = self.material.shape
        seen = np.count_nonzero(np.unique(self.material))
        cycles = "" if self.cost.cycles is None else f", {self.cost.cycles / self.cost.rays:.2f} cycles per ray"
        return f"<Frame: {width}x{height} pixels, {seen} {'material' if seen == 1 else 'materials'}{cycles}>"

    def _repr_png_(self) -> bytes:
        return encode_png(self.colour)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture as a PNG file, and make its folder. An interruption leaves the old file or the new one.

        Raises
        ------
        OutputError
            The file cannot be written.
        """
        save_png(path, self.colour)

    def show(self) -> None:
        """Show the picture in the notebook's cell, or in the program that opens pictures.

        Raises
        ------
        SimulatorError
            There is no such program.
        """
        show_picture(self.colour)
