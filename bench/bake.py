"""Benchmark of baked light: seconds of each step and words, on spheres with bumps and on the project's scenes.

Usage: ``python bench/bake.py [--threads N] [--write]``. ``--write`` puts the table into ``bench/results/bake.md`` as
well. Seconds are the least of three runs, wall clock and CPU; 64 directions to the sky above a surface.
"""

from __future__ import annotations

import os
import resource
import time
from typing import TYPE_CHECKING

from report import ROOT, machine, options_of, write_page

import voxrt
from voxelize import displaced_sphere
from voxrt.sim.baking.bake import bake_light

if TYPE_CHECKING:
    from voxrt.voxelize import Scene

HEAD = "| scene | triangles | side | lit voxels | light | palette, memory | in all | CPU | words | words without |"
RUNS = 3


def cpu() -> float:
    """Give the seconds of CPU that this process took."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def measure(scene: Scene, depth: int, threads: int) -> str:
    built = voxrt.build(scene, depth=depth, threads=threads)
    best = None
    for _ in range(RUNS):
        start, used = time.perf_counter(), cpu()
        light = bake_light(built.rom, built.scene, threads=threads)
        lit = time.perf_counter()
        rom = light.memory(threads=threads)
        end = time.perf_counter()
        took = (end - start, lit - start, end - lit, cpu() - used, len(light.voxels), len(rom.octree.words))
        best = took if best is None else min(best, took)
    whole, light_s, palette_s, cpu_s, voxels, words = best
    triangles = sum(len(item.mesh.triangles) for item in scene.objects)
    return (
        f"| {scene.name} | {triangles:,} | {1 << depth} | {voxels:,} | {light_s:.2f} s | {palette_s:.2f} s | "
        f"{whole:.2f} s | {cpu_s:.2f} s | {words:,} | {len(built.octree.words):,} |"
    )


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--threads", type=int, default=0)
    options = parser.parse_args()
    rows = []
    for scene, depth in (
        (displaced_sphere(133), 8),
        (displaced_sphere(133), 9),
        (displaced_sphere(133), 10),
        *((voxrt.load(ROOT / "examples" / name), 8) for name in ("courtyard.glb", "planet.glb", "house.obj")),
    ):
        rows.append(measure(scene, depth, options.threads))
        print(rows[-1], flush=True)
    if options.write:
        about = f"{machine()}; threads: {options.threads or 'all'}; load average {os.getloadavg()[0]:.1f}\n"
        write_page("bake.md", "\n".join(["# Baked light", "", about, HEAD, "|---|" + "--:|" * 9, *rows]) + "\n")


if __name__ == "__main__":
    main()
