"""Which voxels belong to a mesh, by each rule: exact, in integers and fractions, by brute force.

It shares no code with voxrt and imports the standard library alone. Points are triples of whole numbers, in units of
1/4096 voxel: `UNIT` is a voxel. Voxel v covers v * UNIT … (v + 1) * UNIT on each axis, 0 <= v < side. A triangle is
three points, counter-clockwise seen from outside. A set of voxels is a set of triples.

How it works: a triangle is cut by the planes between voxels, one axis after the other, so each piece lies in one
voxel. A piece that is not within a side of its voxel meets the interior. A voxel whose interior no piece meets is
inside or outside as a whole: a vertical line through it counts how often it enters and leaves (the winding number).
Volumes are sums over the pieces of what lies below each.
"""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    Number = int | Fraction
    Point = tuple[Number, Number, Number]
    Triangle = tuple[Point, Point, Point]
    Voxel = tuple[int, int, int]

UNIT = 4096
TRIES = range(1, 1000)
"""Numbers of lines: the first one that meets no edge is taken."""


def minus(a: Point, b: Point) -> Point:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def cross(a: Point, b: Point) -> Point:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a: Point, b: Point) -> Number:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def normal_of(triangle: Triangle) -> Point:
    a, b, c = triangle
    return cross(minus(b, a), minus(c, a))


def volume6(triangles: Iterable[Triangle]) -> Number:
    """Six times the volume that triangles enclose; negative where they face inwards."""
    return sum(dot(a, cross(b, c)) for a, b, c in triangles)


def ratio(a: Number, b: Number) -> Number:
    """The quotient; as an integer where it is one, since these are faster."""
    return a // b if a % b == 0 else Fraction(a, b)


def mean(points: Sequence[Point], weights: Sequence[int]) -> Point:
    """A point within a convex polygon."""
    used = weights[: len(points)]
    x, y, z = (sum(w * p[i] for w, p in zip(used, points, strict=True)) for i in range(3))
    return Fraction(x, sum(used)), Fraction(y, sum(used)), Fraction(z, sum(used))


def clip(polygon: Sequence[Point], height: Callable[[Point], Number]) -> list[Point]:
    """The part of a convex polygon where `height`, an affine function, is not negative."""
    heights = [height(p) for p in polygon]
    kept: list[Point] = []
    for i, (p, h) in enumerate(zip(polygon, heights, strict=True)):
        q, k = polygon[i - 1], heights[i - 1]
        if (h > 0 and k < 0) or (h < 0 and k > 0):
            kept.append(tuple(v + ratio((u - v) * k, k - h) for u, v in zip(p, q, strict=True)))  # type: ignore[arg-type]
        if h >= 0:
            kept.append(p)
    return kept


def between(polygon: Sequence[Point], axis: int, low: Number, high: Number) -> Sequence[Point]:
    """The part of a convex polygon in low … high on an axis."""
    if min(p[axis] for p in polygon) < low:
        polygon = clip(polygon, lambda p: p[axis] - low)
    if polygon and max(p[axis] for p in polygon) > high:
        polygon = clip(polygon, lambda p: high - p[axis])
    return polygon


