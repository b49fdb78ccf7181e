"""Benchmark against voxelizers that are on PyPI, side by side, each run in a process of its own.

Usage: ``pip install --group bench``, then ``python bench/peers.py [--write]``; ``--help`` tells how often and how long.
Meshes: generated displaced spheres of 70 k and 810 k triangles, and the skull where the assets are there. Depths 7 to
10, and to 12 for voxrt. Figures are medians of the runs; a run that takes more time or memory than allowed is told as
such, and greater depths of it are left out. ``--write`` puts the tables into ``bench/results/peers.md`` and plots into
``docs/pictures/peers.svg`` as well.
"""

from __future__ import annotations

import json
import statistics
import sys
import tempfile
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from peer import MAKES, TOOLS
from peer_process import run_confined
from report import ROOT, machine, options_of, publish, table

from voxelize import SKULL, displaced_sphere
from voxrt.voxelize import load

if TYPE_CHECKING:
    import argparse

PLOTS = ROOT / "docs" / "pictures" / "peers.svg"
DEPTHS = (7, 8, 9, 10)
OUR_DEPTHS = (*DEPTHS, 11, 12)
COLOURS = {
    "voxrt": "#d62728",
    "trimesh": "#8c564b",
    "Open3D surface": "#1f77b4",
    "Open3D octree": "#17becf",
    "Open3D columns": "#2ca02c",
    "PyVista": "#9467bd",
}


@dataclass(frozen=True)
class Run:
    """What one tool made of one mesh at one depth, or why it did not: medians of the runs."""

    tool: str
    mesh: str
    depth: int
    failure: str = ""
    wall: float = 0.0
    """Seconds of the whole process."""
    step: float = 0.0
    """Seconds from the mesh's arrays to the voxels."""
    peak: float = 0.0
    """Most resident memory, MB."""
    voxels: int = 0
    words: int = 0


def meshes(folder: Path) -> dict[str, Path]:
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
    command = [sys.executable, str(Path(__file__).with_name("peer.py")), tool, str(file), str(depth)]
    ended = run_confined(command, seconds, limit)
    if isinstance(ended, str):
        return ended
    return {"wall": ended.wall, "peak": ended.peak, **json.loads(ended.printed.splitlines()[-1])}


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
    tools = ", ".join(f"{name} {version(name)}" for name in ("trimesh", "open3d", "pyvista", "vtk"))
    text = (
        f"{machine()}; {tools}. Medians of {options.runs}: seconds of the whole process / of the step from arrays to "
        f"voxels / peak memory, at most {options.seconds:g} s and {options.gigabytes:g} GB a run.\n"
    )
    sides = [f"{2**depth}³" for depth in OUR_DEPTHS]
    ours = [run for run in runs if run.tool == "voxrt"]
    names = list(dict.fromkeys(run.mesh for run in runs))
    for mesh in names:
        rows = []
        for tool in TOOLS:
            found = {run.depth: run for run in runs if (run.tool, run.mesh) == (tool, mesh)}
            rows.append((tool, MAKES[tool], *(_cell(found[d]) if d in found else "-" for d in OUR_DEPTHS)))
        text += f"\n## {mesh}\n\n{table(('tool', 'makes', *sides), rows)}"
    words = [(mesh, *(f"{run.words:,}" for run in ours if run.mesh == mesh)) for mesh in names]
    return text + f"\n## Memory words of voxrt\n\n{table(('mesh', *sides), words)}"


def _cell(run: Run) -> str:
    return run.failure or f"{run.wall:.2f} / {run.step:.2f} / {run.peak:,.0f} MB"


def plot(runs: list[Run], file: Path) -> None:
    """Draw the runs on the first mesh, and the words of all meshes, as an SVG file: the same bytes for equal runs."""
    import matplotlib as mpl  # noqa: PLC0415 - only for the plots
    from matplotlib import pyplot as plt  # noqa: PLC0415

    mpl.rcParams |= {"svg.hashsalt": "voxrt", "svg.fonttype": "none", "font.size": 9}
    figure, (times, memories, words) = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
    mesh = runs[0].mesh
    for tool, colour in COLOURS.items():
        drawn = [run for run in runs if (run.tool, run.mesh, run.failure) == (tool, mesh, "")]
        sides = [2**run.depth for run in drawn]
        width = 2.2 if tool == "voxrt" else 1.2
        times.plot(sides, [run.step for run in drawn], "o-", color=colour, label=tool, linewidth=width, markersize=3)
        memories.plot(sides, [run.peak for run in drawn], "o-", color=colour, linewidth=width, markersize=3)
    for name, line in zip(dict.fromkeys(run.mesh for run in runs), ("-", "--", ":"), strict=False):
        drawn = [run for run in runs if (run.tool, run.mesh, run.failure) == ("voxrt", name, "")]
        sides = [2**run.depth for run in drawn]
        style = {"marker": "o", "color": COLOURS["voxrt"], "markersize": 3}
        words.plot(sides, [run.words for run in drawn], line, label=name, **style)
    for axes, title in ((times, f"seconds, {mesh}"), (memories, f"peak memory in MB, {mesh}"), (words, "words, voxrt")):
        axes.set_title(title)
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xlabel("voxels per side")
        axes.grid(alpha=0.3)
    times.legend(fontsize=7)
    words.legend(fontsize=7)
    figure.savefig(file, metadata={"Date": None})
    plt.close(figure)


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--runs", type=int, default=5)
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
    publish("peers.md", "# Beside other voxelizers\n\n" + tables(runs, options), write=options.write)
    if options.json:
        options.json.write_text(json.dumps([asdict(run) for run in runs], indent=2) + "\n")
    if options.write:
        plot(runs, PLOTS)


if __name__ == "__main__":
    main()
