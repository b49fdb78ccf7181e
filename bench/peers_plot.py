"""The plots of peers.py: time, memory and words against the grid's side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib as mpl
from matplotlib import pyplot as plt

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from peers_run import Run

COLOURS = {
    "voxrt": "#d62728",
    "trimesh": "#8c564b",
    "Open3D surface": "#1f77b4",
    "Open3D octree": "#17becf",
    "Open3D columns": "#2ca02c",
    "PyVista": "#9467bd",
}


def plot(runs: Sequence[Run], file: Path) -> None:
    """Draw the runs on the first mesh, and the words of all meshes, as an SVG file: the same bytes for equal runs."""
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
        words.plot(
            [2**run.depth for run in drawn],
            [run.words for run in drawn],
            line,
            marker="o",
            color=COLOURS["voxrt"],
            label=name,
            markersize=3,
        )
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
