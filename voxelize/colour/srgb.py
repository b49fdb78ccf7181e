"""Conversion between linear light and sRGB, by the exact curve, in native code (src/colour/srgb.h).

Source: IEC 61966-2-1:1999, with its amendment's thresholds 0.0031308 and 0.04045.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import _native

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def srgb_from_linear(linear: ArrayLike) -> NDArray[np.uint8]:
    """Encode linear light, any shape, as sRGB of 8 bits, clipped to 0 … 1 first and rounded to the nearest (halves up).

    >>> srgb_from_linear([0.0, 0.5, 1.0])
    array([  0, 188, 255], dtype=uint8)
    """
    light = np.asarray(linear, np.float64)
    return _native.srgb_from_linear(np.ascontiguousarray(light).reshape(-1)).reshape(light.shape)


def linear_from_srgb(srgb: ArrayLike) -> NDArray[np.float64]:
    """Decode sRGB of 8 bits (any shape) to linear light, float64, 0 … 1."""
    return LINEAR_OF_SRGB8[np.asarray(srgb, np.uint8)]


def linear_from_hex(name: str, value: str) -> tuple[float, float, float]:
    """Decode a colour like ``#9db4d0`` to linear light; `name` is the argument's, for errors.

    >>> linear_from_hex("sky", "#ff0000")
    (1.0, 0.0, 0.0)
    """
    digits = value[1:]
    if not (len(value) == 7 and value[0] == "#" and all(one in "0123456789abcdefABCDEF" for one in digits)):
        raise ValueError(f"{name} must be a colour like '#9db4d0', not {value!r}")
    red, green, blue = linear_from_srgb(np.frombuffer(bytes.fromhex(digits), np.uint8)).tolist()
    return red, green, blue


LINEAR_OF_SRGB8: NDArray[np.float64] = _native.linear_of_srgb()
"""float64, shape (256,): the linear light of each 8-bit sRGB value."""
