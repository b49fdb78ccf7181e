"""The filters of meshopt's attribute streams: what decoded elements stand for (appendix B of the extensions)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def _unfiltered(elements: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return elements


def _octahedral(elements: NDArray[np.uint8]) -> NDArray[np.int8] | NDArray[np.int16]:
    """Unfold unit vectors from the octahedron that they were folded onto; the fourth component stays."""
    stored: NDArray[np.int8] | NDArray[np.int16] = elements.view("<i1" if elements.shape[1] == 4 else "<i2")
    wide = stored.astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        x, y = wide[:, 0] / wide[:, 2], wide[:, 1] / wide[:, 2]
        z = 1.0 - np.abs(x) - np.abs(y)
        fold = np.minimum(z, 0.0)
        unit = np.stack([x - np.copysign(fold, x), y - np.copysign(fold, y), z], axis=1)
        unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    decoded = stored.copy()
    decoded[:, :3] = _rounded(unit, np.iinfo(stored.dtype).max)
    return decoded


def _quaternion(elements: NDArray[np.uint8]) -> NDArray[np.int16]:
    """Complete unit quaternions from their three smaller components."""
    stored = elements.view("<i2").astype(np.int64)
    one = (stored[:, 3] | 3).astype(np.float64)
    small = stored[:, :3] / one[:, None] * np.sqrt(0.5)
    largest = np.sqrt(np.maximum(0.0, 1.0 - (small**2).sum(axis=1)))
    decoded = np.empty(stored.shape, "<i2")
    rows = np.arange(len(stored))
    for step, component in enumerate((*small.T, largest), start=1):
        decoded[rows, ((stored[:, 3] & 3) + step) % 4] = _rounded(component, 32767)
    return decoded


def _exponential(elements: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Make floating-point numbers of 24 bits of mantissa and 8 of exponent."""
    stored = elements.view("<i4").astype(np.int64)
    exponent, mantissa = stored >> 24, ((stored & 0xFFFFFF) ^ 0x800000) - 0x800000
    with np.errstate(over="ignore", under="ignore"):
        numbers: NDArray[np.float32] = np.ldexp(mantissa.astype(np.float64), exponent).astype("<f4")
    return numbers


def _rounded(values: NDArray[np.float64], scale: int) -> NDArray[np.float64]:
    """Round to whole numbers of 1 / `scale`, halves away from 0; what is not a number becomes 0."""
    scaled = np.nan_to_num(np.clip(values, -1.0, 1.0)) * scale
    return np.copysign(np.floor(np.abs(scaled) + 0.5), scaled)


def _colour(elements: NDArray[np.uint8]) -> NDArray[np.uint8] | NDArray[np.uint16]:
    """Make red, green, blue and alpha of Y, Co, Cg and an alpha whose highest bit tells how many bits they have."""
    bits = 8 if elements.shape[1] == 4 else 16
    stored = elements.view(f"<i{bits // 8}").astype(np.int64)
    luma, orange, green = (stored[:, 0] & (1 << bits) - 1), stored[:, 1], stored[:, 2]
    marked = stored[:, 3] & (1 << bits) - 1
    most = np.full(len(stored), 1)  # all bits of a component: at least that of the marker
    for bit in range(bits):
        most = np.where(marked >> bit > 0, (2 << bit) - 1, most)
    alpha = marked & most >> 1
    alpha = alpha << 1 | alpha & 1
    channels = np.stack([luma + orange - green, luma + green, luma - orange - green, alpha], axis=1)
    scaled = np.floor(channels * (((1 << bits) - 1) / most)[:, None] + 0.5)
    return np.clip(scaled, 0, (1 << bits) - 1).astype(f"<u{bits // 8}")


FILTERS = {
    "NONE": _unfiltered,
    "OCTAHEDRAL": _octahedral,
    "QUATERNION": _quaternion,
    "EXPONENTIAL": _exponential,
    "COLOR": _colour,
}
"""By name: each takes decoded elements, uint8, shape (N, bytes), and returns an array of as many bytes."""

SIZES = {
    "NONE": range(4, 257, 4),
    "OCTAHEDRAL": (4, 8),
    "QUATERNION": (8,),
    "EXPONENTIAL": range(4, 257, 4),
    "COLOR": (4, 8),
}
"""By name: how many bytes an element may have."""
