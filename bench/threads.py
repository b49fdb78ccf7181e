"""Speed of the verilated ray tracer by the threads that simulate it.

Usage: ``python bench/threads.py [--threads N] [--rounds N] [--size WxH] [--write]``.

Builds the extension module twice by the project's own CMake, as it is shipped and with ``verilator --threads``, into
``build/threads``; loads each in a process of its own and lets them render the same frame in turn, round after round.
The shipped one also renders as many frames at once as there are threads, each by a tracer and a thread of its own.
Ratios are the medians of those of single rounds, so that what else the machine does counts for all. All pictures must
be the same. ``--write`` puts the table into ``bench/results/threads.md`` as well.

Needs CMake and, in this environment, nanobind and verilator: build-system.requires of pyproject.toml.
"""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import multiprocessing
import os
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np
from report import ROOT, frame_size, options_of, publish, table
from rtl_scenes import scenes

if TYPE_CHECKING:
    from pathlib import Path
    from types import ModuleType

    from rtl_scenes import Scene

CONFIGURATIONS = ("tiny", "z1")
SCENE = "Menger sponge"
MATERIALS = np.random.default_rng(1).integers(0, 256, (256, 3), dtype=np.uint8)


@dataclass(frozen=True)
class Way:
    """A way to simulate: a module, and the frames that it renders at the same time."""

    name: str
    module: Path
    frames: int


@dataclass(frozen=True)
class Run:
    """Frames rendered at the same time: seconds per frame, by the clock and by all processors, and what was made."""

    wall: float
    processor: float
    made: frozenset[tuple[str, int]]


def build(threads: int) -> Path:
    """Build the extension module with so many threads a simulation, and give its place."""
    folder = ROOT / "build" / "threads" / str(threads)
    settings = {
        "CMAKE_BUILD_TYPE": "Release",
        "Python_EXECUTABLE": sys.executable,
        "VOXRT_RTL": "ON",
        "VOXRT_RTL_CONFIGURATIONS": ";".join(CONFIGURATIONS),
        "VOXRT_RTL_THREADS": threads,
    }
    configure = ["cmake", "-S", ROOT, "-B", folder, *(f"-D{name}={value}" for name, value in settings.items())]
    subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
    compile_module = ["cmake", "--build", folder, "--target", "sim._rtl", "--parallel", str(os.cpu_count())]
    subprocess.run(compile_module, check=True, stdout=subprocess.DEVNULL)
    (module,) = folder.glob("**/_rtl.*.so")
    return module


@functools.cache
def load(module: Path) -> ModuleType:
    """Import a module from where it was built."""
    spec = importlib.util.spec_from_file_location("_rtl", module)
    assert spec is not None
    assert spec.loader is not None
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


@functools.cache
def tracers(module: Path, configuration: str, count: int) -> list[Any]:
    """Make tracers, once a process."""
    return [load(module).Tracer(configuration) for _ in range(count)]


def render(way: Way, configuration: str, scene: Scene, size: tuple[int, int]) -> Run:
    """Render in one way, in the process of its module."""
    at_work = tracers(way.module, configuration, way.frames)
    for tracer in at_work:
        tracer.load(scene.words)
    with ThreadPoolExecutor(way.frames) as pool:
        wall, processor = time.perf_counter(), time.process_time()
        frames = list(pool.map(lambda tracer: tracer.render(scene.camera, *size, scene.depth, MATERIALS), at_work))
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
    made = set()
    for frame in frames:
        planes = b"".join(frame[plane].tobytes() for plane in ("colour", "material", "face"))
        made.add((hashlib.sha256(planes).hexdigest(), frame["cycles"]))
    return Run(wall / way.frames, processor / way.frames, frozenset(made))


def compare(ways: list[Way], scene: Scene, size: tuple[int, int], rounds: int) -> list[tuple[str, ...]]:
    """Let the ways, of which the first is what the others stand beside, render in turn; give the table's rows."""
    spawn = multiprocessing.get_context("spawn")
    processes = {way: ProcessPoolExecutor(1, mp_context=spawn) for way in ways}
    pixels = size[0] * size[1] / 1e6
    rows = []
    for configuration in CONFIGURATIONS:
        runs: dict[Way, list[Run]] = {way: [] for way in ways}
        # Memory and caches are cold in the first round, which does not count.
        for number in range(rounds + 1):
            for way in ways if number % 2 else reversed(ways):
                run = processes[way].submit(render, way, configuration, scene, size).result()
                if number:
                    runs[way].append(run)
        made = frozenset[tuple[str, int]]().union(*(run.made for each in runs.values() for run in each))
        assert len(made) == 1, f"{configuration}: the pictures differ"
        base = runs[ways[0]]
        for way, each in runs.items():
            paired = list(zip(base, each, strict=True))
            least = min(run.wall for run in each)
            speeds = (pixels / median(run.wall for run in each), pixels / least)
            ratios = (
                median(one.wall / run.wall for one, run in paired),
                min(one.wall for one in base) / least,
                median(run.processor / one.processor for one, run in paired),
            )
            cells = (*(f"{speed:.3f}" for speed in speeds), *(f"{ratio:.2f}" for ratio in ratios))
            rows.append((configuration, way.name, *cells))
    for process in processes.values():
        process.shutdown()
    return rows


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--threads", type=int, default=2, help="beside one, default 2")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--size", type=frame_size, default="128x128")
    options = parser.parse_args()
    width, height = options.size
    (scene,) = (each for each in scenes(ROOT, (width, height)) if each.name.startswith(SCENE))
    shipped, threaded = build(1), build(options.threads)
    ways = [
        Way("one thread, as shipped", shipped, 1),
        Way(f"{options.threads} threads", threaded, 1),
        Way(f"{options.threads} frames at once, a thread each", shipped, options.threads),
    ]
    heads = ["configuration", "simulated by", "million pixels/s, median", "fastest round", "beside one thread, median"]
    heads += ["of the fastest rounds", "processor time per frame beside one thread, median"]
    before = os.getloadavg()[0]
    rows = compare(ways, scene, (width, height), options.rounds)
    after = os.getloadavg()[0]
    about = (
        f"{scene.name}, {width}x{height} pixels, {options.rounds} rounds on {os.cpu_count()} processors, which other\n"
        f"work shares: {before:.1f} processes wanted them before, {after:.1f} after; these at a nice value of\n"
        f"{os.getpriority(os.PRIO_PROCESS, 0)}. Speeds by the wall clock. Pictures and cycles are the same.\n\n"
    )
    publish("threads.md", about + table(heads, rows), write=options.write)


if __name__ == "__main__":
    main()
