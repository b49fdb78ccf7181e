"""Run the benches and say what they covered: ``python rtl/benches/coverage.py [--quick | --write]``.

Traversal: the bins of rtl/coverage/voxrt_lane_coverage.sv, hit of possible; the exit code is 1 when a possible bin was
missed or an impossible one hit. Lines: blocks and branches of the RTL that a bench went through, as Verilator counts
them. --quick leaves out the builds that repeat the benches of the core. With --write the report goes into
bench/results/coverage.md.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time
from collections import Counter
from typing import TYPE_CHECKING

from run import BUILDS, BUILDS_FOLDER, RTL, prepare, run

if TYPE_CHECKING:
    from collections.abc import Iterator

Bin = tuple[int, ...]

RESULTS = RTL.parent / "bench" / "results" / "coverage.md"
DEPTH = BUILDS["traversal"].parameters["MaxDepth"]
LEVELS = range(DEPTH)
AXES = range(3)
OCTANTS = range(8)
X, Y, Z = AXES
ALL_DEAD = 7
# Bits of a tie: x and y, y and z, z and x are crossed at the same time. The axis that goes last of the two:
LOSERS = {1: Y, 2: Z, 4: Z}
EQUALS = 7


def possible(_: Bin) -> str:
    """Say why a bin is impossible: it is not."""
    return ""


def above_the_root(bin_: Bin) -> str:
    """Say why, of leaves of a level and levels climbed."""
    level, _, _, climbed = bin_
    return "the ancestor would be above the root" if level + climbed >= DEPTH else ""


def below_the_voxels(bin_: Bin) -> str:
    """Say why, of pointers of a level."""
    return "a pointer of level 0 ends the ray: word, step limit" if bin_[0] == 0 else ""


def exits_on_a_dead_axis(bin_: Bin) -> str:
    """Say why, of exits by dead axes."""
    dead, axis = bin_
    if dead == ALL_DEAD:
        return "without direction no leaf is left; the ray ends, counted as z" if axis != Z else ""
    return "no ray leaves by a dead axis" if dead >> axis & 1 else ""


def goes_last(bin_: Bin) -> str:
    """Say why, of exits when planes are crossed at the same time."""
    ties, axis = bin_
    if ties.bit_count() == 2:
        return "equality of two pairs is equality of all"
    last = {Y, Z} if ties == EQUALS else {LOSERS.get(ties)}
    return "of planes crossed at the same time the first axis goes first" if axis in last else ""


def not_delivered(bin_: Bin) -> str:
    """Say why, of what can be wrong with a word. The bench of the lane has words that are not delivered."""
    return "port B serves the one lane while the processor has port A" if bin_ == (0,) else ""


# Name of a group: what its numbers are, their ranges, and which are impossible.
GROUPS = {
    "leaf": (
        "empty leaf left: level, exit axis, mirrored octant, levels climbed",
        (LEVELS, AXES, OCTANTS, LEVELS),
        above_the_root,
    ),
    "leaf_out": (
        "empty leaf left, out of the world: level, exit axis, mirrored octant",
        (LEVELS, AXES, OCTANTS),
        possible,
    ),
    "solid": ("solid leaf hit: level, face or none, mirrored octant", (LEVELS, range(4), OCTANTS), possible),
    "pointer": ("pointer followed: level, child, mirrored octant", (LEVELS, OCTANTS, OCTANTS), below_the_voxels),
    "dead": ("empty leaf left: dead axes, exit axis", (OCTANTS, AXES), exits_on_a_dead_axis),
    "tie": ("empty leaf left: planes crossed at the same time, exit axis", (OCTANTS, AXES), goes_last),
    "depth": ("out of a world of this depth", (range(1, DEPTH + 1),), possible),
    "word": ("word not delivered, bad pointer, step limit", (range(3),), not_delivered),
}


def traversal() -> tuple[list[str], bool]:
    """Give the report's table of bins, and whether they are as they should be."""
    hit: dict[str, set[Bin]] = {name: set() for name in GROUPS}
    for line in (BUILDS_FOLDER / "traversal" / "traversal.txt").read_text().splitlines():
        name, *numbers = line.split()
        hit[name].add(tuple(int(number) for number in numbers[:-1]))
    lines = ["| bins | hit | possible | impossible, and why |", "|---|---|---|---|"]
    wrong, hits, total = [], 0, 0
    for name, (meaning, ranges, reason_of) in GROUPS.items():
        reasons = {bin_: reason_of(bin_) for bin_ in itertools.product(*ranges)}
        wanted = {bin_ for bin_, reason in reasons.items() if not reason}
        why = Counter(reason for reason in reasons.values() if reason)
        excuses = "; ".join(f"{count}: {reason}" for reason, count in why.items())
        lines.append(f"| {meaning} | {len(hit[name] & wanted)} | {len(wanted)} | {excuses} |")
        wrong += [f"{name} {bin_}: missed" for bin_ in sorted(wanted - hit[name])]
        wrong += [f"{name} {bin_}: hit, but impossible" for bin_ in sorted(hit[name] - wanted)]
        hits += len(hit[name] & wanted)
        total += len(wanted)
    lines.append(f"| **all** | **{hits}** | **{total}** | |")
    return lines + [f"- {line}" for line in wrong], not wrong


