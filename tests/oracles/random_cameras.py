"""Worlds and cameras by chance, of the kinds that find mistakes."""

from __future__ import annotations

import numpy as np


def random_voxels(rng, depth, density):
    """A world of boxes and single voxels: octants of every size, solid and empty."""
    side = 1 << depth
    voxels = np.zeros((side,) * 3, np.uint8)
    for _ in range(int(rng.integers(0, 4))):
        low = rng.integers(0, side, 3)
        high = np.minimum(low + rng.integers(1, side + 1, 3), side)
        voxels[low[0] : high[0], low[1] : high[1], low[2] : high[2]] = rng.integers(0, 256)
    sprinkled = rng.random(voxels.shape) < density
    voxels[sprinkled] = rng.integers(0, 256, int(sprinkled.sum()))
    return voxels


def random_camera(rng, side):
    """Cameras that like trouble: on planes, edges and corners, along axes and diagonals, inside, far outside."""
    world = 16 * side
    position = [
        int(rng.choice([rng.integers(0, side + 1) * 16, rng.integers(-world, 2 * world), 0, world, -1, world - 1]))
        for _ in range(3)
    ]
    kind = rng.integers(4)
    scale = int(rng.choice([1, 3, 1000, 12000]))  # directions stay below 2**20
    if kind == 0:
        frame = rng.integers(-2, 3, (3, 3)) * scale
    elif kind == 1:
        frame = rng.permutation(np.diag(rng.choice([-scale, scale], 3)))
        frame[0] *= int(rng.integers(0, 2))
    elif kind == 2:
        frame = rng.integers(-scale, scale + 1, (3, 3))
    else:
        frame = np.zeros((3, 3), int)
        frame[0] = [side * 8 - p for p in position]
        frame[1:] = rng.integers(-side, side + 1, (2, 3))
    return np.array([position, *np.clip(frame, -32768, 32767)], np.int32)