def pieces(polygon: Sequence[Point], side: int, axis: int = 0) -> Iterator[tuple[Voxel, Sequence[Point]]]:
    """Cut a convex polygon by the planes between voxels: for each closed voxel that it meets, its part there."""
    if axis == 3:
        yield (), polygon  # type: ignore[misc]
        return
    values = [p[axis] for p in polygon]
    for index in range(max(-(-min(values) // UNIT) - 1, 0), min(max(values) // UNIT, side - 1) + 1):
        part = between(polygon, axis, index * UNIT, (index + 1) * UNIT)
        yield from (((index, *rest), piece) for rest, piece in pieces(part, side, axis + 1))  # type: ignore[misc]


def crossings(triangles: Iterable[Triangle], origin: Point, along: Point) -> list[tuple[Fraction, int]] | None:
    """Where a line crosses triangles: (t, 1 where it leaves, -1 where it enters) at origin + t * along.

    None where the line meets an edge: then another line is needed.
    """
    found = []
    for triangle in triangles:
        a, b, c = (minus(p, origin) for p in triangle)
        sides = dot(along, cross(a, b)), dot(along, cross(b, c)), dot(along, cross(c, a))
        if min(sides) < 0 < max(sides):
            continue
        if 0 in sides:
            return None
        found.append((Fraction(dot(a, cross(b, c)), sum(sides)), 1 if sides[0] > 0 else -1))
    return found


def winding(triangles: Sequence[Triangle], point: Point) -> int:
    """The winding number of a closed surface about a point that is not on it."""
    lines = (crossings(triangles, point, (7919 + 13 * k, 104729 + 31 * k, 1299709 + 57 * k * k)) for k in TRIES)
    return sum(sign for t, sign in next(line for line in lines if line is not None) if t > 0)


def is_on(triangle: Triangle, point: Point) -> bool:
    """Whether a point lies on a closed triangle that has an area."""
    normal = normal_of(triangle)
    if dot(normal, minus(point, triangle[0])) != 0:
        return False
    ahead = (*triangle[1:], triangle[0])
    return all(dot(normal, cross(minus(b, a), minus(point, a))) >= 0 for a, b in zip(triangle, ahead, strict=True))


def edges(triangle: Triangle) -> list[tuple[Point, Point]]:
    a, b, c = triangle
    return [(a, b), (b, c), (c, a)]


def balance(triangles: Iterable[Triangle]) -> dict[frozenset[Point], list[int]]:
    """How often each edge is walked one way less the other way, and by how many triangles."""
    found: dict[frozenset[Point], list[int]] = defaultdict(lambda: [0, 0])
    for triangle in triangles:
        for a, b in edges(triangle):
            found[frozenset((a, b))][0] += 1 if a < b else -1
            found[frozenset((a, b))][1] += 1
    return found


def is_closed(triangles: Iterable[Triangle]) -> bool:
    return not any(excess for excess, _ in balance(triangles).values())


def grouped(triangles: Sequence[Triangle], keys_of: Callable[[Triangle], Iterable[object]]) -> list[list[Triangle]]:
    """Triangles that share keys, directly or by way of others; each group begins with its first triangle."""
    at = defaultdict(list)
    for index, triangle in enumerate(triangles):
        for key in keys_of(triangle):
            at[key].append(index)
    left, found = set(range(len(triangles))), []
    while left:
        todo, own = [min(left)], []
        left.discard(todo[0])
        while todo:
            own.append(todo.pop())
            near = {i for key in keys_of(triangles[own[-1]]) for i in at[key]} & left
            left -= near
            todo.extend(sorted(near))
        found.append([triangles[i] for i in own])
    return found


def aligned(piece: list[Triangle]) -> list[Triangle]:
    """Turn the faces of a connected piece so that each edge is walked as often one way as the other."""
    if is_closed(piece):
        return piece
    if any(count > 2 for _, count in balance(piece).values()):
        raise ValueError("more than two faces at an edge, and some are turned: the checker does not take this")
    done: list[Triangle] = []
    for group in grouped(piece, lambda t: [frozenset(edge) for edge in edges(t)]):
        walked: set[tuple[Point, Point]] = set()
        for face in group:
            turned = walked.intersection(edges(face))
            done.append(face[::-1] if turned else face)  # type: ignore[arg-type]
            walked.update(edges(done[-1]))
    return done


def oriented(triangles: Sequence[Triangle]) -> list[list[Triangle]]:
    """Connected pieces: equal faces once, each consistent, outwards where it closes; but within another as it was."""
    once = {frozenset(t): t for t in reversed(triangles) if len(set(t)) == 3}
    whole = [aligned(piece) for piece in grouped(list(reversed(once.values())), lambda t: t)]
    done: list[list[Triangle]] = []
    flips: list[bool] = []
    for piece in sorted(whole, key=lambda piece: -abs(volume6(piece))):
        points = {p for t in piece for p in t}
        around, free = [], points
        for index, other in enumerate(done):
            off = {p for p in points if not any(is_on(t, p) for t in other)}
            if is_closed(other) and off and all(winding(other, p) for p in off):
                around.append(index)
                free = free & off
        held = sum(winding(done[index], min(free)) for index in around) if free else 0
        flip = is_closed(piece) and (flips[around[-1]] if held else volume6(piece) < 0)
        flips.append(flip)
        done.append([t[::-1] for t in piece] if flip else piece)  # type: ignore[misc]
    return done


def meets_interior(voxel: Voxel, piece: Sequence[Point]) -> bool:
    """Whether a part of a surface in a closed voxel lies in none of the voxel's sides."""
    return all(
        min(p[i] for p in piece) < (voxel[i] + 1) * UNIT and max(p[i] for p in piece) > voxel[i] * UNIT
        for i in range(3)
    )


class Mesh:
    """Triangles among `side` voxels per axis. Pieces that close have an inside, sheets have none."""

    def __init__(self, triangles: Sequence[Triangle], side: int) -> None:
        self.side = side
        found = oriented(triangles)
        self.triangles = [t for piece in found for t in piece]
        self.closing = [t for piece in found if is_closed(piece) for t in piece]

    @cached_property
    def _met(self) -> tuple[set[Voxel], set[Voxel], set[Voxel]]:
        """Voxels that the surface meets: in their interior; at all; and those behind faces between voxels."""
        interior, contact, behind = set(), set(), set()
        for triangle in self.triangles:
            for voxel, piece in pieces(triangle, self.side):
                contact.add(voxel)
                if meets_interior(voxel, piece):
                    interior.add(voxel)
            normal = normal_of(triangle)
            for axis in range(3):
                plane = triangle[0][axis]
                if normal[axis] and plane % UNIT == 0 and all(p[axis] == plane for p in triangle):
                    layer = min(max(plane // UNIT - (normal[axis] > 0), 0), self.side - 1)
                    inner = layer * UNIT + UNIT // 2
                    flat = [tuple(inner if i == axis else v for i, v in enumerate(p)) for p in triangle]
                    behind |= {v for v, piece in pieces(flat, self.side) if meets_interior(v, piece)}
        return interior, contact, behind

    @cached_property
    def _columns(self) -> dict[tuple[int, int], list[Triangle]]:
        """The closing triangles above and below each column of voxels."""
        at = defaultdict(list)
        for triangle in self.closing:
            x, y = ((min(p[i] for p in triangle) // UNIT, max(p[i] for p in triangle) // UNIT) for i in (0, 1))
            for column in product(range(x[0], x[1] + 1), range(y[0], y[1] + 1)):
                at[column].append(triangle)
        return at

    @cached_property
    def _inside(self) -> set[Voxel]:
        """Voxels wholly inside: the surface does not meet their interior."""
        found = set()
        for x, y in product(range(self.side), repeat=2):
            points = ((x * UNIT + 1 + 577 * k % (UNIT - 1), y * UNIT + 1 + 1409 * k % (UNIT - 1), 0) for k in TRIES)
            lines = (crossings(self._columns.get((x, y), ()), point, (0, 0, 1)) for point in points)
            line = next(line for line in lines if line is not None)
            for z in range(self.side if line else 0):
                middle = z * UNIT + UNIT // 2
                if sum(sign for t, sign in line if t > middle) and (x, y, z) not in self._met[0]:
                    found.add((x, y, z))
        return found

    def touch(self) -> set[Voxel]:
        """The closed solid meets the open interior; faces between voxels belong to the voxel behind them."""
        return self._met[0] | self._met[2] | self._inside

    def surface(self, *, contact: bool) -> set[Voxel]:
        """The surface meets the voxel's open interior; with `contact`, the closed voxel."""
        return self._met[1] if contact else self._met[0]

    def surface_within(self, margin: Fraction) -> set[Voxel]:
        """The surface meets the closed middle of the voxel: a cube that ends `margin`, in voxels, before its sides."""
        found = set()
        for triangle in self.triangles:
            for voxel, piece in pieces(triangle, self.side):
                for axis in range(3):
                    low, high = (voxel[axis] + margin) * UNIT, (voxel[axis] + 1 - margin) * UNIT
                    piece = between(piece, axis, low, high)  # noqa: PLW2901
                found |= {voxel} if piece else set()
        return found

    def centre(self, *, contact: bool) -> set[Voxel]:
        """The voxel's centre lies inside; with `contact`, on the surface counts too."""
        found = set(self._inside)
        for voxel in self._met[0]:
            middle = tuple(v * UNIT + UNIT // 2 for v in voxel)
            on = any(is_on(t, middle) for t in self.triangles)
            if contact if on else winding(self.closing, middle):
                found.add(voxel)
        return found

    @cached_property
    def fractions(self) -> dict[Voxel, Fraction]:
        """Which part of each voxel is inside; voxels with none are left out. The mesh must lie in the grid."""
        volumes: dict[Voxel, Fraction] = defaultdict(Fraction)
        for polygon, change in self._boundary():
            for (x, y, z), piece in pieces(polygon, self.side):
                if z < self.side - 1 and min(p[2] for p in piece) == (z + 1) * UNIT:
                    continue  # the voxel above has this piece too
                for b, c in zip(piece[1:], piece[2:], strict=False):
                    area = Fraction(abs(cross(minus(b, piece[0]), minus(c, piece[0]))[2]), 2)
                    volumes[x, y, z] += change * area * (Fraction(piece[0][2] + b[2] + c[2], 3) - z * UNIT)
                    for below in range(z):
                        volumes[x, y, below] += change * area * UNIT
        return {voxel: volume / UNIT**3 for voxel, volume in volumes.items() if volume}

    def half(self, *, contact: bool) -> set[Voxel]:
        """More than half of the voxel is inside; with `contact`, exactly half suffices."""
        least = Fraction(1, 2)
        return {voxel for voxel, part in self.fractions.items() if part > least or (contact and part == least)}

    def _boundary(self) -> Iterator[tuple[list[Point], int]]:
        """The surface in convex parts that nothing crosses: 1 where inside lies below alone, -1 where above alone."""
        for triangle in self.closing:
            for part in self._parts(triangle) if normal_of(triangle)[2] else ():
                above, below = self._beside(triangle, part)
                if (above != 0) != (below != 0):
                    yield part, 1 if below else -1

    def _parts(self, triangle: Triangle) -> list[list[Point]]:
        """A triangle, cut where others cross it or lie on it."""
        normal, parts = normal_of(triangle), [list(triangle)]
        low, high = ([f(p[i] for p in triangle) for i in range(3)] for f in (min, max))
        for other in self.closing:
            if any(max(p[i] for p in other) < low[i] or min(p[i] for p in other) > high[i] for i in range(3)):
                continue
            across = normal_of(other)
            sides = [dot(across, minus(p, other[0])) for p in triangle]
            apart = [dot(normal, minus(p, triangle[0])) for p in other]
            walls = [(across, other[0])] if min(sides) < 0 < max(sides) and min(apart) <= 0 <= max(apart) else []
            if not any(sides) and other is not triangle:
                walls = [(cross(minus(b, a), across), a) for a, b in edges(other)]
            for wall, a in walls:
                halves = [clip(part, lambda p: s * dot(wall, minus(p, a))) for part in parts for s in (1, -1)]  # noqa: B023
                parts = [
                    half
                    for half in halves
                    if len(half) > 2 and any(normal_of((half[0], *half[i : i + 2]))[2] for i in range(1, len(half) - 1))
                ]
        return parts

    def _beside(self, triangle: Triangle, part: list[Point]) -> tuple[int, int]:
        """The winding numbers above and below a part of a triangle. Of triangles at one height, the first is on top."""
        for k in TRIES:
            point = mean(part, [1 + k * (i + 1) % 97 for i in range(len(part))])
            column = self._columns[point[0] // UNIT, point[1] // UNIT]
            line = [(t, crossings([t], (point[0], point[1], 0), (0, 0, 1))) for t in column]
            if all(found is not None for _, found in line):
                break
        own = next(i for i, (t, _) in enumerate(line) if t is triangle)
        above = sum(f[0][1] for i, (_, f) in enumerate(line) if f and (f[0][0], -i) > (point[2], -own))
        return above, above + line[own][1][0][1]