def points() -> Iterator[tuple[str, int, str, int]]:
    """Give file, line, kind and count of each block and branch in each build."""
    for path in sorted(BUILDS_FOLDER.glob("*/coverage.dat")):
        if path.parent.name not in BUILDS:
            continue
        for record in path.read_text(encoding="latin-1").splitlines():
            if not record.startswith("C '"):
                continue
            keys, count = record[3:].rsplit("' ", 1)
            fields = dict(pair.split("\x02", 1) for pair in keys.split("\x01") if pair)
            yield fields["f"], int(fields["l"]), f"{fields['n']} {fields['o']}", int(count)


def count_returns(counts: Counter[tuple[str, int, str]]) -> None:
    """Count the branches of functions that end in a return, where such a branch is the function's first statement.

    Verilator counts a branch at its end, which these never come to. They were taken as often as the function was called
    less the times that the other branch was.
    """
    for file, line, kind in list(counts):
        column, name = kind.split()
        statement, _, _ = (RTL / file).read_text().splitlines()[line - 1].partition("//")
        if name == "if" and "return" in statement.split():
            called = max(place for place in counts if place[0] == file and place[1] < line and "block" in place[2])
            counts[file, line, kind] = counts[called] - counts[file, line, f"{int(column) + 1} else"]


def lines_covered() -> list[str]:
    """Give the report's table of files."""
    counts: Counter[tuple[str, int, str]] = Counter()
    for file, line, kind, count in points():
        place = file.removeprefix(f"{RTL}/")
        if not place.startswith("coverage/") and place != "voxrt_pkg.sv":
            counts[place, line, kind] += count
    count_returns(counts)
    table = [
        "| file | points | hit | | lines with a block or branch that no bench went through |",
        "|---|---|---|---|---|",
    ]
    hits = total = 0
    for file in sorted({place[0] for place in counts}):
        own = {place: count for place, count in counts.items() if place[0] == file}
        missed = sorted({(line, kind.split()[1]) for (_, line, kind), count in own.items() if not count})
        number = sum(count > 0 for count in own.values())
        listed = ", ".join(f"{line} {kind}" for line, kind in missed) if "generated" not in file else "PeakRDL's own"
        table.append(f"| {file} | {len(own)} | {number} | {number / len(own):.1%} | {listed if missed else ''} |")
        if "generated" not in file:
            hits += number
            total += len(own)
    table.append(f"| **all but what is generated** | **{total}** | **{hits}** | **{hits / total:.1%}** | |")
    return table


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    either = parser.add_mutually_exclusive_group()
    either.add_argument("--quick", action="store_true", help="leave out the builds that repeat the benches of others")
    either.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    prepare()
    times = {}
    for name, build in BUILDS.items():
        if build.repeats and options.quick:
            continue
        start = time.monotonic()
        run(name)
        times[name] = time.monotonic() - start
    bins, complete = traversal()
    report = "\n".join(
        [
            "# What the benches of the RTL cover",
            "",
            "Made by `python rtl/benches/coverage.py --write`.",
            "",
            "## Traversal",
            "",
            f"One lane of depth {DEPTH}, directed rays; what a bin is: `rtl/coverage/voxrt_lane_coverage.sv`.",
            "",
            *bins,
            "",
            "## Blocks and branches",
            "",
            "Of all benches together: "
            + ", ".join(BUILDS)
            + ". `line if` and `line else` are branches, `elsif` chains count",
            "each. No points: what no build generates; voxrt_pkg.sv, whose functions give constants.",
            "Verilator counts a branch at its end; one that returns before counts as often as its function was called,",
            "less the times that the other branch was taken.",
            "",
            *lines_covered(),
            "",
        ]
    )
    print(report)
    print(", ".join(f"{name} {seconds:.0f} s" for name, seconds in times.items()))
    if options.write:
        RESULTS.write_text(report)
    return not complete


if __name__ == "__main__":
    sys.exit(main())
