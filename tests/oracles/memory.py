"""Octree memories and the voxels they stand for, by plain recursion."""

from __future__ import annotations

import numpy as np


def voxels_of(words, depth):
    """Expand a memory (report dialect) into materials indexed [x, y, z]; depth gives the side."""
    voxels = np.zeros((1 << depth,) * 3, np.uint8)

    def fill(word, corner, side):
        x, y, z = corner
        if word >> 31:
            voxels[x : x + side, y : y + side, z : z + side] = word & 0xFF
            return
        half = side // 2
        for octant in range(8):
            child = (x + half * (octant & 1), y + half * (octant >> 1 & 1), z + half * (octant >> 2))
            fill(int(words[word + octant]), child, half)

    fill(int(words[0]), (0, 0, 0), 1 << depth)
    return voxels


def words_of(voxels):
    """Build a memory of a cube of materials, blocks in the order they are met, equal blocks kept apart."""
    words = [0]

    def build(cube):
        first = int(cube.flat[0])
        if (cube == first).all():
            return 0xFFFFFF00 | first
        half = len(cube) // 2
        block = len(words)
        words.extend([0] * 8)
        for octant in range(8):
            x, y, z = (slice(half * bit, half * bit + half) for bit in (octant & 1, octant >> 1 & 1, octant >> 2))
            words[block + octant] = build(cube[x, y, z])
        return block

    words[0] = build(np.asarray(voxels))
    return np.array(words, np.uint32)
