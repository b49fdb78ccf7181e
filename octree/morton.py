"""Morton order, that of the octants: bit 3k is bit k of x, bit 3k+1 of y, bit 3k+2 of z."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SPREADS = ((16, 0x0000FF0000FF), (8, 0x00F00F00F00F), (4, 0x0C30C30C30C3), (2, 0x249249249249))


def morton(voxels: NDArray[np.int64]) -> NDArray[np.int64]:
    """Interleave 16 bits of each of x, y, z (shape (N, 3)), x lowest, as octant indices do."""
    code = np.zeros(len(voxels), np.int64)
    for axis in range(3):
        spread = voxels[:, axis].copy()
        for shift, mask in _SPREADS:
            spread = (spread | spread << shift) & mask
        code |= spread << axis
    return code


def positions(codes: NDArray[np.int64], bits: int = 16) -> NDArray[np.int32]:
    """Return the voxels of such codes, of so many bits per axis: int32, shape (N, 3)."""
    found = np.zeros((len(codes), 3), np.int32)
    for bit in range(bits):
        for axis in range(3):
            found[:, axis] |= (codes >> (3 * bit + axis) & 1).astype(np.int32) << bit
    return found
