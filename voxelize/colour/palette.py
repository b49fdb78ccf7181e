"""Colour quantization: a palette for the textures and vertex colours of a scene.

Pillow chooses the groups in sRGB, which is nearly uniform to the eye: maximum coverage, refined by k-means. (Its median
cut misses clusters when entries are few.) Each entry is then the mean, in linear light, of the colours of its group.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.srgb import linear_from_srgb, srgb_from_linear

if TYPE_CHECKING:
    from numpy.typing import NDArray

_PIXELS = 1 << 14
_FEW = 1 << 16
_UNTIL_CHANGES = 1
# Beyond this many colours, k-means works at 5 bits per channel: it is slow, and entries are farther apart than that.
_DISTINCT = 1 << 13
_COARSE, _MIDDLE = np.uint32(0xF8F8F8), np.uint32(0x040404)


def quantize(
    colours: NDArray[np.uint8], weights: NDArray[np.float64], count: int
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Choose at most `count` colours that represent `colours`, deterministically.

    Where there are no more than `count` distinct colours, each is its own entry.

    Parameters
    ----------
    colours
        uint8, shape (N, 3): sRGB.
    weights
        float64, shape (N,), not negative: the area that each covers.
    count
        The most entries of the palette, 1 … 255.

    Returns
    -------
    palette, rows
        uint8, shape (K, 3), sRGB, in ascending order; and uint8, shape (N,): each colour's entry.
    """
    packed, inverse = _distinct(_packed(colours))
    if len(packed) <= count:
        return _unpacked(packed), inverse.astype(np.uint8)
    coarse, cells = packed, np.arange(len(packed))
    if len(packed) > _DISTINCT:
        coarse, cells = np.unique(packed & _COARSE | _MIDDLE, return_inverse=True)
    cover = np.bincount(inverse, weights, minlength=len(packed))
    groups = _grouped(_unpacked(coarse), np.bincount(cells, cover).astype(np.float64), count)[cells]
    total = np.bincount(groups, cover)
    cover = np.where(total[groups] > 0, cover, 1.0)  # a group of no area has a mean too
    linear = linear_from_srgb(_unpacked(packed))
    means = np.stack([np.bincount(groups, cover * linear[:, channel]) for channel in range(3)], axis=1)
    entries, merged = np.unique(
        _packed(srgb_from_linear(means / np.bincount(groups, cover)[:, None])), return_inverse=True
    )
    return _unpacked(entries), merged[groups].astype(np.uint8)[inverse]


def _distinct(packed: NDArray[np.uint32]) -> tuple[NDArray[np.uint32], NDArray[np.int32]]:
    """Return the distinct colours in ascending order, and the index of each colour among them."""
    if len(packed) < _FEW:
        found, places = np.unique(packed, return_inverse=True)
        return found, places.astype(np.int32)
    seen = np.zeros(1 << 24, np.bool_)
    seen[packed] = True
    found = np.flatnonzero(seen).astype(np.uint32)
    place_of = np.empty(1 << 24, np.int32)
    place_of[found] = np.arange(len(found), dtype=np.int32)
    return found, place_of[packed]


def _packed(srgb: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """Pack rows of red, green and blue into one number each, in the same order."""
    wide = srgb.astype(np.uint32)
    packed: NDArray[np.uint32] = wide[:, 0] << np.uint32(16) | wide[:, 1] << np.uint32(8) | wide[:, 2]
    return packed


def _unpacked(packed: NDArray[np.uint32]) -> NDArray[np.uint8]:
    return np.stack([packed >> 16 & 255, packed >> 8 & 255, packed & 255], axis=1).astype(np.uint8)


def _grouped(distinct: NDArray[np.uint8], weights: NDArray[np.float64], count: int) -> NDArray[np.int64]:
    """Return the group of each of the `distinct` colours: at most `count` groups, numbered from 0 without gaps."""
    from PIL import Image  # noqa: PLC0415 - slow to import, and few assets have so many colours

    share = weights / max(float(weights.sum()), np.finfo(np.float64).tiny)
    repeats = np.maximum(1, np.round(share * _PIXELS)).astype(np.int64)
    pixels = np.repeat(distinct, repeats, axis=0)[None]
    image = Image.fromarray(np.ascontiguousarray(pixels))
    reduced = image.quantize(count, Image.Quantize.MAXCOVERAGE, kmeans=_UNTIL_CHANGES, dither=Image.Dither.NONE)
    first = np.cumsum(repeats) - repeats
    _, groups = np.unique(np.asarray(reduced)[0, first], return_inverse=True)
    return groups.reshape(-1)
