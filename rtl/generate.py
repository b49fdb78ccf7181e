"""Make what registers.rdl describes: ``python rtl/generate.py``. Needs the package peakrdl; what it makes is committed.

The AXI4-Lite block and the C header are PeakRDL's own; the Python map and the manual's table are written here from
the model that its compiler gives.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from systemrdl import RDLCompiler
from systemrdl.node import MemNode, RegNode

RTL = Path(__file__).resolve().parent
SOURCE = RTL / "registers.rdl"
BOARD = RTL.parent / "board"
GENERATED = RTL / "generated"


def peakrdl(*arguments: str | Path) -> None:
    """Run one of PeakRDL's exporters."""
    subprocess.run([sys.executable, "-m", "peakrdl", *arguments], check=True)


def main() -> None:
    """Make everything."""
    GENERATED.mkdir(exist_ok=True)
    flags = [
        "--cpuif",
        "axi4-lite-flat",
        "--default-reset",
        "rst_n",
        "--rt-read-fanin",
        "--rt-read-response",
        "--err-if-bad-addr",
    ]
    peakrdl("regblock", SOURCE, "-o", GENERATED, *flags)
    peakrdl("c-header", SOURCE, "-o", GENERATED / "voxrt_registers.h")

    compiler = RDLCompiler()
    compiler.compile_file(str(SOURCE))
    top = compiler.elaborate().top
    python = [
        '"""Registers of the ray tracer, made of rtl/registers.rdl: name, byte address, fields as (low, width)."""',
        "",
        "REGISTERS = {",
    ]
    manual = ["# Registers", "", " ".join((top.get_property("desc") or "").split()), ""]
    for node in top.children(unroll=True):
        name = node.get_path_segment()
        description = " ".join((node.get_property("desc") or "").split())
        if isinstance(node, RegNode):
            fields = list(node.fields())
            python += [f'    "{name}": (', f"        0x{node.absolute_address:03X},", "        {"]
            python += [f'            "{field.inst_name}": ({field.low}, {field.width}),' for field in fields]
            python += ["        },", "    ),"]
            manual += [f"## 0x{node.absolute_address:03X} {name}", "", description, ""]
            manual += ["| bits | field | access | reset | |", "|---|---|---|---|---|"]
            for field in fields:
                bits = f"{field.high}:{field.low}" if field.width > 1 else f"{field.low}"
                access = "w1c" if field.get_property("onwrite") is not None else field.get_property("sw").name
                reset = field.get_property("reset")
                meaning = " ".join((field.get_property("desc") or "").split())
                manual.append(
                    f"| {bits} | {field.inst_name} | {access} | {'' if reset is None else reset} | {meaning} |"
                )
            manual.append("")
        elif isinstance(node, MemNode):
            manual += [f"## 0x{node.absolute_address:03X} {name}, {node.get_property('mementries')} words", ""]
            manual += [description, ""]
    python += ["}", f"MATERIALS = 0x{top.find_by_path('materials').absolute_address:03X}", ""]
    # The board's room installs alone, so it holds a copy of its own.
    for place in (GENERATED / "voxrt_registers.py", BOARD / "registers.py"):
        place.write_text("\n".join(python))
    (GENERATED / "registers.md").write_text("\n".join(manual))


if __name__ == "__main__":
    main()
