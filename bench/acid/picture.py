"""A small picture of a case: its triangles seen from a corner, those that face away in red, as SVG."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from acid.checker import UNIT, cross, dot, edges, minus, volume6

if TYPE_CHECKING:
    from acid.cases import Case
    from acid.checker import Point, Triangle

SIZE = 120
RIGHT, UP, TOWARDS = (3, -3, 0), (-1, -1, 4), (2, 2, 1)
"""Where the picture's axes point in the grid; z is up."""
LIGHT = (5, 2, 9)


def picture_of(case: Case) -> str:
    """Return the text of an SVG file."""
    side = UNIT * 2**case.depth
    middle = (side // 2,) * 3

    def place(point: Point) -> str:
        p = minus(point, middle)
        x, y = (SIZE / 2 + sign * dot(axis, p) / side * SIZE * 0.14 for axis, sign in ((RIGHT, 1), (UP, -1)))
        return f"{x:.1f},{y:.1f}"

    def outline(points: list[Point]) -> str:
        return "M" + " ".join(place(p) for p in points)

    corners = [tuple(side * (i >> axis & 1) for axis in range(3)) for i in range(8)]
    frame = "".join(outline([corners[i], corners[i | bit]]) for i in range(8) for bit in (1, 2, 4) if not i & bit)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}" height="{SIZE}" stroke-linejoin="round">',
        f'<path d="{frame}" stroke="#bbb" stroke-width=".6" fill="none"/>',
        '<g stroke="#333" stroke-width=".4" fill-opacity=".8">',
    ]
    backs = is_seen_from_behind(case.triangles)
    for triangle in sorted(case.triangles, key=lambda t: (sum(dot(TOWARDS, p) for p in t), t)):
        a, b, c = triangle
        normal = cross(minus(b, a), minus(c, a))
        length = dot(normal, normal) ** 0.5 or 1
        shade = abs(dot(LIGHT, normal)) / length / dot(LIGHT, LIGHT) ** 0.5
        bright = round(110 + 130 * shade)
        facing = dot(TOWARDS, normal) >= 0
        colour = f"#{bright * 7 // 10:02x}{bright * 8 // 10:02x}{bright:02x}" if facing else f"#{bright:02x}6050"
        if facing or backs:
            lines.append(f'<path fill="{colour}" d="{outline(list(triangle))}z"/>')
    return "\n".join([*lines, "</g></svg>", ""])


def is_seen_from_behind(triangles: list[Triangle]) -> bool:
    """Say whether backs may be seen: where the surface is open or turned."""
    walked = Counter(edge for triangle in triangles for edge in edges(triangle))
    return any(walked[a, b] != walked[b, a] for a, b in walked) or volume6(triangles) <= 0
