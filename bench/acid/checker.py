"""Which voxels belong to a mesh, by each rule: exact, in integers and fractions, by brute force.

A triangle is cut by the planes between voxels. A piece that lies in no side of its voxel meets the interior. A voxel of
which no piece meets the interior is inside or outside: a vertical line counts the windings. Units: 1/4096 voxel.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence  # noqa: TC003 - of types below
from fractions import Fraction
from functools import cached_property
from itertools import chain, pairwise, product
from math import prod

Number = int | Fraction
Point = tuple[Number, Number, Number]
Triangle = tuple[Point, Point, Point]
Voxel = tuple[int, int, int]
UNIT = 4096
TRIES = range(1, 1000)  # lines: the first one that meets no edge is taken


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
    """Sum six times the volume that triangles enclose; negative where they face inwards."""
    return sum(dot(a, cross(b, c)) for a, b, c in triangles)


def spans(*polygons: Sequence[Point]) -> list[tuple[Number, Number]]:
    return [(min(values), max(values)) for values in zip(*chain(*polygons), strict=True)]


def fan(polygon: Sequence[Point]) -> list[Triangle]:
    return [(polygon[0], b, c) for b, c in pairwise(polygon[1:])]


def ratio(a: Number, b: Number) -> Number:
    return a // b if a % b == 0 else Fraction(a, b)  # integers are faster


def clip(polygon: Sequence[Point], height: Callable[[Point], Number]) -> Sequence[Point]:
    """Keep the part of a convex polygon where `height`, an affine function, is not negative."""
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
    return clip(clip(polygon, lambda p: p[axis] - low), lambda p: high - p[axis])


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
    """Find where a line crosses triangles: t, and 1 where it leaves, -1 where it enters. None: it meets an edge."""
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
    """Count how often a closed surface winds about a point that is not on it."""
    lines = (crossings(triangles, point, (7919 + 13 * k, 104729 + 31 * k, 10**9)) for k in TRIES)
    return sum(sign for t, sign in next(line for line in lines if line is not None) if t > 0)


def is_on(triangle: Triangle, point: Point) -> bool:
    normal = normal_of(triangle)
    in_plane = any(normal) and dot(normal, minus(point, triangle[0])) == 0
    return in_plane and all(dot(normal, cross(minus(b, a), minus(point, a))) >= 0 for a, b in edges(triangle))


def edges(triangle: Triangle) -> list[tuple[Point, Point]]:
    a, b, c = triangle
    return [(a, b), (b, c), (c, a)]


def is_closed(triangles: Iterable[Triangle]) -> bool:
    """Say whether each edge is walked as often one way as the other."""
    walked = Counter(edge for triangle in triangles for edge in edges(triangle))
    surplus = [walked[a, b] - walked[b, a] for a, b in walked]
    if any(surplus) and all(number % 2 == 0 for number in surplus):
        raise ValueError("some faces of a closed surface are turned: the checker takes consistent faces alone")
    return not any(surplus)


def merged(groups: Iterable[set[Triangle]]) -> list[set[Triangle]]:
    found: list[set[Triangle]] = []
    for group in groups:
        found = [f for f in found if not f & group] + [group.union(*(f for f in found if f & group))]
    return found


def bodies(triangles: Iterable[Triangle]) -> list[set[Triangle]]:
    """Set apart what closes over edges of two triangles, as long as there is such; edges connect what is left."""
    at = defaultdict(set)
    for triangle, edge in ((t, edge) for t in triangles for edge in edges(t)):
        at[frozenset(edge)].add(triangle)
    patches = merged([*({t} for t in triangles), *(own for own in at.values() if len(own) == 2)])
    closing = [patch for patch in patches if all(len(own & patch) % 2 == 0 for own in at.values())]
    if any(len(own) > 2 and (len(own) % 2 or not closing) for own in at.values()):
        raise ValueError("faces that share edges close together alone: the checker does not order them")
    rest = [t for patch in patches if patch not in closing for t in patch]
    return closing + bodies(rest) if closing else merged(at.values())


def cut(triangle: Triangle, others: Iterable[Triangle]) -> list[Sequence[Point]]:
    """Cut a triangle by the planes of those that cross it, and along the edges of those upon it."""
    parts = [triangle] if any(normal := normal_of(triangle)) else []
    for other in others:
        across = normal_of(other)
        if not any(across) or any(a > d or c > b for (a, b), (c, d) in zip(spans(triangle), spans(other), strict=True)):
            continue
        sides = [dot(across, minus(p, other[0])) for p in triangle]
        ends = [dot(normal, minus(p, triangle[0])) for p in other]
        walls = [(across, other[0])] if any(sides) else [(cross(minus(b, a), across), a) for a, b in edges(other)]
        for wall, a in walls if min(ends) <= 0 <= max(ends) else ():
            halves = [clip(part, lambda p: s * dot(wall, minus(p, a))) for part in parts for s in (1, -1)]  # noqa: B023
            parts = [half for half in halves if any(any(normal_of(t)) for t in fan(half))]
    return parts


def winding_about(body: Iterable[Triangle], closed: Sequence[Triangle]) -> int:
    """Count how often a closed surface winds about a body that lies in it; 0 where the body passes or lies upon it."""
    if any(a < c or b > d for (a, b), (c, d) in zip(spans(*body), spans(*closed), strict=True)):
        return 0
    middles = [tuple(Fraction(sum(v), len(p)) for v in zip(*p, strict=True)) for t in body for p in cut(t, closed)]
    numbers = {0 if any(is_on(t, p) for t in closed) else winding(closed, p) for p in middles}
    return max(numbers) if len(numbers) == 1 else 0


def oriented(triangles: Iterable[Triangle]) -> list[list[Triangle]]:
    """Turn closed bodies outwards; one that lies in others keeps its side of that with the smallest box."""
    done: list[tuple[bool, list[Triangle]]] = []
    for body in sorted(bodies(triangles), key=lambda b: (-prod(v - u for u, v in spans(*b)), -abs(volume6(b)))):
        numbers = [winding_about(body, other) if is_closed(body) and is_closed(other) else 0 for _, other in done]
        around = [turned for (turned, _), number in zip(done, numbers, strict=True) if number]
        turned = is_closed(body) and (around[-1] if sum(numbers) else volume6(body) < 0)
        done.append((turned, [t[::-1] if turned else t for t in body]))  # type: ignore[misc]
    return [body for _, body in done]


def meets_interior(voxel: Voxel, piece: Sequence[Point]) -> bool:
    """Say whether a part of a surface in a closed voxel lies in none of the voxel's sides."""
    return all(low < (v + 1) * UNIT and high > v * UNIT for (low, high), v in zip(spans(piece), voxel, strict=True))


