"""Filling open meshes: the time of ``--fill solid`` beside that of ``--fill surface``, and how it grows with the depth.

Usage: ``python bench/holes.py [--depths 6,7,8,9] [--write]``. A made set of scenes: spheres with holes, sheets that
cross, loose boxes without a side, cars made of patches that do not meet. Times are seconds of all processors, which
other work on the machine changes little: the least of several runs, from arrays to sparse voxels. ``--write`` puts the
table into ``bench/results/holes.md`` as well.
"""

from __future__ import annotations

import platform
import time
from itertools import pairwise

import numpy as np
from report import options_of, write_page

import voxrt
from voxrt.voxelize import fit_grid, voxelize

LONG = 2.0
"""Seconds from which one run is enough."""


def sphere_with_holes(rings: int, holes: int) -> tuple[np.ndarray, np.ndarray]:
    """Give a sphere of about 4 * rings**2 triangles, of which those around `holes` points are left out."""
    polar, around = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1)[:-1])
    points = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=-1)
    columns, rows = polar.shape
    a = (np.arange(columns)[:, None] * rows + np.arange(rows - 1)).ravel()
    b = ((np.arange(columns)[:, None] + 1) % columns * rows + np.arange(rows - 1)).ravel()
    faces = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
    flat = points.reshape(-1, 3)
    middles = flat[faces].mean(axis=1)
    middles /= np.linalg.norm(middles, axis=1, keepdims=True)
    centres = np.random.default_rng(1).normal(size=(holes, 3))
    centres /= np.linalg.norm(centres, axis=1, keepdims=True)
    keep = np.ones(len(faces), np.bool_)
    for centre in centres:
        keep &= middles @ centre < 1 - 0.3 / holes
    return flat, faces[keep]


def patch(corner: np.ndarray, along: np.ndarray, across: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Give a flat patch of 2 * steps**2 triangles."""
    u, v = np.meshgrid(np.linspace(0, 1, steps + 1), np.linspace(0, 1, steps + 1), indexing="ij")
    points = corner + u[..., None] * along + v[..., None] * across
    a = (np.arange(steps)[:, None] * (steps + 1) + np.arange(steps)).ravel()
    faces = np.concatenate([np.stack([a, a + steps + 1, a + 1], 1), np.stack([a + 1, a + steps + 1, a + steps + 2], 1)])
    return points.reshape(-1, 3), faces


def joined(pieces: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    starts = np.cumsum([0, *(len(points) for points, _ in pieces[:-1])])
    return (
        np.concatenate([points for points, _ in pieces]),
        np.concatenate([faces + start for (_, faces), start in zip(pieces, starts, strict=True)]),
    )


def crossing_sheets(sheets: int, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Give sheets of random directions through one another."""
    random = np.random.default_rng(2)
    pieces = []
    for _ in range(sheets):
        along, across = random.normal(size=(2, 3))
        pieces.append(patch(random.uniform(-1, 1, 3) - (along + across) / 2, along, across, steps))
    return joined(pieces)


def box_sides(low: np.ndarray, size: np.ndarray, sides: int, steps: int, gap: float) -> list:
    """Give the first `sides` sides of a box, outwards, each drawn in by `gap` of its size."""
    pieces = []
    for axis, far in ((0, 0), (0, 1), (1, 0), (2, 0), (2, 1), (1, 1))[:sides]:
        along, across = np.zeros(3), np.zeros(3)
        u, v = (axis + 1) % 3, (axis + 2) % 3
        if not far:
            u, v = v, u
        along[u], across[v] = size[u] * (1 - 2 * gap), size[v] * (1 - 2 * gap)
        corner = low + gap * (np.eye(3)[u] * size[u] + np.eye(3)[v] * size[v])
        corner[axis] += far * size[axis]
        pieces.append(patch(corner, along, across, steps))
    return pieces


def loose_boxes(count: int, sides: int) -> tuple[np.ndarray, np.ndarray]:
    """Give boxes at random places, of which each has the first `sides` sides; with six they do not share vertices."""
    random = np.random.default_rng(3)
    pieces = []
    for _ in range(count):
        size = random.uniform(0.2, 1, 3) * 1.5 / count ** (1 / 3)
        pieces += box_sides(random.uniform(-1, 1, 3), size, sides, 1, 0)
    return joined(pieces)


def car_of_patches(steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Give a body, a cabin and wheels, each of patches with gaps between them, and no floor."""
    pieces = box_sides(np.array([-2.0, 0.3, -0.8]), np.array([4.0, 0.7, 1.6]), 6, steps, 0.004)
    pieces += box_sides(np.array([-1.0, 1.0, -0.7]), np.array([2.0, 0.6, 1.4]), 5, steps, 0.004)
    for x in (-1.3, 1.3):
        for z in (-0.8, 0.6):
            pieces += box_sides(np.array([x - 0.3, 0, z]), np.array([0.6, 0.6, 0.2]), 6, max(1, steps // 4), 0.01)
    return joined(pieces)


SCENES = {
    "sphere, 1 hole": lambda: sphere_with_holes(50, 1),
    "sphere, 20 holes": lambda: sphere_with_holes(50, 20),
    "sphere, 300 holes": lambda: sphere_with_holes(160, 300),
    "12 crossing sheets": lambda: crossing_sheets(12, 15),
    "200 crossing sheets": lambda: crossing_sheets(200, 10),
    "800 boxes without a lid": lambda: loose_boxes(800, 5),
    "16,000 boxes of loose sides": lambda: loose_boxes(16000, 6),
    "car of patches": lambda: car_of_patches(12),
    "fine car of patches": lambda: car_of_patches(75),
}


def seconds(scene: voxrt.Scene, depth: int, fill: str) -> float:
    """Give the least processor seconds of up to five runs."""
    grid = fit_grid(scene, depth=depth)
    taken = []
    while len(taken) < 5:
        start = time.process_time()
        voxelize(scene, grid, fill=fill)
        taken.append(time.process_time() - start)
        if taken[-1] > LONG:
            break
    return min(taken)


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--depths", default="6,7,8,9", help="levels, with commas between")
    parser.add_argument("--scenes", default="", help="only those whose name has this")
    options = parser.parse_args()
    depths = [int(depth) for depth in options.depths.split(",")]
    columns = " | ".join(f"depth {depth}" for depth in depths)
    lines = [f"| scene | triangles | {columns} | most growth |", "|---|--:|" + "--:|" * (len(depths) + 1)]
    print("\n".join(lines))
    for name, make in SCENES.items():
        if options.scenes not in name:
            continue
        vertices, faces = make()
        scene = voxrt.mesh_scene(vertices, faces)
        solid = [seconds(scene, depth, "solid") for depth in depths]
        surface = [seconds(scene, depth, "surface") for depth in depths]
        growth = max((after / before for before, after in pairwise(solid)), default=1.0)
        times = " | ".join(f"{1e3 * a:,.0f} ({a / b:.1f})" for a, b in zip(solid, surface, strict=True))
        lines.append(f"| {name} | {len(faces):,} | {times} | {growth:.1f} |")
        print(lines[-1], flush=True)
    if options.write:
        about = (
            "Processor milliseconds of `--fill solid` by depth, from arrays to sparse voxels, and in parentheses that "
            "time by that of `--fill\nsurface`, by `bench/holes.py`. "
            f"{platform.machine()}, Python {platform.python_version()}; the least of up to five runs.\n"
        )
        write_page("holes.md", f"# Holes\n\n{about}\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
