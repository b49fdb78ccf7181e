"""What rules cost: processor time to voxels by each rule, and to volume fractions, divided by that of ``touch``.

Usage: ``python bench/rules.py [--write]``. All are measured in turns, in one process, on one thread; the least of
several turns counts.
"""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from report import ASSETS, ROOT, machine, options_of, publish, table

from voxelize import SKULL, displaced_sphere
from voxrt.voxelize import authoring, fit_grid, load, volume_fractions, voxelize

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.voxelize import Scene

TURNS = 5


def processor_seconds(works: dict[str, Callable[[], object]]) -> dict[str, float]:
    """Measure each work, in turns."""
    least = dict.fromkeys(works, float("inf"))
    for _ in range(TURNS):
        for name, work in works.items():
            start = time.process_time()
            work()
            least[name] = min(least[name], time.process_time() - start)
    return least


def row(name: str, scene: Scene, depth: int) -> tuple[str, ...]:
    """Measure a scene."""
    grid = fit_grid(scene, depth=depth)
    choices = {"touch": {}, "centre, drop": {"rule": "centre", "thin": "drop"}, "centre": {"rule": "centre"}}
    choices |= {"half, drop": {"rule": "half", "thin": "drop"}, "half": {"rule": "half"}}
    works: dict[str, Callable[[], object]] = {
        choice: lambda options=options: voxelize(scene, grid, threads=1, **options)
        for choice, options in choices.items()
    }
    works["fractions"] = lambda: volume_fractions(scene, grid, threads=1)
    seconds = processor_seconds(works)
    ratios = (f"{seconds[choice] / seconds['touch']:.1f}" for choice in list(works)[1:])
    return (name, f"{2**depth}³", f"{seconds['touch'] * 1e3:.0f} ms", *ratios)


def tilted_cube() -> Scene:
    """Give a cube whose walls are steep: each passes many voxels of a column."""
    yard = authoring.Author("tilted cube")
    yard.add("cube", authoring.box((1, 1, 1)), rotate=(0, 0.5, 0))
    return yard.build()


def main() -> None:
    arguments = options_of(__doc__).parse_args()
    rows = [row("sphere-70k", displaced_sphere(133), depth) for depth in (8, 9, 10)]
    rows.append(row("tilted cube", tilted_cube(), 10))
    rows += [row("courtyard", load(ROOT / "examples" / "courtyard.glb"), depth) for depth in (7, 9)]
    if SKULL.exists():
        rows.append(row("skull", load(SKULL), 10))
    else:
        print(f"skull: not below {ASSETS}", file=sys.stderr)
    head = ("scene", "grid", "touch", "centre, drop", "centre", "half, drop", "half", "fractions")
    about = (
        f"# What rules cost\n\n{machine()}; by `bench/rules.py`.\n\nProcessor time of `touch`, and that of the others "
        "divided by it. `drop`: without thin parts (`--thin drop`).\n\n"
    )
    publish("rules.md", about + table(head, rows, 1), write=arguments.write)


if __name__ == "__main__":
    main()
