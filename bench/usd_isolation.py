"""What reading USD in a process of its own costs: ``python bench/usd_isolation.py [ASSET ...] [--write]``.

Whole processes that read one asset take turns: through a process of its own, as `voxrt build` reads it, and in the same
process, which nothing protects from a damaged file. Medians and least values of the wall clock. ``--write`` puts the
table into ``bench/results/usd_isolation.md`` as well.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

from report import ROOT, options_of, publish, table

APART = "from voxrt.voxelize.formats.usd.isolated import read_isolated; read_isolated(path)"
TOGETHER = """
from voxrt.voxelize.formats.reader_process.limits import Allowance, Limits
from voxrt.voxelize.formats.usd.stage_scene import read_stage
read_stage(path, Allowance(Limits.of_this_machine()), variants=(), time=None, allow_outside=False)
"""


def seconds(code: str, asset: Path) -> float:
    """Give the wall seconds of a process that reads `asset` by `code`."""
    program = f"import sys; from pathlib import Path; path = Path(sys.argv[1])\n{code}"
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", program, str(asset)], cwd=ROOT / "bench", check=True, capture_output=True)
    return time.perf_counter() - start


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("assets", nargs="*", type=Path, default=[ROOT / "examples" / "dog.usda"])
    parser.add_argument("--runs", type=int, default=15, help="runs per asset and way")
    options = parser.parse_args()
    about = (
        "# USD in a process of its own\n\n"
        f"Made by `python bench/usd_isolation.py --write`: whole processes, {options.runs} runs each, in turns.\n"
        "Seconds of the wall clock.\n\n"
    )
    rows = []
    for asset in options.assets:
        seconds(APART, asset), seconds(TOGETHER, asset)  # once for the caches of files
        pairs = [(seconds(APART, asset.resolve()), seconds(TOGETHER, asset.resolve())) for _ in range(options.runs)]
        apart, together = ([pair[way] for pair in pairs] for way in (0, 1))
        medians = [statistics.median(way) for way in (apart, together)]
        cells = [f"{median:.3f}, {min(way):.3f}" for median, way in zip(medians, (apart, together), strict=True)]
        rows.append((asset.name, *cells, f"{medians[0] - medians[1]:.3f}"))
    head = ("asset", "apart: median, least", "together: median, least", "difference of the medians")
    publish("usd_isolation.md", about + table(head, rows), write=options.write)


if __name__ == "__main__":
    main()
