"""Shapes of the acid test: triangles on the lattice of 1/4096 voxel, counter-clockwise seen from outside.

Measures are in voxels; ``at`` places points on the lattice.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from acid.checker import UNIT

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from acid.checker import Point, Triangle

    Real = Sequence[float]

SIDES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
"""The corners of a box, x in bit 0, by side: -x, +x, -y, +y, -z, +z."""


def at(*points: Real) -> list[Point]:
    """Points given in voxels, on the lattice."""
    return [tuple(round(v * UNIT) for v in p) for p in points]  # type: ignore[misc]


def polygon(*points: Real) -> list[Triangle]:
    """Part a convex polygon into triangles."""
    a, *others = at(*points)
    return [(a, b, c) for b, c in pairwise(others)]


def faces_of(points: Sequence[Real], faces: Sequence[Sequence[int]]) -> list[Triangle]:
    return [t for face in faces for t in polygon(*(points[i] for i in face))]


def turned(triangles: list[Triangle]) -> list[Triangle]:
    return [(a, c, b) for a, b, c in triangles]


def corners(low: Real, high: Real) -> list[Real]:
    ends = (low, high)
    return [(ends[i & 1][0], ends[i >> 1 & 1][1], ends[i >> 2][2]) for i in range(8)]


def box(low: Real, high: Real, turn: Callable[[Real], Real] = tuple) -> list[Triangle]:
    return faces_of([turn(p) for p in corners(low, high)], SIDES)


def cube(low: float, high: float) -> list[Triangle]:
    return box((low,) * 3, (high,) * 3)


def rotation(axis: Real, degrees: float, centre: Real = (8, 8, 8)) -> Callable[[Real], Real]:
    """Turn about an axis through a point (Rodrigues)."""
    length = math.hypot(*axis)
    u = [v / length for v in axis]
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def turn(point: Real) -> Real:
        p = [a - b for a, b in zip(point, centre, strict=True)]
        along = sum(a * b for a, b in zip(u, p, strict=True)) * (1 - c)
        across = (u[1] * p[2] - u[2] * p[1], u[2] * p[0] - u[0] * p[2], u[0] * p[1] - u[1] * p[0])
        return tuple(o + c * a + s * b + along * w for o, a, b, w in zip(centre, p, across, u, strict=True))

    return turn


def ball(centre: Real, radius: float, rings: int = 6, around: int = 10) -> list[Triangle]:
    """Make a sphere of latitudes and longitudes."""

    def point(i: int, j: int) -> Real:
        up, side = math.pi * i / rings, 2 * math.pi * (j % around) / around
        unit = (math.sin(up) * math.cos(side), math.sin(up) * math.sin(side), math.cos(up))
        return tuple(c + radius * v for c, v in zip(centre, unit, strict=True))

    found: list[Triangle] = []
    for i in range(rings):
        for j in range(around):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            found += ([] if i == rings - 1 else polygon(a, b, c)) + ([] if i == 0 else polygon(a, c, d))
            if i == rings - 1:
                found[-1:] = polygon(a, b, d)
    return found


def prism(outline: Sequence[Sequence[float]], low: float, high: float) -> list[Triangle]:
    """Make a column over a convex outline in x and y, counter-clockwise."""
    bottom, top = [(x, y, low) for x, y in outline], [(x, y, high) for x, y in outline]
    found = polygon(*reversed(bottom)) + polygon(*top)
    for i in range(len(outline)):
        found += polygon(bottom[i - 1], bottom[i], top[i], top[i - 1])
    return found


def tube(centre: Real, radii: Real, ends: Real, around: int = 12) -> list[Triangle]:
    """Make a hollow cylinder along z: radii, then its ends."""

    def ring(radius: float, z: float) -> list[Real]:
        angles = (2 * math.pi * i / around for i in range(around))
        return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a), z) for a in angles]

    (outer, inner), (low, high) = radii, ends
    rings = ring(outer, low), ring(outer, high), ring(inner, high), ring(inner, low)
    found: list[Triangle] = []
    for below, above in zip(rings, (*rings[1:], rings[0]), strict=True):
        for i in range(around):
            found += polygon(below[i - 1], below[i], above[i], above[i - 1])
    return found


def height_field(heights: Callable[[int, int], float], count: int, step: float, low: float = 2) -> list[Triangle]:
    """Make a solid under heights at the points of a square grid that starts at (2, 2)."""

    def top(i: int, j: int) -> Real:
        return (2 + step * i, 2 + step * j, heights(i, j))

    def bottom(i: int, j: int) -> Real:
        return (2 + step * i, 2 + step * j, low)

    found: list[Triangle] = []
    for i in range(count):
        for j in range(count):
            a, b, c, d = (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)
            found += polygon(top(*a), top(*b), top(*c)) + polygon(top(*a), top(*c), top(*d))
            found += polygon(bottom(*c), bottom(*b), bottom(*a)) + polygon(bottom(*d), bottom(*c), bottom(*a))
    rim = [(i, 0) for i in range(count)] + [(count, j) for j in range(count)]
    rim += [(count - i, count) for i in range(count)] + [(0, count - j) for j in range(count)]
    for p, q in pairwise([*rim, rim[0]]):
        found += polygon(bottom(*p), bottom(*q), top(*q)) + polygon(bottom(*p), top(*q), top(*p))
    return found


def cone(base: Sequence[Real], apex: Real) -> list[Triangle]:
    """Make a pyramid over a convex base, counter-clockwise seen from outside."""
    found = polygon(*base)
    for i in range(len(base)):
        found += polygon(base[i], base[i - 1], apex)
    return found


def regular(count: int, radius: float, centre: Sequence[float], start: float = 0) -> list[Sequence[float]]:
    angles = (start + 2 * math.pi * i / count for i in range(count))
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def without(triangles: list[Triangle], *left_out: int) -> list[Triangle]:
    return [t for i, t in enumerate(triangles) if i not in left_out]


def some_turned(triangles: list[Triangle], every: int) -> list[Triangle]:
    return [(a, c, b) if i % every == 1 else (a, b, c) for i, (a, b, c) in enumerate(triangles)]


def plate(degrees: float, axis: Real = (0, 1, 0), thickness: float = 0.02) -> list[Triangle]:
    low, high = 8.25 - thickness / 2, 8.25 + thickness / 2
    return box((3, 3, low), (13, 13, high), rotation(axis, degrees, (8, 8, 8.25)))


def split_edge_box(low: Real, high: Real) -> list[Triangle]:
    """Make a box whose top has a corner more on one edge than the side below it."""
    points = corners(low, high)
    a, b, c, d = (points[i] for i in SIDES[5])
    middle = tuple((u + v) / 2 for u, v in zip(a, b, strict=True))
    return box(low, high)[:10] + polygon(a, middle, d) + polygon(middle, b, c) + polygon(middle, c, d)


def star(outline: Sequence[Sequence[float]], low: float, high: float) -> list[Triangle]:
    """Make a column over an outline that crosses itself: its ends are fans about the middle."""
    x, y = (sum(p[i] for p in outline) / len(outline) for i in (0, 1))
    found: list[Triangle] = []
    for i in range(len(outline)):
        (ax, ay), (bx, by) = outline[i - 1], outline[i]
        found += polygon((x, y, high), (ax, ay, high), (bx, by, high))
        found += polygon((x, y, low), (bx, by, low), (ax, ay, low))
        found += polygon((ax, ay, low), (bx, by, low), (bx, by, high), (ax, ay, high))
    return found


def slab_with_notch() -> list[Triangle]:
    """Make two legs under a bridge: a solid that is not convex."""
    outline = [(2, 2), (5, 2), (5, 9), (11, 9), (11, 2), (14, 2), (14, 13), (2, 13)]
    front = [(0, 1, 2), (0, 2, 7), (2, 3, 6), (2, 6, 7), (3, 4, 5), (3, 5, 6)]
    low, high = [(x, 3.5, z) for x, z in outline], [(x, 12.5, z) for x, z in outline]
    found = [t for f in front for t in polygon(*(low[i] for i in f)) + polygon(*(high[i] for i in reversed(f)))]
    for i in range(8):
        found += polygon(low[i], low[i - 1], high[i - 1], high[i])
    return found
