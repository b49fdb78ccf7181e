"""Colour quantization: a palette for the textures and vertex colours of a scene, in native code (src/colour/palette.h).

Colours are grouped in sRGB, which is nearly uniform to the eye. Each entry is the mean, in linear light, of the colours
of its group.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import _native

if TYPE_CHECKING:
    from numpy.typing import NDArray


def quantize(
    colours: NDArray[np.uint8], weights: NDArray[np.float64], count: int
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Choose at most `count` colours, 1 … 255, that represent `colours`, deterministically.

    `colours` are uint8, shape (N, 3), sRGB; `weights`, float64, shape (N,), are the areas that each covers. Where there
    are no more than `count` distinct colours, each is its own entry. Return the palette (uint8, shape (K, 3),
    ascending) and each colour's entry (uint8, shape (N,)).
    """
    return _native.quantize(np.ascontiguousarray(colours), np.ascontiguousarray(weights, np.float64), count)
