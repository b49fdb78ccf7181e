"""Draw the pictures of the chapter "How a ray walks an octree": ``python docs/walk/draw.py FOLDER``.

``docs/conf.py`` runs it when the manual is built. Two dimensions by ``quadtree.py``, three by voxrt's own
``follow_pixel`` on an example scene. The same pictures, byte for byte, each time. It writes two tables besides, which
the chapter includes: the words of the two rays.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from math import floor
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
import quadtree
import real_ray
import wave_table
from flat_world import (
    DEPTH,
    DIRECTION,
    HIGHLIGHT,
    LINE_COLOURS,
    MATERIALS,
    ORIGIN,
    RAY,
    READINGS,
    ROUNDED_ORIGIN,
    SIDE,
    VISITED,
    WIDTH,
    WORDS,
    WORLD,
    X_COLOUR,
    Y_COLOUR,
    framed,
    label,
    leaves,
    point,
    ray,
    square,
    world,
)
from matplotlib import pyplot as plt
from matplotlib.patches import FancyArrowPatch, Rectangle
from quadtree import AXES, UNIT, Reading, crossing_time

from voxrt.octree.words import EMPTY, is_leaf, material

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw_world() -> Figure:
    """Draw cells on the left, leaves on the right."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 4.1))
    world(right)
    solid = sum(1 for row in WORLD for cell in row if cell.isdigit())
    for y, row in enumerate(reversed(WORLD)):
        for x, cell in enumerate(row):
            colour = MATERIALS[int(cell)] if cell.isdigit() else "white"
            square(left, x, y, 1, facecolor=colour, edgecolor="#bbbbbb", linewidth=0.6)
    left.set(xlim=(-0.3, SIDE + 0.3), ylim=(-0.3, SIDE + 0.3), aspect="equal")
    left.tick_params(labelsize=9, length=0)
    for side in left.spines.values():
        side.set_visible(False)
    left.set_title(f"{SIDE * SIDE} cells, {solid} of them solid", fontsize=11)
    right.set_title(f"the same as {len(leaves())} leaves of a quadtree", fontsize=11)
    for place in (left, right):
        place.set(xticks=range(0, SIDE + 1, 4), yticks=range(0, SIDE + 1, 4))
    return figure


def blocks() -> tuple[dict[int, list[int]], dict[int, tuple[int, int]]]:
    """Give the blocks by the level of their squares, and the word that points to each: its block and its quarter."""
    by_level: dict[int, list[int]] = {}
    parents: dict[int, tuple[int, int]] = {}

    def walk(block: int, level: int) -> None:
        by_level.setdefault(level, []).append(block)
        for child in range(4):
            word = WORDS[block + child]
            if not is_leaf(word):
                parents[word] = (block, child)
                walk(word, level - 1)

    walk(WORDS[0], DEPTH - 1)
    return by_level, parents


def draw_tree() -> Figure:
    """Draw blocks of four words as 2 x 2 squares, with their addresses."""
    by_level, parents = blocks()
    figure, place = plt.subplots(figsize=(WIDTH, 5.4))
    spots: dict[int, tuple[float, float]] = {}
    read = {reading.address for reading in READINGS}
    for level, row in by_level.items():
        for number, block in enumerate(row):
            spots[block] = (10 * (number + 0.5) / len(row), 1.75 * level)
    for block, (x, y) in spots.items():
        for child in range(4):
            word = WORDS[block + child]
            corner = (x - 0.5 + 0.5 * (child & 1), y - 0.5 + 0.5 * (child >> 1))
            colour = MATERIALS.get(material(word), "white") if is_leaf(word) else "#eeeeee"
            address = block + child
            square(place, *corner, 0.5, facecolor=colour, edgecolor="#777777", linewidth=0.8)
            if address in read:
                framed(place, corner[0] + 0.03, corner[1] + 0.03, 0.44, width=2)
            place.text(corner[0] + 0.25, corner[1] + 0.24, str(address), fontsize=9, ha="center", va="center")
        if block in parents:
            above, child = parents[block]
            start = (spots[above][0] - 0.25 + 0.5 * (child & 1), spots[above][1] - 0.25 + 0.5 * (child >> 1) - 0.14)
            arrow = FancyArrowPatch(
                start, (x, y + 0.52), arrowstyle="-|>", mutation_scale=10, color="#555555", zorder=3
            )
            place.add_patch(arrow)
    for level in by_level:
        text = f"squares of\n{1 << level} x {1 << level} cells" if level else "squares of\n1 cell"
        place.text(-0.7, 1.75 * level, text, fontsize=10, ha="right", va="center")
    place.text(5, 1.75 * DEPTH - 0.75, "word 0, the root: pointer to block 1", fontsize=10, ha="center")
    place.set(xlim=(-2.6, 10.2), ylim=(-0.7, 1.75 * DEPTH - 0.3), aspect="equal")
    place.axis("off")
    return figure


