"""Rays that look for trouble: ties, planes, edges, corners, dead axes, far and flat ones."""

from __future__ import annotations

import numpy as np


def adversarial_rays(side, count, seed):
    """Give origins (N, 3) in 1/16 voxel and directions (N, 3), int32, for a world of `side` voxels."""
    rng = np.random.default_rng(seed)
    world = 16 * side
    origins = rng.integers(-world // 2, world + world // 2, (count, 3))
    directions = rng.integers(-(1 << 20) + 1, 1 << 20, (count, 3))

    kind = rng.integers(0, 8, (count, 1))
    small = rng.integers(-4, 5, (count, 3))
    powers = np.sign(small) << rng.integers(0, 20, (count, 3))
    lonely = np.zeros((count, 3), np.int64)
    lonely[np.arange(count), rng.integers(0, 3, count)] = rng.choice([-1, 1], count) * rng.integers(1, 1 << 20, count)
    diagonal = rng.choice([-1, 0, 1], (count, 3)) * rng.integers(1, 1 << 20, (count, 1))
    flat = directions >> np.where(rng.random((count, 3)) < 0.5, 18, 0)
    largest = rng.choice([-(1 << 20) + 1, -1, 0, 1, (1 << 20) - 1], (count, 3))
    directions = np.select(
        [kind == 0, kind == 1, kind == 2, kind == 3, kind == 4, kind == 5],
        [small, powers, lonely, diagonal, flat, largest],
        directions,
    )

    place = rng.integers(0, 5, (count, 1))
    on_planes = origins // 16 * 16
    on_some = np.where(rng.random((count, 3)) < 0.5, on_planes, origins)
    on_world = rng.choice([0, world, world // 2], (count, 3))
    # Aimed so that the ray meets a corner of the grid after whole steps.
    corners = rng.integers(0, side + 1, (count, 3)) * 16 - small * rng.integers(0, 2 * side, (count, 1)) * 4
    aimed = (place == 3) & (kind == 0)
    origins = np.select([place == 0, place == 1, place == 2, aimed], [on_planes, on_some, on_world, corners], origins)
    return origins.astype(np.int32), directions.astype(np.int32)


def adversarial_cameras(side, count, seed):
    """Give registers (N, 4, 3), int32, for frames up to 48 x 36 pixels of a world of `side` voxels."""
    rng = np.random.default_rng(seed)
    positions, _ = adversarial_rays(side, count, seed)
    shape = (count, 3, 3)
    small = rng.integers(-3, 4, shape)
    look_along_an_axis = np.zeros(shape, np.int64)
    signs = rng.choice([-1, 1], (count, 3))
    for i, order in enumerate(rng.permuted(np.tile(np.arange(3), (count, 1)), axis=1)):
        look_along_an_axis[i, np.arange(3), order] = signs[i] * [rng.integers(1, 60), 1, 1]
    large = rng.integers(-24_000, 24_001, shape)
    mixed = np.where(rng.random(shape) < 0.4, 0, large >> rng.integers(0, 14, shape))
    triples = np.select(
        [np.arange(count)[:, None, None] % 4 == kind for kind in range(3)], [small, look_along_an_axis, large], mixed
    )
    return np.concatenate([positions[:, None], triples], axis=1).astype(np.int32)