class Mesh:
    """Triangles among `side` voxels per axis. Pieces that close have an inside; with `sheets`, none do."""

    def __init__(self, triangles: Sequence[Triangle], side: int, *, sheets: bool = False) -> None:
        self.side = side
        kept = [t for t in triangles if len(set(t)) == 3 and (not sheets or any(normal_of(t)))]
        found = [[t] for t in kept] if sheets else oriented(kept)
        self.closing = [t for piece in found if is_closed(piece) for t in piece]
        self.sheets = [t for piece in found if not is_closed(piece) for t in piece]
        self.triangles = self.closing + self.sheets

    @cached_property
    def _met(self) -> tuple[set[Voxel], set[Voxel], set[Voxel]]:
        """Return voxels that the surface meets: in their interior; at all; and those behind faces between voxels."""
        interior, contact, behind = set(), set(), set()
        for triangle in self.triangles:
            for voxel, piece in pieces(triangle, self.side):
                contact.add(voxel)
                interior |= {voxel} if meets_interior(voxel, piece) else set()
            for axis, ((plane, top), facing) in enumerate(zip(spans(triangle), normal_of(triangle), strict=True)):
                if plane == top and plane in range(0, self.side * UNIT + 1, UNIT) and facing:
                    inner = UNIT // 2 + UNIT * min(max(plane // UNIT - (facing > 0), 0), self.side - 1)
                    flat = [tuple(inner if i == axis else v for i, v in enumerate(p)) for p in triangle]
                    behind |= {v for v, piece in pieces(flat, self.side) if meets_interior(v, piece)}
        return interior, contact, behind

    @cached_property
    def _columns(self) -> dict[tuple[int, int], list[Triangle]]:
        at = defaultdict(list)
        for triangle in (t for t in self.closing if any(normal_of(t))):
            for column in product(*(range(low // UNIT, high // UNIT + 1) for low, high in spans(triangle)[:2])):
                at[column].append(triangle)
        return at

    @cached_property
    def _inside(self) -> set[Voxel]:
        found = set()
        for x, y in product(range(self.side), repeat=2):
            points = ((x * UNIT + 1 + 577 * k % (UNIT - 1), y * UNIT + 1 + 1409 * k % (UNIT - 1), 0) for k in TRIES)
            lines = (crossings(self._columns.get((x, y), ()), point, (0, 0, 1)) for point in points)
            line = next(line for line in lines if line is not None)
            inside = (z for z in range(self.side) if sum(sign for t, sign in line if t > z * UNIT + UNIT // 2))
            found |= {(x, y, z) for z in inside} - self._met[0]
        return found

    def touch(self) -> set[Voxel]:
        """Return voxels whose open interior the closed solid meets, and those behind faces between voxels."""
        return self._met[0] | self._met[2] | self._inside

    def surface(self, *, contact: bool) -> set[Voxel]:
        """Return voxels whose open interior the surface meets; with `contact`, the closed voxel."""
        return self._met[1] if contact else self._met[0]

    def surface_within(self, margin: Fraction, *, across: bool = False) -> set[Voxel]:
        """Return voxels that the surface meets at a margin from their sides; `across`: but for those it faces most."""
        found = set()
        for triangle in self.triangles:
            facing = [abs(v) for v in normal_of(triangle)]
            axes = [i for i in range(3) if not across or facing[i] < max(facing) or facing.count(max(facing)) > 1]
            for voxel, piece in pieces(triangle, self.side):
                part = piece if meets_interior(voxel, piece) or not across else ()
                for axis in axes:
                    part = between(part, axis, (voxel[axis] + margin) * UNIT, (voxel[axis] + 1 - margin) * UNIT)
                found |= {voxel} if part else set()
        return found

    def centre(self, *, contact: bool) -> set[Voxel]:
        """Return voxels whose centre lies inside; with `contact`, on the surface counts too."""
        found = set(self._inside)
        for voxel in self._met[0]:
            middle = tuple(v * UNIT + UNIT // 2 for v in voxel)
            near = self._columns.get(voxel[:2], [])  # a steep line stays in the column
            if contact if any(is_on(t, middle) for t in near + self.sheets) else winding(near, middle):
                found.add(voxel)
        return found

    def fractions(self, *, windings: bool = False) -> dict[Voxel, Fraction]:
        """Return which part of each voxel is inside, or with `windings` how often. The mesh must lie in the grid."""
        if any(not 0 <= v <= self.side * UNIT for t in self.closing for p in t for v in p):
            raise ValueError("a part of the mesh lies outside of the grid")
        volumes, covered = defaultdict(Fraction), defaultdict(Fraction)
        for triangle in self.closing:
            for part in cut(triangle, self.closing) if normal_of(triangle)[2] else ():
                above, below = self._beside(triangle, part)
                weight = below - above if windings else bool(below) - bool(above)
                for (x, y, z), piece in pieces(part, self.side) if weight else ():
                    if z == self.side - 1 or min(p[2] for p in piece) < (z + 1) * UNIT:  # or the voxel above has it
                        for t in fan(piece):
                            area = weight * Fraction(abs(normal_of(t)[2]), 2)
                            volumes[x, y, z] += area * (Fraction(sum(p[2] for p in t), 3) - z * UNIT)
                            covered[x, y, z] += area
        for (x, y, z), area in covered.items():
            volumes |= {(x, y, under): volumes[x, y, under] + area * UNIT for under in range(z)}
        return {voxel: volume / UNIT**3 for voxel, volume in volumes.items() if volume}

    def half(self, *, windings: bool = False) -> set[Voxel]:
        """Return voxels of which at least half is inside; with `windings`, volume counts as often as it is enclosed."""
        return {voxel for voxel, part in self.fractions(windings=windings).items() if 2 * abs(part) >= 1}

    def _beside(self, triangle: Triangle, part: Sequence[Point]) -> tuple[int, int]:
        """Find the winding numbers above and below a part. Of triangles at one height, the first is on top."""
        for k in TRIES:  # a point of the part, by weights
            weights = [1 + k * (i + 1) % 97 for i in range(len(part))]
            sums = (sum(w * p[i] for w, p in zip(weights, part, strict=True)) for i in range(3))
            x, y, z = (Fraction(v, sum(weights)) for v in sums)
            column = self._columns[x // UNIT, y // UNIT]
            line = [crossings([t], (x, y, 0), (0, 0, 1)) for t in column]
            if None not in line:
                break
        else:
            raise ArithmeticError("every line meets an edge")
        own = next(i for i, t in enumerate(column) if t is triangle)
        above = sum(f[0][1] for i, f in enumerate(line) if f and (f[0][0], -i) > (z, -own))
        return above, above + line[own][0][1]