def draw_times() -> Figure:
    """Draw the lines that the ray crosses, each with its whole number T."""
    figure, (place, order) = plt.subplots(2, 1, figsize=(WIDTH, 5.6), height_ratios=(4, 1))
    low, high = (1, 2), (10, 7.5)
    place.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    ray(place, point(crossing_time(ORIGIN, DIRECTION, 0, 10) - 8))
    found = []
    for axis, lines in ((0, range(2, 10)), (1, range(3, 8))):
        for line in lines:
            time = crossing_time(ORIGIN, DIRECTION, axis, line)
            x, y = point(time)
            colour = LINE_COLOURS[axis]
            (place.axvline if axis == 0 else place.axhline)(line, color=colour, linewidth=0.7, alpha=0.5, zorder=1)
            if x > high[0] or y > high[1]:
                continue
            place.plot(x, y, "o", color=colour, markersize=6, zorder=6)
            shift = (0.07, -0.30) if axis == 0 else (-0.10, 0.14)
            style = {"fontsize": 10, "color": colour, "ha": "left" if axis == 0 else "right"}
            place.text(x + shift[0], y + shift[1], str(time), **style)
            found.append((time, axis, line))
    place.set_xticks(range(2, 11), [f"x={line}" for line in range(2, 11)], color=X_COLOUR, fontsize=10)
    place.set_yticks(range(3, 8), [f"y={line}" for line in range(3, 8)], color=Y_COLOUR, fontsize=10)
    place.tick_params(length=0)
    last = max(time for time, _, _ in found)
    order.axhline(0, color="#555555", linewidth=1)
    for time, axis, line in sorted(found):
        order.plot(time, 0, "o", color=LINE_COLOURS[axis], markersize=6)
        text = f"{'xy'[axis]}={line}"
        order.text(time, 0.22 if axis == 0 else -0.5, text, fontsize=10, color=LINE_COLOURS[axis], ha="center")
    order.set(xlim=(-5, last + 20), ylim=(-0.8, 0.7), yticks=[])
    order.set_xlabel("T: the order in which the ray crosses the lines", fontsize=11)
    for name in ("left", "right", "top"):
        order.spines[name].set_visible(False)
    return figure


def middle_lines(place: Axes, corner: tuple[int, int], level: int, key: tuple[int, int]) -> str:
    """Draw the middle lines of a square, and say what their comparisons with the key give."""
    half = 1 << level - 1
    lines = []
    for axis in AXES:
        line = corner[axis] + half
        time = crossing_time(ORIGIN, DIRECTION, axis, line)
        start, end = list(corner), list(corner)
        start[axis] = end[axis] = line
        end[1 - axis] += 2 * half
        place.plot((start[0], end[0]), (start[1], end[1]), color=LINE_COLOURS[axis], linewidth=2.2, zorder=5)
        sign, side = ("<", "behind") if (time, axis) <= key else (">", "ahead")
        lines.append(f"{'xy'[axis]} = {line}:  T = {time} {sign} {key[0]}, {side}")
    return "\n".join(lines)


