"""Benchmark of the ray tracer's configurations: cycles per pixel against the bound, words per clock, speed simulated.

Usage: ``python bench/rtl.py [--size WxH ...] [--memories DIR] [--rounds N] [--write]``. ``--write`` puts the tables
into ``bench/results/rtl.md`` as well. ``--memories`` is a folder with the published ``house.mem``, which is left out
without. The speed is the median of the rounds, by the processor's time; all else is the same in each.
"""

from __future__ import annotations

import time
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np
from report import ROOT, frame_size, options_of, publish, table
from rtl_scenes import scenes

from voxrt.rtl.configurations import read_configurations
from voxrt.sim._rtl import CONFIGS, FEATURES, Tracer

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from rtl_scenes import Scene

LANES = {name: it.parameters["Lanes"] for name, it in read_configurations().items()}
MATERIALS = np.random.default_rng(1).integers(0, 256, (256, 3), dtype=np.uint8)
MIRRORS = np.ones(256, np.uint8)
BAND = 4
"""Rows whose words are counted together."""
NOTES = (
    "Bound: max(1, words per pixel / lanes). With light and with mirrors the words are those of all rays of a pixel:",
    "camera ray, shadow ray and reflected rays.",
    "",
    "Bound in order: rays start one per clock, from the top of the picture down. Where rays of the sky come first,",
    "lanes wait for rays, and no queue makes up for that. It is the time of a machine that starts rays so, with",
    "endless queues, and lanes of which any takes any ray: the largest of",
    f"r + (words of the rays from ray r on) / lanes, by bands of {BAND} rows.",
)


def frames(scene: Scene, config: str) -> dict[str, dict[str, Any]]:
    """Give the ways in which a configuration shades a scene, as it is asked for them."""
    found: dict[str, dict[str, Any]] = {"plain": {}}
    if "light" in FEATURES[config]:
        found["light, shadows"] = {"light": scene.light, "ambient": 60}
    if "mirrors" in FEATURES[config]:
        found["all mirrors, 2 reflections"] = {"mirrors": MIRRORS, "bounces": 2}
    return found


def band_words(scene: Scene, size: tuple[int, int], config: str, shading: dict[str, Any]) -> NDArray[np.float64]:
    """Count the words that each band of rows reads, from the top down: each as a picture of its own."""
    width, height = size
    tracer = Tracer(config)
    tracer.load(scene.words)
    words = []
    for top in range(0, height, BAND):
        camera = scene.camera.copy()
        camera[1] += camera[3] * (height // 2 - top - BAND // 2)
        words.append(tracer.render(camera, width, BAND, scene.depth, MATERIALS, **shading)["words_read"])
    return np.array(words, dtype=np.float64)


def bound_in_order(words: NDArray[np.float64], rays: int, lanes: int) -> float:
    """Return the clocks of a frame whose bands read these words, and have so many rays each: see NOTES."""
    later = np.cumsum(words[::-1])[::-1] / lanes
    return max(float((np.arange(len(words)) * rays + later).max()), float(len(words) * rays))


def measure(scene: Scene, size: tuple[int, int], rounds: int) -> list[list[str]]:
    rows = []
    pixels = size[0] * size[1]
    in_bands: dict[str, NDArray[np.float64]] = {}
    for config in sorted(CONFIGS, key=lambda name: (LANES[name], len(FEATURES[name]), name)):
        tracer = Tracer(config)
        tracer.load(scene.words)
        for name, shading in frames(scene, config).items():
            times = []
            for _ in range(rounds):
                start = time.process_time()
                frame = tracer.render(scene.camera, *size, scene.depth, MATERIALS, **shading)
                times.append(time.process_time() - start)
            seconds = median(times)
            assert not frame["errors"], frame["errors"]
            cycles, words = frame["cycles"] / pixels, frame["words_read"] / pixels
            bound = max(1, words / LANES[config])
            if name not in in_bands:  # All configurations read the same words.
                in_bands[name] = band_words(scene, size, config, shading)
            in_order = bound_in_order(in_bands[name], BAND * size[0], LANES[config]) / pixels
            ratios = (cycles, bound, cycles / bound, in_order, cycles / in_order)
            row = [scene.name, config, name, str(LANES[config]), f"{words:.2f}", *(f"{ratio:.3f}" for ratio in ratios)]
            row.append(f"{frame['words_read'] / frame['cycles'] / LANES[config]:.4f}")
            row += [f"{count / seconds / 1e6:.2f}" for count in (frame["cycles"], pixels)]
            rows.append(row)
    return rows


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--size", type=frame_size, nargs="+", default=[(256, 256), (640, 480)])
    parser.add_argument("--memories", type=Path, default=ROOT.parent / "shared" / "seed-memories")
    parser.add_argument("--rounds", type=int, default=1)
    options = parser.parse_args()
    heads = ["scene", "configuration", "frame", "lanes", "words per pixel", "cycles per pixel", "bound", "of the bound"]
    heads += ["bound in order", "of it"]
    heads += ["words per clock and lane", "million clocks/s simulated", "million pixels/s simulated"]
    text = "\n".join(NOTES) + "\n"
    for size in options.size:
        rows = [row for scene in scenes(options.memories, size) for row in measure(scene, size, options.rounds)]
        text += f"\n{size[0]}x{size[1]} pixels.\n\n{table(heads, rows)}"
    publish("rtl.md", text, write=options.write)


if __name__ == "__main__":
    main()
