"""Small dense worlds for tests of rays, each (S, S, S) uint8 indexed [x, y, z]."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def noise(depth: int, density: float, seed: int) -> NDArray[np.uint8]:
    """Solid voxels of random materials, thrown independently."""
    rng = np.random.default_rng(seed)
    shape = (1 << depth,) * 3
    return np.where(rng.random(shape) < density, rng.integers(1, 256, shape), 0).astype(np.uint8)


def boxes(depth: int, count: int, seed: int) -> NDArray[np.uint8]:
    """Boxes of random place, size and material, many of them large octants."""
    rng = np.random.default_rng(seed)
    side = 1 << depth
    voxels = np.zeros((side,) * 3, np.uint8)
    for material in range(1, count + 1):
        length = 1 << rng.integers(0, depth, 3)
        corner = rng.integers(0, side // length) * length
        voxels[tuple(slice(c, c + n) for c, n in zip(corner, length, strict=True))] = material
    return voxels


def ball(depth: int) -> NDArray[np.uint8]:
    """A ball in the middle, its material telling the eight octants apart."""
    side = 1 << depth
    x, y, z = np.indices((side,) * 3) * 2 + 1 - side
    material = 1 + (x > 0) + 2 * (y > 0) + 4 * (z > 0)
    return np.where(x * x + y * y + z * z < (0.8 * side) ** 2, material, 0).astype(np.uint8)


def sponge(depth: int) -> NDArray[np.uint8]:
    """A Menger sponge as far as it fits: long thin tunnels along every axis."""
    side = 1 << depth
    x, y, z = np.indices((side,) * 3)
    solid = (x < 27) & (y < 27) & (z < 27)
    for scale in (1, 3, 9):
        middles = sum((axis // scale % 3 == 1).astype(int) for axis in (x, y, z))
        solid &= middles < 2
    return np.where(solid, 1 + x // 9 % 3, 0).astype(np.uint8)


def lumps(depth: int, materials: int = 1, seed: int = 0) -> NDArray[np.uint8]:
    """A few overlapping balls with rough skins."""
    rng = np.random.default_rng(seed)
    side = 1 << depth
    grid = np.stack(np.indices((side,) * 3), -1) + 0.5
    cube = np.zeros((side,) * 3, np.uint8)
    for i in range(4):
        centre, radius = rng.uniform(0.3, 0.7, 3) * side, rng.uniform(0.1, 0.25) * side
        skin = 0.05 * radius * np.sin(grid @ rng.normal(size=3) * 40 / side)
        cube[np.linalg.norm(grid - centre, axis=-1) < radius + skin] = 1 + i % materials
    return cube


WORLDS = {
    "sparse noise": noise(5, 0.01, 1),
    "dense noise": noise(3, 0.3, 2),
    "boxes": boxes(6, 12, 3),
    "ball": ball(4),
    "sponge": sponge(5),
    "one voxel": np.where(np.indices((4, 4, 4)).sum(axis=0) == 0, 7, 0).astype(np.uint8),
    "smallest": noise(1, 0.5, 4),
    "all solid": np.full((8, 8, 8), 255, np.uint8),
    "nothing": np.zeros((8, 8, 8), np.uint8),
}