def draw_descent() -> Figure:
    """Draw three pointers, and in which quarter of each square the ray is."""
    figure, places = plt.subplots(1, 3, figsize=(WIDTH, 3.6))
    windows = (((0, 0), (16, 16)), ((0, 0), (8, 8)), ((6, 0), (16, 10)))
    start = next(number for number, reading in enumerate(READINGS) if reading.address == 1)
    chosen = (None, READINGS[start], READINGS[start + 8])
    titles = ("word 0: a pointer", "word 1: a pointer", "word 2: a pointer")
    for place, (low, high), reading, title in zip(places, windows, chosen, titles, strict=True):
        world(place, low, high)
        if reading is None:
            corner, level, key = (0, 0), DEPTH, (0, 1)
        else:
            corner, level, key = reading.corner, reading.level, reading.key
        framed(place, *corner, 1 << level, colour="#555555", width=2)
        place.set_xlabel(middle_lines(place, corner, level, key), fontsize=9.5)
        half = 1 << level - 1
        upper = [crossing_time(ORIGIN, DIRECTION, axis, corner[axis] + half) <= key[0] for axis in AXES]
        framed(place, corner[0] + half * upper[0], corner[1] + half * upper[1], half)
        if key[0]:
            place.plot(*point(key[0]), "o", color=LINE_COLOURS[key[1]], markersize=8, zorder=7)
            ray(place, point(640), point(crossing_time(ORIGIN, DIRECTION, 0, low[0])), dot=False)
        else:
            ray(place, point(380 if level < DEPTH else 640))
        place.set_title(title, fontsize=11)
        place.set(xticks=[], yticks=[])
    return figure


def draw_leaving() -> Figure:
    """Draw an empty leaf with the two lines ahead of the ray."""
    figure, place = plt.subplots(figsize=(WIDTH, 4.0))
    reading = READINGS[2]
    (x, y), size = reading.corner, 1 << reading.level
    world(place, (0, 0), (13, 6.4))
    square(place, x, y, size, facecolor=VISITED, edgecolor="none", zorder=1)
    framed(place, x, y, size)
    ray(place, point(390))
    for axis, line in ((0, x + size), (1, y + size)):
        time = crossing_time(ORIGIN, DIRECTION, axis, line)
        colour = LINE_COLOURS[axis]
        (place.axvline if axis == 0 else place.axhline)(line, color=colour, linewidth=1.6, zorder=3)
        place.plot(*point(time), "o", color=colour, markersize=8, zorder=7)
    place.text(8.3, 5.8, f"x = 8:  T = {crossing_time(ORIGIN, DIRECTION, 0, 8)}", **label(X_COLOUR))
    place.text(8.3, 4.25, f"y = 4:  T = {crossing_time(ORIGIN, DIRECTION, 1, 4)}, the smaller one", **label(Y_COLOUR))
    entered = point(reading.key[0])
    place.plot(*entered, "o", color="#555555", markersize=8, zorder=7)
    place.annotate(
        f"entered at T = {reading.key[0]}", entered, (0.2, 5.1), arrowprops={"arrowstyle": "-", "lw": 0.7}, **label(RAY)
    )
    place.set(xticks=range(0, 13, 4), yticks=(0, 4))
    return figure


def draw_stack() -> Figure:
    """Draw two ways out of a leaf: within its block, and up to the first block."""
    figure, places = plt.subplots(2, 2, figsize=(WIDTH, 7.0), width_ratios=(1.05, 1))
    steps = [(READINGS[5], READINGS[6]), (READINGS[7], READINGS[8])]
    windows = (((3.6, 3.6), (8.4, 8.4)), ((0, 0), (16, 16)))
    for (place, panel), (before, after), (low, high) in zip(places, steps, windows, strict=True):
        world(place, low, high)
        size = 1 << before.level
        square(place, *before.corner, size, facecolor=VISITED, edgecolor="#999999", zorder=1)
        common = 1 << after.level + 1
        framed(
            place,
            *(corner >> after.level + 1 << after.level + 1 for corner in before.corner),
            common,
            colour="#555555",
            width=2,
        )
        framed(place, *before.corner, size, colour=Y_COLOUR, width=2.4)
        framed(place, *after.corner, 1 << after.level)
        ray(place, point(after.key[0] + (60 if after.level == 0 else 190)))
        place.plot(*point(after.key[0]), "o", color=X_COLOUR, markersize=8, zorder=7)
        place.set(xticks=range(4 if low[0] else 0, int(high[0]) + 1, 1 if low[0] else 4))
        place.set(yticks=range(4 if low[0] else 0, int(high[0]) + 1, 1 if low[0] else 4))
        panel.axis("off")
        panel.set(xlim=(0, 10), ylim=(0, 10))
        _draw_stack(panel, before, after)
    return figure


