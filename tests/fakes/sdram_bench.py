"""The SDRAM of a board with a model of the chip: the bench of tests/board/test_sdram.py and bench/sdram.py."""

from __future__ import annotations

import subprocess
from pathlib import Path

from fakes.verilated import compile_bench

ROOT = Path(__file__).resolve().parents[2]
DESIGNS, TESTS = ROOT / "board" / "designs", ROOT / "tests" / "board"
SOURCES = [
    ROOT / "rtl" / "voxrt_pkg.sv",
    DESIGNS / "board_pkg.sv",
    ROOT / "rtl" / "memory" / "voxrt_axi_read_master.sv",
    *(DESIGNS / name for name in ("board_sdram.sv", "board_sdram_arbiter.sv", "board_sdram_axi.sv")),
    DESIGNS / "simulation" / "sdram_model.sv",
    TESTS / "sdram_bench.sv",
    TESTS / "sdram_bench.cpp",
]


def run_bench(folder: Path, clocks: int, **parameters: int) -> subprocess.CompletedProcess[str]:
    """Compile the bench in a folder and run it: a line of counts, then clocks per line by kind of traffic."""
    options = [f"-G{name}={value}" for name, value in parameters.items()]
    program = compile_bench("sdram_bench", SOURCES, folder, "-O3", "--assert", f"+incdir+{ROOT / 'rtl'}", *options)
    return subprocess.run([program, str(clocks)], capture_output=True, text=True, check=False)


def clocks_per_line(printed: list[str]) -> dict[str, float]:
    """Read what the bench prints after its first line."""
    return {name: float(value) for name, value in (line.split() for line in printed)}
