"""Programs that turn a file into a file of voxels, side by side: whole processes, in turns, on a scan as GLB.

Usage: ``python bench/peer_files.py [--python PATH]... [--runs N] [--write]``. The skull by voxrt, and by voxquant and
MeshLib where ``python bench/acid.py`` has installed them. voxrt runs as its users have it: in an environment that has
nothing else, of this interpreter or of each that is named. Half of a short run is the start of Python, and interpreters
that were compiled without profiles start slower. Wants the assets (CONTRIBUTING.md), the wheel in ``build/wheel``, and
a machine that does nothing else. Figures are medians of runs in turns; a run of more time or memory than allowed is
named so. ``--write`` writes ``bench/results/peer_files.md``.
"""

from __future__ import annotations

import importlib.util
import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from peer_process import Ended, run_confined
from report import ROOT, options_of, publish, table

from voxelize import SKULL

if TYPE_CHECKING:
    import argparse

ENVIRONMENT = ROOT / "build" / "acid" / "bin"
"""Where ``python bench/acid.py`` puts the tools."""
MESHLIB = Path(__file__).with_name("peer_meshlib.py")
DEPTHS = (8, 9, 10, 11, 12)
# In a process of its own: what a process has in memory counts for those that it starts, too.
EXPORT = "import sys, trimesh; m = trimesh.load(sys.argv[1], process=False); m.export(sys.argv[2]); print(len(m.faces))"


def plain_environment(python: Path, folder: Path) -> tuple[str, Path]:
    """Make an environment of an interpreter with voxrt and what it needs; return its version and its voxrt-build."""
    subprocess.run([python, "-m", "venv", "--without-pip", folder], check=True)
    own = folder / "bin" / "python"
    wheels = [*(ROOT / "build" / "wheel").glob("*.whl")]
    subprocess.run([sys.executable, "-m", "pip", "--python", own, "install", "--quiet", *wheels], check=True)
    version = "import platform; print(platform.python_version())"
    printed = subprocess.run([own, "-c", version], check=True, capture_output=True, text=True)
    return printed.stdout.strip(), own.with_name("voxrt-build")


def programs(pythons: list[Path], folder: Path) -> tuple[dict[str, tuple[str, list[str | Path]]], list[str]]:
    """Return what each program makes, and its command: FILE, DEPTH, SIDE and OUT stand for these; and who is absent."""
    found: dict[str, tuple[str, list[str | Path]]] = {}
    for number, python in enumerate(pythons):
        version, builder = plain_environment(python, folder / f"python{number}")
        command = [builder, "FILE", "-q", "-o", "OUT", "--depth", "DEPTH"]
        found[f"voxrt, Python {version}"] = "solid, materials, shared octree", command
    voxquant = shutil.which("voxquant", path=ENVIRONMENT) or shutil.which("voxquant")
    if voxquant:
        found["voxquant"] = ("surface", [voxquant, "-i", "FILE", "-o", "OUT.vox", "--res", "SIDE"])
    python = sys.executable if importlib.util.find_spec("meshlib") else ENVIRONMENT / "python"
    if Path(python).exists():
        found["MeshLib"] = ("signed distances near the surface", [python, MESHLIB, "FILE", "SIDE", "OUT.vdb"])
    return found, [name for name in ("voxquant", "MeshLib") if name not in found]


def race(folder: Path, options: argparse.Namespace) -> str:
    """Return a page with the medians of each program at each depth."""
    found, absent = programs(options.python or [Path(sys.executable)], folder)
    for name in absent:
        print(f"{name} is left out: it is not here; python bench/acid.py installs it", file=sys.stderr)
    scan = folder / "scan.glb"
    exported = subprocess.run([sys.executable, "-c", EXPORT, SKULL, scan], check=True, capture_output=True, text=True)
    cells: dict[str, list[str]] = {name: [] for name in found}
    for depth in DEPTHS:
        runs: dict[str, list[Ended | str]] = {name: [] for name in found}
        for _ in range(options.runs):  # in turns, so that a busy machine slows all of them
            for name, (_, command) in found.items():
                if not any(isinstance(run, str) for run in runs[name]):
                    runs[name].append(once(command, scan, depth, folder, options))
        for name in found:
            cells[name].append(cell(runs[name]))
            print(f"scan.glb {2**depth}³ {name}: {cells[name][-1]}", file=sys.stderr, flush=True)
    sides = [f"{2**depth}³" for depth in DEPTHS]
    rows = [(name, found[name][0], *cells[name]) for name in found]
    about = (
        f"{platform.machine()}, {os.cpu_count()} cores. The skull, {int(exported.stdout):,} triangles as GLB: seconds "
        f"of the whole process / peak memory, medians of {options.runs} in turns, at most {options.seconds:g} s and "
        f"{options.gigabytes:g} GB a run."
    )
    return f"# From a scan's file to voxels\n\n{about}\n\n{table(('program', 'makes', *sides), rows)}"


def once(command: list[str | Path], scan: Path, depth: int, folder: Path, options: argparse.Namespace) -> Ended | str:
    """Run a program once."""
    values = {"FILE": str(scan), "DEPTH": str(depth), "SIDE": str(2**depth)}
    arguments = [values.get(str(word), str(word).replace("OUT", str(folder / "made"))) for word in command[1:]]
    return run_confined([str(command[0]), *arguments], options.seconds, int(options.gigabytes * 2**30))


def cell(runs: list[Ended | str]) -> str:
    """Return the medians, or the first failure."""
    for run in runs:
        if isinstance(run, str):
            return run
    ended = [run for run in runs if isinstance(run, Ended)]
    wall, peak = (statistics.median(getattr(run, key) for run in ended) for key in ("wall", "peak"))
    return f"{wall:.3f} / {peak:,.0f} MB"


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--python", type=Path, action="append", metavar="PATH")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=90)
    parser.add_argument("--gigabytes", type=float, default=8)
    options = parser.parse_args()
    if not SKULL.exists():
        sys.exit(f"{SKULL} is not there")
    with tempfile.TemporaryDirectory() as folder:
        publish("peer_files.md", race(Path(folder), options), write=options.write)


if __name__ == "__main__":
    main()