def _draw_stack(panel: Axes, before: Reading, after: Reading) -> None:
    old, step = before.corner[0], 1 << before.level
    new = old + step
    changed = after.level
    mono = {"fontsize": 12, "family": "monospace"}
    lines = (
        (f"corner   x = {old:2d}  {old:04b}", "black"),
        (f"+ side       {step:2d}  {step:04b}", "black"),
        (f"next     x = {new:2d}  {new:04b}", "black"),
        (f"changed          {old ^ new:04b}", X_COLOUR),
    )
    for number, (line, colour) in enumerate(lines):
        panel.text(0, 9.2 - 0.95 * number, line, color=colour, **mono)
    panel.text(0, 5.0, f"highest changed bit: {changed}", fontsize=11, color=X_COLOUR)
    panel.text(0, 4.0, "stack", fontsize=11, weight="bold")
    shown = sorted((level, block) for level, block in before.stack.items() if level >= before.level)
    for number, (level, block) in enumerate(reversed(shown)):
        y = 3.0 - 0.9 * number
        used = level == changed
        if used:
            panel.add_patch(Rectangle((-0.1, y - 0.25), 9.9, 0.85, facecolor="#fde9a8", edgecolor="none"))
        arrow = f"  read word {after.address}" if used else ""
        panel.text(0, y, f"level {level}: block {block}{arrow}", **mono)


def draw_tie() -> Figure:
    """Draw a ray through a corner: x goes first, in either tree."""
    figure, places = plt.subplots(1, 2, figsize=(WIDTH, 3.9))
    for place, whole in zip(places, (True, False), strict=True):
        squares = [(0, 0, 2), (2, 0, 2), (0, 2, 2), (2, 2, 2)]
        if not whole:
            squares[0:1] = [(0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1)]
        path = {(0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 0, 1), (1, 0, 1), (1, 1, 1)}
        for x, y, side in squares:
            colour = VISITED if (x, y, side) in path else "white"
            square(place, x, y, side, facecolor=colour, edgecolor="#999999", linewidth=1)
        ray(place, (3.7, 3.7), (0.3, 0.3))
        place.axvline(2, color=X_COLOUR, linewidth=1.5)
        place.axhline(2, color=Y_COLOUR, linewidth=1.5)
        place.plot(2, 2, "o", color=HIGHLIGHT, markersize=10, zorder=7)
        number = 1
        for x, y, side in ((0, 0, 2), (2, 0, 2), (2, 2, 2)) if whole else (
            (0, 0, 1), (1, 0, 1), (1, 1, 1), (2, 0, 2), (2, 2, 2)
        ):  # fmt: skip
            place.text(x + side * 0.75, y + side * 0.22, str(number), fontsize=13, ha="center", va="center")
            number += 1
        place.set(xlim=(-0.05, 4.05), ylim=(-0.05, 4.05), aspect="equal", xticks=[0, 2, 4], yticks=[0, 2, 4])
        place.tick_params(labelsize=9, length=0)
        for side in place.spines.values():
            side.set_visible(False)
        place.set_title("one leaf of 2 x 2 cells" if whole else "the same as four leaves", fontsize=11)
    return figure


def follow_rounded(parts: int) -> list[tuple[Fraction, Fraction]]:
    """Walk from leaf to leaf by positions that are rounded down to 1 / parts of a cell, which goes wrong."""
    here = [Fraction(start, UNIT) for start in ROUNDED_ORIGIN]
    points = [(here[0], here[1])]
    while True:
        x, y, level, material = next(
            leaf for leaf in leaves() if all(0 <= here[axis] - leaf[axis] < 1 << leaf[2] for axis in AXES)
        )
        if material:
            return points
        steps = [((x, y)[axis] + (1 << level) - here[axis]) / DIRECTION[axis] for axis in AXES]
        axis = 0 if steps[0] <= steps[1] else 1
        moved = [here[other] + steps[axis] * DIRECTION[other] for other in AXES]
        here = [moved[other] if other == axis else Fraction(floor(moved[other] * parts), parts) for other in AXES]
        points.append((here[0], here[1]))


