"""Benchmark against voxelizers that are on PyPI, side by side, each run in a process of its own.

Usage: ``pip install --group bench``, then ``python bench/peers.py [--write]``; ``--help`` tells how often and how long.
Meshes: generated displaced spheres of 70 k and 810 k triangles, and the skull where the assets are there. Depths 7 to
10, and to 12 for voxrt. Figures are medians of the runs; a run that takes longer or more memory than allowed is told as
such, and greater depths of it are left out. ``--write`` puts the tables into ``bench/results/peers.md`` and plots into
``docs/pictures/peers.svg`` as well.
"""

from __future__ import annotations

import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from peer import MAKES, TOOLS
from peers_run import Run
from report import ROOT, machine, options_of, write_page

from voxelize import SKULL, displaced_sphere
from voxrt.voxelize import load

if TYPE_CHECKING:
    import argparse

PLOTS = ROOT / "docs" / "pictures" / "peers.svg"
DEPTHS = (7, 8, 9, 10)
OUR_DEPTHS = (*DEPTHS, 11, 12)
NO_MEMORY = ("MemoryError", "bad_alloc", "Unable to allocate", "Cannot allocate memory", "out of memory")


def meshes(folder: Path) -> dict[str, Path]:
    """Write the meshes as arrays."""
    scenes = {"sphere-70k": displaced_sphere(133), "sphere-810k": displaced_sphere(451)}
    if SKULL.exists():
        scenes["skull"] = load(SKULL)
    files = {}
    for name, scene in scenes.items():
        files[name] = folder / f"{name}.npz"
        mesh = scene.objects[0].mesh
        np.savez(files[name], vertices=mesh.positions, triangles=mesh.triangles)
    return files


def once(tool: str, file: Path, depth: int, seconds: float, limit: int) -> dict[str, float] | str:
    """Run a tool once; what is measured, or why nothing is."""

    def confine() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    command = [sys.executable, str(Path(__file__).with_name("peer.py")), tool, str(file), str(depth)]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=out, stderr=err, preexec_fn=confine)  # noqa: PLW1509 - no threads
        while (ended := os.wait4(process.pid, os.WNOHANG))[0] == 0:
            if time.perf_counter() - start > seconds:
                process.kill()
                ended = os.wait4(process.pid, 0)
                process.returncode = -1
                return f"more than {seconds:g} s"
            time.sleep(0.002)
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(ended[1])
        for stream in (out, err):
            stream.seek(0)
        if process.returncode != 0:
            errors = err.read().decode("utf-8", "replace")
            died = process.returncode < 0 and "Error" not in errors
            return "out of memory" if died or any(word in errors for word in NO_MEMORY) else errors.splitlines()[-1]
        return {"wall": wall, "peak": ended[2].ru_maxrss / 1024, **json.loads(out.read().splitlines()[-1])}


def measure(tool: str, mesh: str, file: Path, depth: int, options: argparse.Namespace) -> Run:
    """Take the medians of several runs, or the first failure."""
    results = []
    for _ in range(options.runs):
        result = once(tool, file, depth, options.seconds, int(options.gigabytes * 2**30))
        if isinstance(result, str):
            return Run(tool, mesh, depth, result)
        results.append(result)
    wall, step, peak = (statistics.median(each[key] for each in results) for key in ("wall", "seconds", "peak"))
    return Run(tool, mesh, depth, "", wall, step, peak, results[0]["voxels"], results[0].get("words", 0))


def tables(runs: list[Run], options: argparse.Namespace) -> str:
    """Give a table a mesh: a tool a row, a depth a column."""
    names = ("trimesh", "open3d", "pyvista", "vtk")
    lines = [
        f"{machine()}; "
        + ", ".join(f"{name} {version(name)}" for name in names)
        + f". Medians of {options.runs}: seconds of the whole process / of the step from arrays to voxels / peak memory"
        + f", at most {options.seconds:g} s and {options.gigabytes:g} GB a run."
    ]
    for mesh in dict.fromkeys(run.mesh for run in runs):
        lines += ["", f"## {mesh}", "", "| tool | makes | " + " | ".join(f"{2**depth}³" for depth in OUR_DEPTHS) + " |"]
        lines.append("|---" * (2 + len(OUR_DEPTHS)) + "|")
        for tool in TOOLS:
            found = {run.depth: run for run in runs if (run.tool, run.mesh) == (tool, mesh)}
            cells = [_cell(found[depth]) if depth in found else "-" for depth in OUR_DEPTHS]
            lines.append(f"| {tool} | {MAKES[tool]} | {' | '.join(cells)} |")
    lines += ["", "## Memory words of voxrt", "", "| mesh | " + " | ".join(f"{2**d}³" for d in OUR_DEPTHS) + " |"]
    lines.append("|---" * (1 + len(OUR_DEPTHS)) + "|")
    for mesh in dict.fromkeys(run.mesh for run in runs):
        words = [f"{run.words:,}" for run in runs if (run.tool, run.mesh) == ("voxrt", mesh)]
        lines.append(f"| {mesh} | {' | '.join(words)} |")
    return "\n".join(lines) + "\n"


def _cell(run: Run) -> str:
    return run.failure or f"{run.wall:.2f} / {run.step:.2f} / {run.peak:,.0f} MB"


def main() -> None:
    """Run everything, print the tables, write them and the plots."""
    parser = options_of(__doc__)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=90)
    parser.add_argument("--gigabytes", type=float, default=8)
    parser.add_argument("--depths", type=int, nargs="*", default=OUR_DEPTHS, help="of those in the table")
    parser.add_argument("--json", type=Path, help="write what was measured there too")
    options = parser.parse_args()
    runs: list[Run] = []
    with tempfile.TemporaryDirectory() as folder:
        for mesh, file in meshes(Path(folder)).items():
            for tool in TOOLS:
                for depth in sorted(set(options.depths) & set(OUR_DEPTHS if tool == "voxrt" else DEPTHS)):
                    runs.append(measure(tool, mesh, file, depth, options))
                    print(f"{mesh} {2**depth}³ {tool}: {_cell(runs[-1])}", file=sys.stderr, flush=True)
                    if runs[-1].failure:
                        break
    text = tables(runs, options)
    print(text, end="")
    if options.json:
        options.json.write_text(json.dumps([asdict(run) for run in runs], indent=2) + "\n")
    if options.write:
        from peers_plot import plot  # noqa: PLC0415 - Matplotlib is needed for this alone

        write_page("peers.md", "# Beside other voxelizers\n\n" + text)
        plot(runs, PLOTS)


if __name__ == "__main__":
    main()
