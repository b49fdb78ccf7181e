"""The pixel of an example scene in the chapter "How a ray walks an octree": its picture and its table.

voxrt itself traces the ray.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from flat_world import RAY, WIDTH
from matplotlib import pyplot as plt
from matplotlib.patches import Rectangle

import voxrt
from voxrt import sim

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SCENE, SCENE_DEPTH = "courtyard.glb", 5
PICTURE_SIZE, PIXEL = (320, 240), (170, 90)


def trace() -> tuple[voxrt.Rom, sim.RayPath, np.ndarray]:
    """Trace a pixel of an example scene."""
    rom = voxrt.build(EXAMPLES / SCENE, depth=SCENE_DEPTH).rom
    camera = voxrt.aim_camera(rom, PICTURE_SIZE)
    path = sim.follow_pixel(rom.octree, camera, PICTURE_SIZE, PIXEL)
    return rom, path, voxrt.render(rom, camera, size=PICTURE_SIZE, engine="model").colour


def box_edges(low: tuple[int, int, int], high: tuple[int, int, int]) -> list[np.ndarray]:
    """Give the twelve edges of a box, in matplotlib's axes: x, z, y."""
    edges = []
    for axis in range(3):
        for corner in range(4):
            first, second = [0, 0, 0], [0, 0, 0]
            others = [other for other in range(3) if other != axis]
            for bit, other in enumerate(others):
                first[other] = second[other] = (low, high)[corner >> bit & 1][other]
            first[axis], second[axis] = low[axis], high[axis]
            edges.append(np.array([[first[0], first[2], first[1]], [second[0], second[2], second[1]]]))
    return edges


def draw(path: sim.RayPath, picture: np.ndarray) -> Figure:
    """Draw the pixel, and the leaves that its ray goes through."""
    figure = plt.figure(figsize=(WIDTH, 4.4))
    left = figure.add_subplot(1, 2, 1)
    column, row = PIXEL
    left.imshow(picture)
    left.add_patch(Rectangle((column - 8, row - 8), 16, 16, facecolor="none", edgecolor="white", linewidth=2.4))
    left.axis("off")
    left.set_title(f"pixel {column},{row}", fontsize=11)
    place = figure.add_subplot(1, 2, 2, projection="3d")
    found = [reading for reading in path.readings if reading.is_leaf]
    for reading in found:
        solid = reading.material
        style = {"color": "#d05030" if solid else "#4f86c0", "linewidth": 2.2 if solid else 0.9}
        for edge in box_edges(reading.corner, reading.end):
            place.plot(*edge.T, **style)
    points = np.array([path.point(reading.time) for reading in found])
    place.plot(points[:, 0], points[:, 2], points[:, 1], "o-", color=RAY, markersize=4, linewidth=1.6)
    place.set_xlabel("x", fontsize=11)
    place.set_ylabel("z", fontsize=11)
    place.set_zlabel("y", fontsize=11)
    place.tick_params(labelsize=9)
    for axis in (place.xaxis, place.yaxis, place.zaxis):
        axis.set_major_locator(mpl.ticker.MultipleLocator(4))
    place.set_aspect("equal")
    place.view_init(elev=18, azim=-68)
    place.set_title("empty leaves blue, the leaf hit red", fontsize=11)
    return figure


def table(rom: voxrt.Rom, path: sim.RayPath) -> str:
    """Give the words of the three-dimensional ray as a table."""
    lines = ["| step | word | is | octant's corner | side | entered at T |", "|--:|--:|---|---|--:|--:|"]
    for number, reading in enumerate(path.readings, 1):
        what = f"pointer to {reading.word:#x}"
        if reading.is_leaf:
            what = f"leaf, {rom.materials[reading.material].name}" if reading.material else "leaf, empty"
        corner = ", ".join(map(str, reading.corner))
        entered = f"{reading.time:,} {'xyz'[reading.axis]}" if reading.axis < 3 else "start"
        lines.append(f"| {number} | {reading.address:#x} | {what} | {corner} | {1 << reading.level} | {entered} |")
    return "\n".join(lines) + "\n"