def draw_rounding() -> Figure:
    """Draw a ray twice: exactly, and by positions rounded to quarters of a cell."""
    figure, place = plt.subplots(figsize=(WIDTH, 4.9))
    world(place, (0, 1), (14, 10))
    exact = quadtree.follow(WORDS, DEPTH, ROUNDED_ORIGIN, DIRECTION)
    begin = (ROUNDED_ORIGIN[0] / UNIT, ROUNDED_ORIGIN[1] / UNIT)
    end = point(exact[-1].key[0], ROUNDED_ORIGIN)
    ray(place, end, begin)
    wrong = np.array([[float(part) for part in spot] for spot in follow_rounded(4)])
    place.plot(wrong[:, 0], wrong[:, 1], "o--", color=X_COLOUR, markersize=6, linewidth=1.5, zorder=6)
    place.text(0.3, 5.6, "exact:\nhits the first block", **label(RAY))
    place.text(8.3, 5.0, "rounded to 1/4 cell:\nmisses the first block", **label(X_COLOUR))
    place.set(xticks=range(0, 15, 4), yticks=range(4, 11, 4))
    return figure


def draw_walk() -> Figure:
    """Draw all leaves that the ray reads, with the numbers of their steps."""
    figure, place = plt.subplots(figsize=(WIDTH, 6.0))
    world(place, (0, 0), (16, 11))
    for number, reading in enumerate(READINGS, 1):
        if not is_leaf(reading.word):
            continue
        side = 1 << reading.level
        if reading.word == EMPTY:
            square(place, *reading.corner, side, facecolor=VISITED, edgecolor="#777777", linewidth=0.8, zorder=1)
        x, y = reading.corner
        place.text(
            x + side * 0.5, y + side * 0.17, str(number), fontsize=12 if side > 1 else 10, ha="center", va="center"
        )
    ray(place, point(READINGS[-1].key[0]))
    for reading in READINGS[2:]:
        place.plot(*point(reading.key[0]), "o", color=LINE_COLOURS[reading.key[1]], markersize=5, zorder=7)
    place.set(xticks=range(0, 17, 4), yticks=range(0, 9, 4))
    return figure


def flat_table() -> str:
    """Give the words of the two-dimensional ray as a table."""
    lines = ["| step | word | is | square | entered at T | level |", "|--:|--:|---|---|---|--:|"]
    for number, reading in enumerate(READINGS, 1):
        x, y = reading.corner
        side = 1 << reading.level
        what = f"pointer to {reading.word}"
        if is_leaf(reading.word):
            what = "leaf, empty" if reading.word == EMPTY else f"leaf, material {material(reading.word)}"
        entered = f"{reading.key[0]}, {'xy'[reading.key[1]]}" if reading.key[0] else "start"
        where = f"x {x} to {x + side}, y {y} to {y + side}"
        lines.append(f"| {number} | {reading.address} | {what} | {where} | {entered} | {reading.level} |")
    return "\n".join(lines) + "\n"


def main(folder: Path) -> None:
    """Draw all pictures and write the tables."""
    mpl.use("Agg")
    folder.mkdir(parents=True, exist_ok=True)
    rom, path, picture = real_ray.trace()
    pictures = {
        "world": draw_world,
        "tree": draw_tree,
        "times": draw_times,
        "descent": draw_descent,
        "leaving": draw_leaving,
        "stack": draw_stack,
        "tie": draw_tie,
        "rounding": draw_rounding,
        "walk": draw_walk,
        "real": lambda: real_ray.draw(path, picture),
    }
    saving = {
        "dpi": 150,
        "facecolor": "white",
        "bbox_inches": "tight",
        "pad_inches": 0.1,
        "metadata": {"Software": None},
    }
    with mpl.rc_context({"font.family": "DejaVu Sans", "figure.constrained_layout.use": True}):
        for name, draw in pictures.items():
            figure = draw()
            figure.savefig(folder / f"{name}.png", **saving)
            plt.close(figure)
    (folder / "walk.md").write_text(flat_table(), encoding="utf-8")
    (folder / "real.md").write_text(real_ray.table(rom, path), encoding="utf-8")
    (folder / "wave.md").write_text(wave_table.table(rom, path), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
