"""Benchmark of point clouds: seconds and memory of a whole build of ten million points.

Usage: ``python bench/points.py [--write]``. The points lie on a ball, at random places of it, with colours; the file is
a binary PLY, the grid has depth 9. ``--write`` puts the table into ``bench/results/points.md`` as well.
"""

from __future__ import annotations

import os
import platform
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from report import options_of, publish, table

POINTS, DEPTH = 10_000_000, 9
HEAD = f"""ply
format binary_little_endian 1.0
element vertex {POINTS}
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
end_header
"""


def write_ball(path: Path) -> None:
    rng = np.random.default_rng(1)
    places = rng.normal(size=(POINTS, 3)).astype(np.float32)
    places /= np.linalg.norm(places, axis=1)[:, None]
    rows = np.zeros(POINTS, [("place", "<f4", 3), ("colour", "u1", 3)])
    rows["place"], rows["colour"] = places, (places * 127 + 128).astype(np.uint8)
    path.write_bytes(HEAD.encode() + rows.tobytes())


def main() -> None:
    arguments = options_of(__doc__).parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "ball.ply")
        write_ball(path)
        for fill in ("surface", "auto"):
            command = [sys.executable, "-m", "voxrt", "build", str(path), "--depth", str(DEPTH), "--fill", fill]
            started = time.perf_counter()
            subprocess.run([*command, "-o", folder, "--json"], check=True, stdout=subprocess.DEVNULL)
            seconds = time.perf_counter() - started
            most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss  # of all so far: the last takes the most
            rows.append((fill, f"{seconds:.1f}", f"{most / 1e6:.2f}"))
    about = f"{POINTS:,} points, depth {DEPTH}; {platform.machine()}, {os.cpu_count()} cores."
    text = table(("--fill", "seconds", "GB of memory"), rows)
    publish("points.md", f"# Point clouds\n\n{about}\n\n{text}", write=arguments.write)


if __name__ == "__main__":
    main()
