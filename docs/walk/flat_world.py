"""The world in two dimensions of the chapter "How a ray walks an octree", its ray, and how they are drawn."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import quadtree
from matplotlib.patches import FancyArrowPatch, Rectangle
from quadtree import UNIT

from voxrt.octree.words import is_leaf, material

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WORLD = [
    "................",
    "................",
    "................",
    "................",
    "................",
    "................",
    "............2222",
    "............2222",
    "....11......2222",
    "....11......2222",
    "....11..........",
    "................",
    "................",
    "................",
    "........33333333",
    "........33333333",
]
DEPTH = 4
SIDE = 1 << DEPTH
WORDS = quadtree.build(WORLD)
ORIGIN, DIRECTION = (24, 36), (7, 4)
ROUNDED_ORIGIN = (16, 36)  # the same direction from here shows what rounding does
READINGS = quadtree.follow(WORDS, DEPTH, ORIGIN, DIRECTION)

MATERIALS = {1: "#d9744c", 2: "#8c9bab", 3: "#7fae5a"}
VISITED = "#d6e6f5"
X_COLOUR, Y_COLOUR = "#b3262a", "#1f5fa8"  # lines x = ..., lines y = ...
LINE_COLOURS = (X_COLOUR, Y_COLOUR)
RAY = "#1a1a1a"
HIGHLIGHT = "#f5b700"
WIDTH = 7.6  # inches


def leaves() -> list[tuple[int, int, int, int]]:
    """Give the quadtree's leaves: x, y, level, material."""
    found = []

    def walk(word: int, x: int, y: int, level: int) -> None:
        if is_leaf(word):
            found.append((x, y, level, material(word)))
            return
        half = 1 << level - 1
        for child in range(4):
            walk(WORDS[word + child], x + half * (child & 1), y + half * (child >> 1), level - 1)

    walk(WORDS[0], 0, 0, DEPTH)
    return found


def point(time: int, origin: tuple[int, int] = ORIGIN) -> tuple[float, float]:
    """Give the point of the ray at T, in cells."""
    scale = DIRECTION[0] * DIRECTION[1]
    x, y = (float((start + Fraction(time * step, scale)) / UNIT) for start, step in zip(origin, DIRECTION, strict=True))
    return x, y


def square(place: Axes, x: float, y: float, side: float, **style: object) -> None:
    """Draw a square."""
    place.add_patch(Rectangle((x, y), side, side, **style))


def world(place: Axes, low: tuple[float, float] = (0, 0), high: tuple[float, float] = (SIDE, SIDE)) -> None:
    """Draw the leaves in a window of the world."""
    for x, y, level, kind in leaves():
        square(place, x, y, 1 << level, facecolor=MATERIALS.get(kind, "white"), edgecolor="#999999", linewidth=0.8)
    margin = 0.02 * (high[0] - low[0])
    place.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")
    place.tick_params(labelsize=9, length=0)
    for side in place.spines.values():
        side.set_visible(False)


def ray(place: Axes, end: tuple[float, float], start: tuple[float, float] | None = None, **style: object) -> None:
    """Draw the ray as an arrow, its start as a dot."""
    begin = start or point(0)
    if style.pop("dot", True):
        place.plot(*begin, "o", color=RAY, markersize=6, zorder=5)
    arrow = {"color": RAY, "linewidth": 1.8, "arrowstyle": "-|>", "mutation_scale": 14, "shrinkA": 0, "shrinkB": 0}
    place.add_patch(FancyArrowPatch(begin, end, zorder=4, **(arrow | style)))


def framed(place: Axes, x: float, y: float, side: float, *, colour: str = HIGHLIGHT, width: float = 3) -> None:
    """Draw a frame around a square."""
    square(place, x, y, side, facecolor="none", edgecolor=colour, linewidth=width, zorder=6)


def label(colour: str) -> dict[str, object]:
    """Give the style of a text that stands on a drawing."""
    box = {"facecolor": "white", "alpha": 0.9, "edgecolor": "none", "pad": 1.5}
    return {"fontsize": 11, "color": colour, "bbox": box, "zorder": 8}
