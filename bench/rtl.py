"""Benchmark of the ray tracer's configurations: cycles a pixel against the bound, words a clock, speed simulated.

Usage: ``python bench/rtl.py [--size WxH ...] [--memories DIR] [--write]``. ``--write`` puts the tables into
``bench/results/rtl.md`` as well. ``--memories`` is a folder with the published ``house.mem``, which is left out
without.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import from_dense
from voxrt.sim._rtl import CONFIGS, Tracer

if TYPE_CHECKING:
    from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "bench" / "results" / "rtl.md"
LANES = {"tiny": 1, "duo": 2, "quad": 4, "octo": 8, "z1": 16, "banked": 16}
MATERIALS = np.random.default_rng(1).integers(0, 256, (256, 3), dtype=np.uint8)


@dataclass(frozen=True, eq=False)
class Scene:
    """A memory and where it is seen from."""

    name: str
    words: NDArray[np.uint32]
    depth: int
    camera: NDArray[np.int32]


def grid(side: int) -> NDArray[np.float64]:
    """Give the middles of voxels, indexed [axis, x, y, z]."""
    return np.stack(np.meshgrid(*[np.arange(side) + 0.5] * 3, indexing="ij"))


def terrain(depth: int) -> NDArray[np.uint8]:
    """Make hills of a few waves."""
    side = 1 << depth
    x, y, z = grid(side)
    height = side / 3 + sum(
        side / (8 * f) * np.sin(f * 6.3 * x / side + f) * np.cos(f * 5.1 * z / side) for f in (1, 2, 3.7, 7)
    )
    return np.where(y < height, np.where(y < side / 3, 1, 2), 0).astype(np.uint8)


def sphere_and_boxes(depth: int) -> NDArray[np.uint8]:
    """Make a sphere between boxes."""
    side = 1 << depth
    place = grid(side) / side
    voxels = np.where(((place - 0.55) ** 2).sum(axis=0) < 0.06, 1, 0).astype(np.uint8)
    for number, corner in enumerate([(0.1, 0, 0.2), (0.7, 0, 0.1), (0.15, 0.1, 0.7), (0.75, 0, 0.75)]):
        low = np.array(corner)[:, None, None, None]
        voxels[((place >= low) & (place < low + 0.17)).all(axis=0)] = number + 2
    voxels[:, 0] = 6
    return voxels


def menger(depth: int) -> NDArray[np.uint8]:
    """Make a Menger sponge of four steps, 81 voxels a side."""
    x, y, z = np.meshgrid(*[np.arange(81)] * 3, indexing="ij")
    solid = np.ones((81,) * 3, bool)
    for power in (1, 3, 9, 27):
        middle = sum((axis // power % 3 == 1).astype(int) for axis in (x, y, z))
        solid &= middle < 2
    voxels = np.zeros((1 << depth,) * 3, np.uint8)
    voxels[20:101, 20:101, 20:101] = solid
    return voxels


def corner_camera(depth: int, size: tuple[int, int]) -> NDArray[np.int32]:
    """Look at the world's middle from above its near corner; the world fills the picture."""
    side = 1 << depth
    eye = np.array([-0.25, 1.1, -0.3]) * side
    look = np.array([0.5, 0.45, 0.5]) * side - eye
    look /= np.linalg.norm(look)
    right = np.cross(look, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    scale = 0.9 / max(size)
    frame = np.array([look, right * scale, up * scale]) * 30000
    return np.array([np.rint(eye * 16), *np.rint(frame)], np.int32)


def published_house(folder: Path) -> NDArray[np.uint32]:
    """Read the published house; its air is both FFFFFFF0 and FFFFFF00."""
    words = np.array([int(word, 16) for word in (folder / "house.mem").read_text().split()], np.uint32)
    leaf = words >= 0xFFFFFFF0
    words[leaf] = 0xFFFFFF00 | (words[leaf] & 7)
    return words


def scenes(memories: Path, size: tuple[int, int]) -> list[Scene]:
    """Make the benchmark's scenes."""
    found = []
    if (memories / "house.mem").exists():
        camera = np.array([[450 * 16, 600 * 16, 300 * 16], [0, 0, 90], [1, 0, 0], [0, 1, 0]], np.int32)
        found.append(Scene("published house, depth 10", published_house(memories), 10, camera))
    for name, make in (("terrain", terrain), ("sphere and boxes", sphere_and_boxes), ("Menger sponge", menger)):
        words = from_dense(make(7)).words
        found.append(Scene(f"{name}, 128 a side", words, 7, corner_camera(7, size)))
    return found


def measure(scene: Scene, size: tuple[int, int]) -> list[str]:
    """Render a scene with every configuration and give the table's rows."""
    rows = []
    for config in sorted(CONFIGS, key=lambda name: (LANES[name], name)):
        tracer = Tracer(config)
        tracer.load(scene.words)
        start = time.process_time()
        frame = tracer.render(scene.camera, *size, scene.depth, MATERIALS)
        seconds = time.process_time() - start
        pixels = size[0] * size[1]
        cycles, words = frame["cycles"] / pixels, frame["words_read"] / pixels
        bound = max(1, words / LANES[config])
        rows.append(
            f"| {scene.name} | {config} | {LANES[config]} | {words:.2f} | {cycles:.3f} | {bound:.3f} "
            f"| {cycles / bound:.3f} | {frame['words_read'] / frame['cycles'] / LANES[config]:.4f} "
            f"| {frame['cycles'] / seconds / 1e6:.2f} | {pixels / seconds / 1e6:.2f} |"
        )
    return rows


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", nargs="+", default=["256x256", "640x480"])
    parser.add_argument("--memories", type=Path, default=ROOT.parent / "shared" / "seed-memories")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    heads = ["scene", "configuration", "lanes", "words a ray", "cycles a pixel", "bound", "of the bound"]
    heads += ["words a clock and lane", "million clocks/s simulated", "million pixels/s simulated"]
    lines = []
    for size in options.size:
        width, height = (int(side) for side in size.split("x"))
        lines += [f"{size} pixels. Bound: max(1, words a ray / lanes).", ""]
        lines += [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
        for scene in scenes(options.memories, (width, height)):
            lines += measure(scene, (width, height))
        lines.append("")
    text = "\n".join(lines)
    print(text, end="")
    if options.write:
        RESULTS.parent.mkdir(exist_ok=True)
        RESULTS.write_text(text)


if __name__ == "__main__":
    main()
