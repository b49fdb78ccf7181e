"""Which materials show in a voxel: the parts of triangles in it, in fractions, as the manual says."""

from __future__ import annotations

import math
from collections import defaultdict
from fractions import Fraction
from itertools import pairwise

from oracles.voxels import UNIT, volume6


def cut(polygon, axis, value, sign):
    """What of a convex polygon lies where sign * coordinate <= sign * value."""
    out = []
    for p, q in pairwise([*polygon, polygon[0]]) if polygon else ():
        a, b = sign * (p[axis] - value), sign * (q[axis] - value)
        if a <= 0:
            out.append(p)
        if a * b < 0:
            out.append(tuple(u + (v - u) * Fraction(a, a - b) for u, v in zip(p, q, strict=True)))
    return out


def part_in(corners, voxel, side, *, inverted):
    """The part of a triangle in a voxel, in units of the lattice; a flat one on a plane between voxels is behind it."""
    polygon = [tuple(Fraction(int(v)) for v in corner) for corner in corners]
    normal = vector_area(polygon)
    for axis in range(3):
        low, high = int(corners[:, axis].min()), int(corners[:, axis].max())
        if low == high and low % UNIT == 0:
            layer = min(max(low // UNIT - ((normal[axis] > 0) != inverted), 0), side - 1)
            if layer != voxel[axis] or not normal[axis]:
                return []
            continue
        for end, sign in ((voxel[axis] * UNIT, -1), ((voxel[axis] + 1) * UNIT, 1)):
            polygon = cut(polygon, axis, end, sign)
    return polygon


def vector_area(polygon):
    """Twice the area of a polygon along each axis."""
    total = [Fraction(0)] * 3
    for b, c in pairwise(polygon[1:]):
        u, v = ([y - x for x, y in zip(polygon[0], p, strict=True)] for p in (b, c))
        for axis in range(3):
            j, k = (axis + 1) % 3, (axis + 2) % 3
            total[axis] += u[j] * v[k] - u[k] * v[j]
    return total


def winding(vertices, triangles, point):
    """How often a closed surface winds about a point, by solid angles."""
    total = 0.0
    for triangle in vertices[triangles]:
        a, b, c = ([float(v) - p for v, p in zip(corner, point, strict=True)] for corner in triangle)
        la, lb, lc = (math.hypot(*v) for v in (a, b, c))
        over = sum(
            x * (y * w - z * v)
            for x, y, z, v, w in (
                (a[0], b[1], b[2], c[1], c[2]),
                (a[1], b[2], b[0], c[2], c[0]),
                (a[2], b[0], b[1], c[0], c[1]),
            )
        )
        dot = lambda p, q: sum(x * y for x, y in zip(p, q, strict=True))  # noqa: E731
        total += 2 * math.atan2(over, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    return round(total / (4 * math.pi))


def exposed_areas(meshes, voxel, side):
    """By material, in authored order: the area that shows along x, y and z, in voxels. Meshes are closed."""
    areas = defaultdict(Fraction)
    for number, (vertices, triangles, materials) in enumerate(meshes):
        inverted = volume6(vertices, triangles) < 0
        for corners, material in zip(vertices[triangles], materials.tolist(), strict=True):
            low, high = corners.min(0), corners.max(0)
            if any(low[i] > (voxel[i] + 1) * UNIT or high[i] < voxel[i] * UNIT for i in range(3)):
                continue
            polygon = part_in(corners, voxel, side, inverted=inverted)
            normal = vector_area(polygon)
            if not any(normal):
                continue
            length = math.hypot(*map(float, normal)) * (-1 if inverted else 1)
            before = []
            for axis in range(3):
                middle = float(sum(p[axis] for p in polygon) / len(polygon)) + float(normal[axis]) / length * UNIT / 256
                least = voxel[axis] * UNIT + UNIT / 512
                before.append(min(max(middle, least), least + UNIT * 255 / 256))
            if not any(winding(v, t, before) for other, (v, t, _) in enumerate(meshes) if other != number):
                areas[material] += sum(map(abs, normal)) / (2 * UNIT**2)
    return areas
