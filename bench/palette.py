"""Compare the palette with Pillow's quantizer, which voxrt 0.1 used: python bench/palette.py ASSET ...

Points are taken evenly over each scene's textured and vertex-coloured triangles. The table shows the mean CIEDE2000
between their colours and those of the palette's entries, and the seconds of the quantizer.
"""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from ciede2000 import ciede2000, lab
from PIL import Image

from voxrt.voxelize import load
from voxrt.voxelize._native import quantize
from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.colour.srgb import linear_from_srgb, srgb_from_linear

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from voxrt.voxelize import Scene

POINTS = 1 << 16
COUNTS = (8, 32, 254)


def colours_of(scene: Scene) -> NDArray[np.uint8]:
    """Return the sRGB colours of points on the scene's surfaces, even by area."""
    random = np.random.default_rng(1)
    found = []
    for mesh in {id(one.mesh): one.mesh for one in scene.objects}.values():
        if mesh.appearance is None:
            continue
        painted = np.flatnonzero(mesh.appearance.rows >= 0)
        corners = mesh.positions[mesh.triangles[painted]].astype(np.float64)
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        if not areas.any():
            continue
        chosen = painted[random.choice(len(painted), POINTS // 4, p=areas / areas.sum())]
        weights = random.dirichlet((1, 1, 1), len(chosen))
        found.append(srgb_from_linear(sample(mesh.appearance, chosen, weights)[:, :3]))
    every = np.concatenate(found)
    return every[random.choice(len(every), min(POINTS, len(every)), replace=False)]


def ours(colours: NDArray[np.uint8], count: int) -> NDArray[np.uint8]:
    palette, rows = quantize(colours, np.ones(len(colours)), count)
    return palette[rows]


def pillows(colours: NDArray[np.uint8], count: int) -> NDArray[np.uint8]:
    """Return the same by Pillow, each entry the mean of its group in linear light, as voxrt 0.1 did."""
    reduced = Image.fromarray(colours[None]).quantize(
        count, Image.Quantize.MAXCOVERAGE, kmeans=1, dither=Image.Dither.NONE
    )
    rows = np.asarray(reduced)[0]
    linear = linear_from_srgb(colours)
    sums = np.stack([np.bincount(rows, linear[:, channel], 256) for channel in range(3)], axis=1)
    means = sums / np.maximum(np.bincount(rows, minlength=256), 1)[:, None]
    return srgb_from_linear(means)[rows]


def measured(method: Callable[[], NDArray[np.uint8]], seen: NDArray[np.float64]) -> tuple[float, float]:
    start = perf_counter()
    found = method()
    seconds = perf_counter() - start
    return float(ciede2000(seen, lab(linear_from_srgb(found))).mean()), seconds


def main() -> None:
    if not sys.argv[1:]:
        sys.exit(__doc__)
    print("| asset | colours | Pillow: CIEDE2000 | voxrt | Pillow: ms | voxrt |\n|---|--:|--:|--:|--:|--:|")
    for path in map(Path, sys.argv[1:]):
        colours = colours_of(load(path))
        seen = lab(linear_from_srgb(colours))
        for count in COUNTS:
            old, new = (measured(partial(method, colours, count), seen) for method in (pillows, ours))
            print(
                f"| `{path.name}` | {count} | {old[0]:.3f} | {new[0]:.3f} | {old[1] * 1e3:.0f} | {new[1] * 1e3:.0f} |"
            )


if __name__ == "__main__":
    main()
