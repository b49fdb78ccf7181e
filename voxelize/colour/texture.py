"""Textures: images that colour surfaces, looked up in linear light."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from voxrt.voxelize import arguments
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8, srgb_from_linear

if TYPE_CHECKING:
    from numpy.typing import NDArray

Wrap: TypeAlias = Literal["repeat", "mirror", "clamp"]

WRAPS: tuple[Wrap, ...] = ("repeat", "mirror", "clamp")

_STRIP = 1 << 22  # pixels
_LINEAR = LINEAR_OF_SRGB8.astype(np.float32)
_SHARE = (np.arange(256) / 255).astype(np.float32)


@dataclass(frozen=True, eq=False, slots=True)
class Texture:
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
    >>> look_up(texture, np.array([[0.5, 0.5]]))
    array([[1., 1., 1., 1.]])
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
        object.__setattr__(self, "pixels", pixels)
        object.__setattr__(self, "wrap", wrap)
        object.__setattr__(self, "nearest", arguments.flag("Texture.nearest", self.nearest))

    def __repr__(self) -> str:
        height, width = self.pixels.shape[:2]
        return f"Texture(width={width}, height={height}, wrap={self.wrap}, nearest={self.nearest})"


def look_up(texture: Texture, uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the linear colour and alpha, float64, shape (N, 4), of a texture at `uv`, float64, shape (N, 2)."""
    height, width = texture.pixels.shape[:2]
    x = _wrapped(uv[:, 0], texture.wrap[0]) * width
    y = _wrapped(uv[:, 1], texture.wrap[1]) * height
    if texture.nearest:
        rows, columns = _rows(np.floor(y).astype(np.int64), texture), _columns(np.floor(x).astype(np.int64), texture)
        return _pixels(texture, rows + columns)
    left, top = np.floor(x - 0.5).astype(np.int64), np.floor(y - 0.5).astype(np.int64)
    right_share, bottom_share = (x - 0.5 - left)[:, None], (y - 0.5 - top)[:, None]
    rows, below = _rows(top, texture), _rows(top + 1, texture)
    columns, beside = _columns(left, texture), _columns(left + 1, texture)
    upper = _pixels(texture, rows + columns)
    upper += (_pixels(texture, rows + beside) - upper) * right_share
    lower = _pixels(texture, below + columns)
    lower += (_pixels(texture, below + beside) - lower) * right_share
    lower -= upper
    lower *= bottom_share
    upper += lower
    return upper


def halved(texture: Texture) -> Texture:
    """Return a texture with half as many pixels per side, each the mean of 2 by 2, rounded to 8 bits.

    The mean is taken in linear light and weighted by alpha, so that transparent pixels do not change the colour.
    """
    height, width = texture.pixels.shape[:2]
    pixels = np.pad(texture.pixels, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
    strip = max(2, _STRIP // width // 2 * 2)  # rows, to limit the memory
    strips = [_halved(pixels[top : top + strip]) for top in range(0, len(pixels), strip)]
    return Texture(np.concatenate(strips), texture.wrap)


@cache
def _srgb_of_16_bits() -> NDArray[np.uint8]:
    return srgb_from_linear(np.arange(1 << 16) / 65535)


def _halved(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    mixed = np.full((len(pixels) // 2, pixels.shape[1] // 2, 4), 255, np.uint8)
    opaque = bool((pixels[:, :, 3] == 255).all())
    share = _SHARE[pixels[:, :, 3]] if not opaque else np.ones((2, 2), np.float32)
    alpha = _mean(share)
    srgb = _srgb_of_16_bits()
    for channel in range(3):
        linear = _LINEAR[pixels[:, :, channel]]
        mean = _mean(linear)
        if not opaque:
            np.divide(_mean(linear * share), alpha, out=mean, where=alpha > 0)
        mixed[:, :, channel] = srgb[(mean * 65535 + np.float32(0.5)).astype(np.uint16)]
    if not opaque:
        mixed[:, :, 3] = np.floor(alpha * 255 + 0.5)
    return mixed


def _mean(plane: NDArray[np.float32]) -> NDArray[np.float32]:
    pairs = plane[0::2] + plane[1::2]
    mean: NDArray[np.float32] = (pairs[:, 0::2] + pairs[:, 1::2]) * np.float32(0.25)
    return mean


def _wrapped(coordinate: NDArray[np.float64], wrap: Wrap) -> NDArray[np.float64]:
    """Return coordinates wrapped into 0 … 1, or 0 … 2 for mirrored ones; exact for coordinates of any size."""
    if wrap == "clamp":
        return np.nan_to_num(np.clip(coordinate, 0.0, 1.0))
    with np.errstate(invalid="ignore"):
        return np.nan_to_num(coordinate - np.floor(coordinate) if wrap == "repeat" else np.mod(coordinate, 2.0))


def _pixels(texture: Texture, places: NDArray[np.int64]) -> NDArray[np.float64]:
    stored = np.ascontiguousarray(texture.pixels).view(np.uint32).reshape(-1)[places].view(np.uint8).reshape(-1, 4)
    linear: NDArray[np.float64] = LINEAR_OF_SRGB8[stored]
    linear[:, 3] = stored[:, 3] / 255.0
    return linear


def _rows(y: NDArray[np.int64], texture: Texture) -> NDArray[np.int64]:
    height, width = texture.pixels.shape[:2]
    return _index(y, height, texture.wrap[1]) * np.int64(width)


def _columns(x: NDArray[np.int64], texture: Texture) -> NDArray[np.int64]:
    return _index(x, texture.pixels.shape[1], texture.wrap[0])


def _index(pixel: NDArray[np.int64], size: int, wrap: Wrap) -> NDArray[np.int64]:
    """Return pixel indices wrapped into the image; they are -1 … size, or up to twice the size for mirrored ones."""
    if wrap == "clamp":
        clipped: NDArray[np.int64] = np.clip(pixel, 0, size - 1)
        return clipped
    if wrap == "repeat":
        found: NDArray[np.int64] = np.where(pixel < 0, pixel + size, np.where(pixel >= size, pixel - size, pixel))
        return found
    turned = np.mod(pixel, 2 * size)
    mirrored: NDArray[np.int64] = np.minimum(turned, 2 * size - 1 - turned)
    return mirrored
