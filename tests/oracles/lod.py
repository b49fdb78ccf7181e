"""Level of detail as docs/lod.md defines it, in rational arithmetic: rays that stop, and mean materials."""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from math import floor

import numpy as np
from oracles.ray import FACE_NONE, cells

from voxrt.octree import Rom, from_dense, with_means
from voxrt.voxelize import EMPTY, Material
from voxrt.voxelize.colour.srgb import linear_from_srgb


def noise(seed, side, share):
    """A memory with mean materials: voxels of three colours, thrown independently."""
    rng = np.random.default_rng(seed)
    voxels = (rng.random((side,) * 3) < share).astype(np.uint8) * rng.integers(1, 4, (side,) * 3).astype(np.uint8)
    colours = [(255, 0, 0), (0, 255, 0), (120, 130, 140)]
    return with_means(Rom("noise", from_dense(voxels), (EMPTY, *(Material(str(c), c) for c in colours))))


def distance_to(corner, size, position, direction):
    """Give the greatest distance along an axis from a position (1/16 voxel) to a cell's near plane, voxels."""
    distances = [Fraction(0)]
    for low, own, d in zip(corner, position, direction, strict=True):
        at = Fraction(int(own), 16)
        if d > 0:
            distances.append(low - at)
        elif d < 0:
            distances.append(at - (low + size))
    return max(distances)


def stops_at(level, corner, position, direction, scale):
    """Tell whether a ray stops at a cell of 2**level voxels per side that has a mean material."""
    reach = floor(Fraction(max(abs(int(d)) for d in direction) * scale, 1 << 20)) + 1
    return floor(distance_to(corner, 1 << level, position, direction)) >= reach * 2**level


def trace(memory, position, direction, scale):
    """Find what a ray shows, voxel by voxel: (material, face). `memory`: words, means, depth."""
    words, means, depth = memory
    for cell, face, _ in cells(1 << depth, position, direction):
        word, level = int(words[0]), depth
        while word < 1 << 31:
            corner = [c >> level << level for c in cell]
            mean = int(means[word >> 3]) if scale and level < depth else 0
            if mean and stops_at(level, corner, position, direction, scale):
                return mean, face
            level -= 1
            word = int(words[word + sum((c >> level & 1) << axis for axis, c in enumerate(cell))])
        if word & 0xFF:
            return word & 0xFF, face
    return 0, FACE_NONE


def looks(words, depth, dense, palette):
    """Give, by the address of a block, the mean light of what is visible in it (or None) and its three coverages."""
    assert len(dense) == 1 << depth
    around = np.pad(dense > 0, 1)
    beside = [np.roll(around, step, axis)[1:-1, 1:-1, 1:-1] for axis in range(3) for step in (-1, 1)]
    visible = (dense > 0) & ~np.logical_and.reduce(beside)
    light = [[Fraction(float(c)) for c in row] for row in linear_from_srgb(palette)]
    sums = defaultdict(lambda: [Fraction(0)] * 4)
    coverage = {}

    def look(word, level, corner):
        """(coverage along three axes, surface, light times surface) of an octant."""
        size = 1 << level
        here = tuple(slice(c, c + size) for c in corner)
        if word >> 31:
            solid = Fraction(int(word & 0xFF > 0))
            seen = surface_of(visible[here]) if solid else Fraction(0)
            return [solid] * 3, seen, [seen * c for c in light[word & 0xFF]]
        parts = {}
        for octant in range(8):
            at = [c + (octant >> axis & 1) * size // 2 for axis, c in enumerate(corner)]
            parts[octant] = look(int(words[word + octant]), level - 1, at)
        covered = []
        for axis in range(3):
            pairs = [(o, o | 1 << axis) for o in range(8) if not o >> axis & 1]
            covered.append(sum(1 - (1 - parts[a][0][axis]) * (1 - parts[b][0][axis]) for a, b in pairs) / 4)
        surface = sum(part[1] for part in parts.values()) / 4
        shine = [sum(part[2][c] for part in parts.values()) / 4 for c in range(3)]
        total = sums[word]
        sums[word] = [total[0] + surface, *(old + new for old, new in zip(total[1:], shine, strict=True))]
        coverage[word] = covered
        return covered, surface, shine

    look(int(words[0]), depth, [0, 0, 0])
    return {
        word: ([c / surface for c in shine] if surface else None, coverage[word])
        for word, (surface, *shine) in sums.items()
    }


def spare_coverage(coverage):
    """Give by how much a block's least coverage exceeds the least that a mean needs."""
    return min(coverage) - Fraction(11, 16)


def surface_of(visible):
    """Give the visible part of a cube of voxels: 1 of a voxel, a quarter of the sum of its octants of a larger cube."""
    return Fraction(int(visible.sum()), len(visible) ** 2)
