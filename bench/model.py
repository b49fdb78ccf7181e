"""Benchmark of the exact model: pixels per second and core, beside the report's C++ algorithm and the hardware.

Usage: ``python bench/model.py [MEMORY.mem ...] [--size N] [--clock MHZ] [--write]``. Without memories it takes the
demo scene at two depths. ``original.cpp``, the report's algorithm, is compiled with ``c++ -O2`` and run beside it,
with the data handling of its appendix and without, from a camera that it can stand (in the world, on whole voxels,
along an axis). ``--clock`` is the hardware's clock, by which its counted cycles become time. ``--write`` puts the
table into ``bench/results/model.md`` as well. Each time is the least of seven; on one core it is the processor's
time, so that other work on the machine does not count.
"""

from __future__ import annotations

import os
import platform
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from original import Original, level_camera
from report import ROOT, options_of, publish, table

import voxrt
from voxrt.sim import SimulatorError, _model, render

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.sim import Camera

SCENE = ROOT / "examples" / "courtyard.glb"
REPEATS = 7


def model_seconds(rom: Rom, camera: Camera, size: int, threads: int, instructions: str) -> float:
    """Give the least seconds of a frame by the model, its memory loaded before."""
    memory = _model.Memory(rom.octree.words, rom.octree.depth)
    palette = np.zeros((256, 3), np.uint8)
    palette[: len(rom.materials)] = [material.colour for material in rom.materials]
    registers = np.array([camera.position, camera.look, camera.right, camera.up], np.int32)
    clock = time.process_time if threads == 1 else time.perf_counter
    times = []
    for _ in range(REPEATS):
        started = clock()
        memory.render(palette, registers, size, size, threads, instructions)
        times.append(clock() - started)
    return min(times)


def measure(rom: Rom, published: Original, bare: Original, size: int, clock: float) -> list[tuple[str, str]]:
    pixels, frame = size * size, (size, size)
    camera = level_camera(rom, size)
    original, at_its_best = (
        min(program.render(rom, camera, frame)[0] for _ in range(REPEATS)) for program in (published, bare)
    )
    rows = [
        (f"**{rom.name}, depth {rom.octree.depth}**", f"{size}x{size} pixels"),
        ("report's program, 1 core", nanoseconds(original, pixels)),
        ("its algorithm on plain arrays, 1 core", nanoseconds(at_its_best, pixels, original)),
    ]
    for instructions in _model.INSTRUCTION_SETS:
        seconds = model_seconds(rom, camera, size, 1, instructions)
        rows.append((f"model, 1 core, {instructions}", nanoseconds(seconds, pixels, original)))
    cores = os.cpu_count()
    on_all = model_seconds(rom, camera, size, 0, "")
    rows.append((f"model, {cores} cores", nanoseconds(on_all, pixels, original)))
    try:
        cost = render(rom, camera, frame, engine="rtl").cost
    except SimulatorError as error:
        return [*rows, ("hardware, tiny", str(error))]
    hardware = cost.cycles / (clock * 1e6)
    rows.append((f"hardware, tiny, at {clock:g} MHz", nanoseconds(hardware, pixels, original)))
    return [*rows, ("hardware, cycles per pixel", f"{cost.cycles / pixels:.2f}")]


def nanoseconds(seconds: float, pixels: int, original: float | None = None) -> str:
    """Say a time per pixel, and how many times as fast that is."""
    text = f"{seconds / pixels * 1e9:.1f} ns a pixel"
    return text if original is None else f"{text}, {original / seconds:.0f} times as fast"


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("memories", nargs="*", type=Path)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--clock", type=float, default=100.0)
    options = parser.parse_args()
    roms = [voxrt.read_rom(path)[0] for path in options.memories]
    roms = roms or [voxrt.build(SCENE, depth=depth).rom for depth in (7, 9)]
    rows = [("machine", f"{platform.machine()}, {os.cpu_count()} cores")]
    with Original(as_published=True) as published, Original(as_published=False) as bare:
        for rom in roms:
            rows += measure(rom, published, bare, options.size, options.clock)
    title = "# The exact model, measured by bench/model.py\n\n"
    publish("model.md", title + table(("what", "measured"), rows), write=options.write)


if __name__ == "__main__":
    main()
