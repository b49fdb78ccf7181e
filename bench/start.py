"""Whole processes: what starting takes, and small and large builds with their files, beside Python and NumPy alone.

Usage: ``python bench/start.py [--runs N] [--write]``. The runs of all rows take turns, so that a machine which others
use as well slows all of them alike. Medians and least values of the wall clock and of the processor's seconds. Python
may keep what it compiles, as it does where packages are installed; a first run of each row is not counted. Below the
processes stand single steps within one process: arrays to octree, the octree alone by one thread and by all, and
loading a binary PLY file. ``--write`` puts the tables into ``bench/results/start.md`` as well.
"""

from __future__ import annotations

import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import trimesh
from report import USER_ENVIRONMENT, options_of, write_page

import voxrt
from voxelize import displaced_sphere
from voxrt import octree, voxelize

if TYPE_CHECKING:
    from collections.abc import Callable

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
VOXRT = (sys.executable, "-m", "voxrt")


def write_obj(path: Path) -> None:
    """Write a closed mesh of 70,224 triangles."""
    mesh = displaced_sphere(133).objects[0].mesh
    lines = ["v {:.7g} {:.7g} {:.7g}".format(*row) for row in mesh.positions.tolist()]
    lines += ["f {} {} {}".format(*row) for row in (mesh.triangles + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")


def write_ply(path: Path) -> None:
    """Write a closed mesh of 811,800 triangles, binary."""
    mesh = displaced_sphere(451).objects[0].mesh
    trimesh.Trimesh(mesh.positions, mesh.triangles, process=False).export(path)


def steps(ply: Path, runs: int) -> list[str]:
    """Return a table of single steps: the least wall and processor seconds of each."""
    scene = displaced_sphere(133)
    rows: dict[str, Callable[[], object]] = {"load PLY, 811,800 triangles": lambda: voxrt.load(ply)}
    for depth in (10, 12):
        grid = voxrt.fit_grid(scene, depth=depth)
        voxels = voxelize.voxelize(scene, grid).voxels
        size = f"{1 << depth}³"
        rows[f"arrays to octree, {size}"] = lambda grid=grid: octree.build(voxelize.voxelize(scene, grid).voxels)
        rows[f"octree, {size}, one thread"] = lambda voxels=voxels: octree.build(voxels, threads=1)
        rows[f"octree, {size}, all threads"] = lambda voxels=voxels: octree.build(voxels)
    taken: dict[str, list[tuple[float, float]]] = {name: [] for name in rows}
    for _ in range(runs):
        for name, step in rows.items():
            wall, processor = time.perf_counter(), time.process_time()
            step()
            taken[name].append((time.perf_counter() - wall, time.process_time() - processor))
    return ["| step | wall, least | processor, least |", "|---|--:|--:|"] + [
        f"| {name} | {min(wall for wall, _ in those):.3f} s | {min(cpu for _, cpu in those):.3f} s |"
        for name, those in taken.items()
    ]


def run(command: tuple[str, ...], folder: Path) -> tuple[float, float, str]:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True, env=USER_ENVIRONMENT)
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, done.stdout


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--runs", type=int, default=7, help="runs per row")
    parser.add_argument("--depths", type=int, nargs="+", default=[10, 12], help="levels of the larger builds")
    options = parser.parse_args()
    build = (*VOXRT, "build")
    rows = {
        "`python -c pass`": (sys.executable, "-c", "pass"),
        "`python -c 'import numpy'`": (sys.executable, "-c", "import numpy"),
        "`voxrt --version`": (*VOXRT, "--version"),
        "`voxrt --help`": (*VOXRT, "--help"),
        "`voxrt build --help`": (*build, "--help"),
        "tetrahedron, depth 4": (*build, "tetrahedron.obj", "--depth", "4", "--json", "-o", "small"),
    }
    for depth in options.depths:
        command = (*build, "sphere.obj", "--depth", str(depth), "--json", "-o", "large")
        rows[f"sphere of 70,224 triangles, depth {depth}"] = command
    taken: dict[str, list[tuple[float, float]]] = {name: [] for name in rows}
    shares: dict[str, list[float]] = {name: [] for name in rows}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "tetrahedron.obj").write_text(TETRAHEDRON)
        write_obj(folder / "sphere.obj")
        write_ply(folder / "sphere.ply")
        for turn in range(1 + options.runs):
            for row, command in rows.items():
                wall, processor, output = run(command, folder)
                if turn == 0:
                    continue
                taken[row].append((wall, processor))
                if "--json" in command:
                    shares[row].append(sum(json.loads(output)["seconds"].values()) / wall)
        table_of_steps = steps(folder / "sphere.ply", options.runs)
    lines = [
        "| process | wall, median | wall, least | processor, least | seconds of `--json`, of the wall |",
        "|---|--:|--:|--:|--:|",
    ]
    for row, runs in taken.items():
        walls, processors = zip(*runs, strict=True)
        share = f"{100 * statistics.median(shares[row]):.0f} %" if shares[row] else ""
        lines.append(
            f"| {row} | {statistics.median(walls):.3f} s | {min(walls):.3f} s | {min(processors):.3f} s | {share} |"
        )
    lines += ["", *table_of_steps]
    print("\n".join(lines))
    if options.write:
        load = os.getloadavg()[0]
        about = (
            f"Whole processes, by `bench/start.py`, {options.runs} runs each, in turns. {platform.machine()}, "
            f"{os.cpu_count()} cores, Python\n{platform.python_version()}; load of the machine by others: {load:.1f}. "
            "Compare rows with that of NumPy: it is slowed alike.\n"
        )
        write_page("start.md", f"# Start-up\n\n{about}\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
