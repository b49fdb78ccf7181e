"""Textures: images that colour surfaces, looked up in linear light (src/colour/texture.h)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize import _native

Wrap: TypeAlias = Literal["repeat", "mirror", "clamp"]

WRAPS: tuple[Wrap, ...] = ("repeat", "mirror", "clamp")


class Texture(Value, frozen=True, eq=False):
    """An image that colours surfaces.

    Attributes
    ----------
    pixels
        uint8, shape (H, W, 4): sRGB colour and linear alpha. Row 0 is at v = 0, column 0 at u = 0.
    wrap
        How texture coordinates outside 0 … 1 are treated, along u and along v: the image repeats, is mirrored, or its
        border continues (``"clamp"``).
    nearest
        Whether a sample takes the nearest pixel's colour instead of mixing four.

    Raises
    ------
    TypeError, ValueError
        Pixels of another shape or range, or another wrap mode.

    Examples
    --------
    >>> texture = Texture(np.full((2, 2, 4), 255, np.uint8), ("clamp", "clamp"))
    >>> texture
    Texture(width=2, height=2, wrap=('clamp', 'clamp'), nearest=False)
    """

    pixels: NDArray[np.uint8]
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")
    nearest: bool = False

    def __post_init__(self) -> None:
        pixels = arguments.whole_array("Texture.pixels", self.pixels, ("H", "W", 4), np.uint8, low=0, high=255)
        if not pixels.size:
            raise ValueError(f"Texture.pixels must hold one pixel or more, not {pixels.shape}")
        wrap = tuple(arguments.choice("Texture.wrap", one, WRAPS) for one in self.wrap)
        if len(wrap) != 2:
            raise ValueError(f"Texture.wrap must be two modes, for u and v, not {len(wrap)}")
        force_setattr(self, "pixels", pixels)
        force_setattr(self, "wrap", wrap)
        force_setattr(self, "nearest", arguments.flag("Texture.nearest", self.nearest))

    def __repr__(self) -> str:
        height, width = self.pixels.shape[:2]
        return f"Texture(width={width}, height={height}, wrap={self.wrap}, nearest={self.nearest})"

    def arrays(self) -> _native.TextureArrays:
        """Return the texture as native code takes it."""
        along_u, along_v = (WRAPS.index(one) for one in self.wrap)
        return np.ascontiguousarray(self.pixels), along_u, along_v, self.nearest
