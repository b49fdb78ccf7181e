"""Closed solids to make the example scenes of: points and polygons, counter-clockwise seen from outside.

Coordinates are rounded to 1/1024 so that every machine makes the same files.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import cos, pi, sin

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Solid:
    """Points and the polygons between them (indices of points)."""

    points: tuple[Point, ...]
    faces: tuple[tuple[int, ...], ...]

    def moved(self, x: float, y: float, z: float) -> Solid:
        """Shift it."""
        return Solid(tuple(_rounded((a + x, b + y, c + z)) for a, b, c in self.points), self.faces)

    def rolled(self, degrees: float) -> Solid:
        """Turn it about the z axis."""
        turn, away = cos(degrees * pi / 180), sin(degrees * pi / 180)
        points = tuple(_rounded((a * turn - b * away, a * away + b * turn, c)) for a, b, c in self.points)
        return Solid(points, self.faces)


@dataclass(frozen=True)
class Part:
    """An object of a scene: a name, a material's name, its solids."""

    name: str
    material: str
    solids: tuple[Solid, ...]


def box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Solid:
    """Make a box from its ranges."""
    return prism("y", [(z[0], x[0]), (z[1], x[0]), (z[1], x[1]), (z[0], x[1])], y)


def prism(axis: str, profile: list[tuple[float, float]], reach: tuple[float, float]) -> Solid:
    """Sweep a convex profile along an axis.

    The profile goes round counter-clockwise in the two axes that follow `axis` in the order x, y, z, x, y.
    """
    return _loft([[_along(axis, place, a, b) for a, b in profile] for place in reach])


def spin(profile: list[tuple[float, float]], sides: int) -> Solid:
    """Turn a profile of (radius, height) points, from the bottom up, about the y axis."""
    turns = [2 * pi * side / sides for side in range(sides)]
    return _loft([[(radius * sin(turn), height, radius * cos(turn)) for turn in turns] for radius, height in profile])


def ball(radius: float, rows: int = 12, sides: int = 16) -> Solid:
    """Make a ball about the origin."""
    steps = [pi * row / rows for row in range(rows + 1)]
    return spin([(max(radius * sin(step), 1 / 256), -radius * cos(step)) for step in steps], sides)


def ring(inner: float, outer: float, y: tuple[float, float], sides: int = 24) -> Solid:
    """Make a flat ring about the y axis."""
    low, high = y
    profile = [(inner, low), (outer, low), (outer, high), (inner, high)]
    turns = [2 * pi * side / sides for side in range(sides)]
    points = [(radius * sin(turn), height, radius * cos(turn)) for turn in turns for radius, height in profile]
    faces = []
    for here in range(sides):
        there = (here + 1) % sides
        for corner in range(4):
            after = (corner + 1) % 4
            faces.append((4 * here + corner, 4 * there + corner, 4 * there + after, 4 * here + after))
    return Solid(tuple(map(_rounded, points)), tuple(faces))


def _along(axis: str, place: float, a: float, b: float) -> Point:
    return {"x": (place, a, b), "y": (b, place, a), "z": (a, b, place)}[axis]


def _loft(loops: list[list[Point]]) -> Solid:
    """Close a stack of loops, each counter-clockwise seen from the stack's end."""
    count = len(loops[0])
    faces = [tuple(reversed(range(count)))]
    for below, above in pairwise(range(0, count * len(loops), count)):
        for corner in range(count):
            after = (corner + 1) % count
            faces.append((below + corner, below + after, above + after, above + corner))
    faces.append(tuple(range(count * (len(loops) - 1), count * len(loops))))
    return Solid(tuple(_rounded(point) for loop in loops for point in loop), tuple(faces))


def _rounded(point: Point) -> Point:
    x, y, z = (round(value * 1024) / 1024 + 0.0 for value in point)
    return x, y, z
