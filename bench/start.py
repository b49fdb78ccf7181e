"""Whole processes: what starting takes, and small and large builds with their files, beside Python and NumPy alone.

Usage: ``python bench/start.py [--runs N] [--write]``. The runs of all rows take turns, so that a machine which others
use as well slows all of them alike. Medians and least values of the wall clock and of the processor's seconds.
``--write`` puts the table into ``bench/results/start.md`` as well.
"""

from __future__ import annotations

import argparse
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

from voxelize import displaced_sphere

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "bench" / "results" / "start.md"
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
VOXRT = (sys.executable, "-m", "voxrt")


def write_obj(path: Path) -> None:
    """Write a closed mesh of 70,224 triangles."""
    mesh = displaced_sphere(133).objects[0].mesh
    lines = ["v {:.7g} {:.7g} {:.7g}".format(*row) for row in mesh.positions.tolist()]
    lines += ["f {} {} {}".format(*row) for row in (mesh.triangles + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")


def run(command: tuple[str, ...], folder: Path) -> tuple[float, float, str]:
    """Give the wall seconds of a process, its processor seconds and its output."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, done.stdout


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=7, help="runs per row")
    parser.add_argument("--depth", type=int, default=10, help="levels of the larger build")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    build = (*VOXRT, "build")
    rows = {
        "`python -c pass`": (sys.executable, "-c", "pass"),
        "`python -c 'import numpy'`": (sys.executable, "-c", "import numpy"),
        "`python -c 'import cyclopts'`": (sys.executable, "-c", "import cyclopts"),
        "`voxrt --version`": (*VOXRT, "--version"),
        "`voxrt build --help`": (*build, "--help"),
        "tetrahedron, depth 4": (*build, "tetrahedron.obj", "--depth", "4", "--json", "-o", "small"),
        f"sphere of 70,224 triangles, depth {options.depth}": (
            *build, "sphere.obj", "--depth", str(options.depth), "--json", "-o", "large",
        ),
    }  # fmt: skip
    taken: dict[str, list[tuple[float, float]]] = {name: [] for name in rows}
    told: dict[str, list[float]] = {name: [] for name in rows}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "tetrahedron.obj").write_text(TETRAHEDRON)
        write_obj(folder / "sphere.obj")
        for _ in range(options.runs):
            for row, command in rows.items():
                wall, processor, output = run(command, folder)
                taken[row].append((wall, processor))
                if "--json" in command:
                    told[row].append(sum(json.loads(output)["seconds"].values()) / wall)
    lines = [
        "| process | wall, median | wall, least | processor, least | seconds of `--json`, of the wall |",
        "|---|--:|--:|--:|--:|",
    ]
    for row, runs in taken.items():
        walls, processors = zip(*runs, strict=True)
        share = f"{100 * statistics.median(told[row]):.0f} %" if told[row] else ""
        lines.append(
            f"| {row} | {statistics.median(walls):.3f} s | {min(walls):.3f} s | {min(processors):.3f} s | {share} |"
        )
    print("\n".join(lines))
    if options.write:
        load = os.getloadavg()[0]
        about = (
            f"Whole processes, by `bench/start.py`, {options.runs} runs each, in turns. {platform.machine()}, "
            f"{os.cpu_count()} cores, Python\n{platform.python_version()}; load of the machine by others: {load:.1f}. "
            "Compare rows with that of NumPy: it is slowed alike.\n"
        )
        RESULTS.write_text(f"# Start-up\n\n{about}\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
