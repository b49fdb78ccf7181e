"""The netlist that nextpnr writes for a Gowin GW2A after place and route, as plain Verilog for a simulation.

It is written cell by cell. Names and meanings of cells are those of yosys' ``gowin/cells_sim.v``; nextpnr adds
constants and the heads of carry chains. What block RAMs hold is read when the simulation starts, from the files
``bram_N.hex``: 1,024 rows of 18 bits, as `write_block_rams` takes them from a ``.fs``.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from voxrt.board.designs.gowin import block_ram_cells
from voxrt.board.designs.gowin_bitstream import read_block_rams
from voxrt.board.designs.simulation.placed_netlist import UnknownCellError, lookup

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from voxrt.board.designs.gowin_bitstream import BlockRams

_HERE = Path(__file__).resolve().parent
MODELS = (_HERE.parent / "gowin_cells.sv", _HERE / "placed_gowin_ram.v")
"""The models of PLLs, serializers and block RAM that the Verilog needs."""

_FLIP_FLOP = re.compile(r"DFF(N?)([SRPC]?)(E?)")
_ALU_TABLES = {f"{2:032b}": 0x609A, "C2L": 0, "ONE2C": 0xF}  # add or subtract; a carry of 0, or one that comes out; 1


def write_block_rams(fs: str, rams: BlockRams, folder: Path) -> None:
    """Write what the block RAMs of a ``.fs`` hold as `bram_N.hex` into a folder."""
    for number, rows in read_block_rams(fs, rams).items():
        (folder / f"bram_{number}.hex").write_text("".join(f"{row:05x}\n" for row in rows.tolist()))


def placed_verilog(netlist: Mapping[str, Any]) -> str:
    """Give the Verilog of a netlist after place and route.

    Parameters
    ----------
    netlist
        The JSON of nextpnr. The files ``bram_N.hex`` are numbered as `block_ram_cells` orders its block RAMs.

    Returns
    -------
    str
        Module `top` with the ports of the design. MODELS has what it instantiates.

    Raises
    ------
    UnknownCellError
        A cell is used in a way that is not known here.
    """
    order = {name: number for number, name in enumerate(block_ram_cells(netlist))}
    return _Writer(netlist["modules"]["top"], order).text()


class _Writer:
    def __init__(self, module: Mapping[str, Any], order: Mapping[str, int]) -> None:
        self._module = module
        self._order = order
        self._declarations: list[str] = []
        self._lines: list[str] = []
        self._driven: set[int] = set()
        self._used: set[int] = set()

    def text(self) -> str:
        ports = []
        pads = []
        for name, port in self._module["ports"].items():
            bits = port["bits"]
            ports.append(f"  {port['direction']} {f'[{len(bits) - 1}:0] ' if len(bits) > 1 else ''}{name}")
            for index, bit in enumerate(bits):
                pin = f"{name}[{index}]" if len(bits) > 1 else name
                if port["direction"] == "input":
                    self._driven.add(bit)
                    pads.append(f"  assign n{bit} = {pin};")
                else:
                    pads.append(f"  assign {pin} = {self._use(bit)};")
        for number, (name, cell) in enumerate(self._module["cells"].items()):
            kind = cell["type"]
            if kind in _IGNORED:
                continue
            flip_flop = _FLIP_FLOP.fullmatch(kind)
            if flip_flop is not None:
                self.flip_flop(number, cell, *flip_flop.groups())
            elif kind in _CELLS:
                _CELLS[kind](self, number, name, cell)
            else:
                raise UnknownCellError(f"{name}: cells of type {kind} are not known")
        wires = [f"  wire n{bit};" for bit in sorted(self._used | self._driven)]
        undriven = [f"  assign n{bit} = 1'b0;" for bit in sorted(self._used - self._driven)]
        head = "module top (\n" + ",\n".join(ports) + "\n);\n"
        return head + "\n".join([*wires, *self._declarations, *undriven, *pads, *self._lines]) + "\nendmodule\n"

    def value(self, cell: Mapping[str, Any], pin: str, default: str = "1'b0") -> str:
        """Give what comes in at a pin, as an expression."""
        bits = cell["connections"].get(pin) or [None]
        return default if bits[0] in {None, "x"} else self._bit(bits[0])

    def _bit(self, bit: int | str) -> str:
        return f"1'b{bit}" if isinstance(bit, str) else self._use(bit)

    def bus(self, cell: Mapping[str, Any], pin: str, width: int) -> str:
        """Give what comes in at the pins of a bus, which are ports of their own, or one port."""
        if pin in cell["connections"]:
            return "{" + ", ".join(self._bit(bit) for bit in reversed(cell["connections"][pin])) + "}"
        return "{" + ", ".join(self.value(cell, f"{pin}{index}") for index in reversed(range(width))) + "}"

    def _use(self, bit: int) -> str:
        self._used.add(bit)
        return f"n{bit}"

    def drive(self, cell: Mapping[str, Any], pin: str, expression: str) -> None:
        """Connect an output, if anything is connected to it."""
        for bit in cell["connections"].get(pin) or []:
            self._drive_bit(bit, expression)

    def _drive_bit(self, bit: int | str, expression: str) -> None:
        if isinstance(bit, int):
            self._driven.add(bit)
            self._lines.append(f"  assign n{bit} = {expression};")

    def lut(self, _number: int, _name: str, cell: Mapping[str, Any]) -> None:
        inputs = int(cell["type"][3:])
        table = int(cell["parameters"]["INIT"], 2)
        self.drive(cell, "F", lookup(table, tuple(self.value(cell, f"I{i}", "1'b1") for i in range(inputs))))

    def mux(self, _number: int, _name: str, cell: Mapping[str, Any]) -> None:
        choice, one, zero = (self.value(cell, pin) for pin in ("S0", "I1", "I0"))
        self.drive(cell, "O", f"{choice} ? {one} : {zero}")

    def alu(self, _number: int, name: str, cell: Mapping[str, Any]) -> None:
        # apycula's doc/alu.md: the table of the sum, whose lowest four entries choose the carry where the sum is 0.
        parameters = cell["parameters"]
        if "RAW_ALU_LUT" in parameters:
            table = int(parameters["RAW_ALU_LUT"][-16:], 2)
        elif parameters["ALU_MODE"] in _ALU_TABLES:
            table = _ALU_TABLES[parameters["ALU_MODE"]]
        else:
            raise UnknownCellError(f"{name}: an ALU of mode {parameters['ALU_MODE']} is not known")
        inputs = tuple(self.value(cell, f"I{i}", "1'b1") for i in range(4))
        carry = self.value(cell, "CIN")
        propagates = lookup(table, inputs)
        self.drive(cell, "SUM", f"({propagates}) ^ {carry}")
        self.drive(cell, "COUT", f"({propagates}) ? {carry} : {lookup(table & 0xF, inputs[:2])}")

    def flip_flop(self, number: int, cell: Mapping[str, Any], falls: str, kind: str, enabled: str) -> None:
        value = 1 if kind in {"S", "P"} else 0
        self._declarations.append(f"  reg q{number} = 1'b{value};")
        assignment = f"q{number} <= {self.value(cell, 'D')};"
        if enabled:
            assignment = f"if ({self.value(cell, 'CE')}) {assignment}"
        edge = ""
        if kind:
            reset = self.value(cell, {"S": "SET", "R": "RESET", "P": "PRESET", "C": "CLEAR"}[kind])
            assignment = f"if ({reset}) q{number} <= 1'b{value}; else {assignment}"
            edge = f" or posedge {reset}" if kind in {"P", "C"} else ""
        clock = f"{'negedge' if falls else 'posedge'} {self.value(cell, 'CLK')}"
        self._lines.append(f"  always @({clock}{edge}) {assignment}")
        self.drive(cell, "Q", f"q{number}")

    def small_ram(self, number: int, name: str, cell: Mapping[str, Any]) -> None:
        if any(int(cell["parameters"].get(f"INIT_{i}", "0"), 2) for i in range(4)):
            raise UnknownCellError(f"{name}: a memory in logic with contents is not known")
        self._declarations.append(f"  reg [3:0] m{number} [0:15];")
        clock, enable = self.value(cell, "CLK"), self.value(cell, "WRE")
        write, data, read = (self.bus(cell, pin, 4) for pin in ("WAD", "DI", "RAD"))
        self._declarations.append(f"  wire [3:0] d{number} = m{number}[{read}];")
        self._lines.append(f"  always @(posedge {clock}) if ({enable}) m{number}[{write}] <= {data};")
        for i, bit in enumerate(cell["connections"]["DO"]):
            self._drive_bit(bit, f"d{number}[{i}]")

    def block_ram(self, number: int, name: str, cell: Mapping[str, Any]) -> None:
        kind, parameters = cell["type"], cell["parameters"]
        for pin in cell["connections"]:
            if pin.startswith(("BLKSEL", "RESET")) and self._constant(cell, pin) != 0:
                raise UnknownCellError(f"{name}: a block RAM whose pin {pin} is used is not known")
        if any(int(value, 2) for key, value in parameters.items() if key.startswith("READ_MODE")):
            raise UnknownCellError(f"{name}: a block RAM with output registers is not known")
        file = f'.FILE("bram_{self._order[name]}.hex")' if name in self._order else '.FILE("")'
        if kind == "SP":
            ports = {"A": ("", "BIT_WIDTH", "WRITE_MODE")}
        else:
            ports = {"A": ("A", "BIT_WIDTH_0", "WRITE_MODE0"), "B": ("B", "BIT_WIDTH_1", "WRITE_MODE1")}
        settings, pins = [file], []
        for port, (suffix, width, mode) in ports.items():
            settings += [
                f".WIDTH_{port}({int(parameters[width], 2)})",
                f".MODE_{port}({int(parameters.get(mode, '0'), 2)})",
            ]
            writes = {"SP": "WRE", "DP": f"WRE{suffix}"}.get(kind)
            # Port A of a simple dual port memory writes whenever it is enabled, and port B reads.
            write = ("1'b1" if port == "A" else "1'b0") if writes is None else self.value(cell, writes)
            enable = self.value(cell, f"CE{suffix}")
            address = self.bus(cell, f"AD{suffix}", 14)
            if kind == "SP" and int(parameters[width], 2) in (32, 36):
                address = self._wide_address(name, cell)
            data = self.bus(cell, "DI" if kind != "DP" else f"DI{suffix}", 36 if kind != "DP" else 18)
            pins += [f".CLK{port}({self.value(cell, f'CLK{suffix}')})", f".CE{port}({enable})", f".WRE{port}({write})"]
            pins += [f".AD{port}({address})", f".DI{port}({data})"]
            reads = kind != "SDP" or port == "B"
            self._declarations.append(f"  wire [35:0] o{port.lower()}{number};")
            pins.append(f".DO{port}(o{port.lower()}{number})")
            for i in range(36 if reads else 0):
                self.drive(cell, f"DO{i}" if kind != "DP" else f"DO{suffix}{i}", f"o{port.lower()}{number}[{i}]")
        self._lines.append(f"  placed_gowin_ram #({', '.join(settings)}) b{number} ({', '.join(pins)});")

    def _wide_address(self, name: str, cell: Mapping[str, Any]) -> str:
        """Give the address of a single port of two rows: port B has the upper one, with enables of its own."""
        connections = cell["connections"]
        if any(connections[f"AD{index}"] != connections[f"ADB{index}"] for index in range(5, 14)):
            raise UnknownCellError(f"{name}: a block RAM of two rows at two addresses is not known")
        pins = [f"AD{index}" for index in reversed(range(4, 14))] + ["ADB1", "ADB0", "AD1", "AD0"]
        return "{" + ", ".join(self.value(cell, pin) for pin in pins) + "}"

    def _constant(self, cell: Mapping[str, Any], pin: str) -> int | None:
        """Give what a pin always is; None if that changes."""
        bits = cell["connections"].get(pin) or []
        if not bits:
            return None
        if isinstance(bits[0], str):
            return {"0": 0, "1": 1}.get(bits[0])
        for other in self._module["cells"].values():
            if other["type"] in _CONSTANTS and bits[0] in other["connections"].get(_CONSTANTS[other["type"]][0], []):
                return _CONSTANTS[other["type"]][1]
        return None

    def multiplier(self, number: int, name: str, cell: Mapping[str, Any]) -> None:
        if cell["parameters"]:
            raise UnknownCellError(f"{name}: a multiplier with registers is not known")
        factors = []
        for side in "AB":
            if self._constant(cell, f"{side}SEL") != 0:
                raise UnknownCellError(f"{name}: a multiplier whose pin {side}SEL is used is not known")
            signed = self.value(cell, f"{side}SIGN")
            factor = f"{side.lower()}{number}"
            self._declarations.append(f"  wire [17:0] {factor} = {self.bus(cell, side, 18)};")
            factors.append(f"{{{{18{{{factor}[17] & {signed}}}}}, {factor}}}")
        self._declarations.append(f"  wire [35:0] p{number} = {' * '.join(factors)};")
        for i in range(36):
            self.drive(cell, f"DOUT{i}", f"p{number}[{i}]")

    def constant(self, _number: int, _name: str, cell: Mapping[str, Any]) -> None:
        pin, level = _CONSTANTS[cell["type"]]
        self.drive(cell, pin, f"1'b{level}")

    def buffer(self, _number: int, _name: str, cell: Mapping[str, Any]) -> None:
        side = cell["parameters"].get("DIFF")
        if side is None:
            self.drive(cell, "O", self.value(cell, "I"))
            return
        # A pair of pins, with the serializer of its place.
        place = cell["attributes"]["NEXTPNR_BEL"].split("/")[0]
        self.drive(cell, "O", f"{'~' if side == 'N' else ''}serial_{place}")

    def instance(self, number: int, _name: str, cell: Mapping[str, Any]) -> None:
        kind = cell["type"]
        numbers = ("IDIV_SEL", "FBDIV_SEL")
        settings = [f".{key}({int(cell['parameters'][key], 2)})" for key in numbers if key in cell["parameters"]]
        pins = []
        for pin in _INSTANCES[kind]:
            if cell["port_directions"][pin] == "output":
                output = f"{pin.lower()}_{number}"
                if kind == "OSER10":
                    output = f"serial_{cell['attributes']['NEXTPNR_BEL'].split('/')[0]}"
                self._declarations.append(f"  wire {output};")
                pins.append(f".{pin}({output})")
                self.drive(cell, pin, output)
            else:
                pins.append(f".{pin}({self.value(cell, pin)})")
        parameters = f" #({', '.join(settings)})" if settings else ""
        self._lines.append(f"  {kind}{parameters} i{number} ({', '.join(pins)});")


_CONSTANTS = {"GOWIN_VCC": ("V", 1), "GOWIN_GND": ("G", 0)}
_INSTANCES = {
    "rPLL": ("CLKIN", "CLKOUT", "LOCK"),
    "CLKDIV": ("HCLKIN", "CLKOUT"),
    "OSER10": (*(f"D{i}" for i in range(10)), "FCLK", "PCLK", "Q"),
}
_IGNORED = {"GSR", "DUMMY_CELL", "IOLOGIC_DUMMY"}
_CELLS: dict[str, Callable[[_Writer, int, str, Mapping[str, Any]], None]] = {
    **{f"LUT{inputs}": _Writer.lut for inputs in range(1, 5)},
    **{f"MUX2_LUT{inputs}": _Writer.mux for inputs in range(5, 9)},
    **dict.fromkeys(("SP", "DP", "SDP"), _Writer.block_ram),
    **dict.fromkeys(_CONSTANTS, _Writer.constant),
    **dict.fromkeys(("IBUF", "OBUF", "BUFG"), _Writer.buffer),
    **dict.fromkeys(_INSTANCES, _Writer.instance),
    "ALU": _Writer.alu,
    "RAM16SDP4": _Writer.small_ram,
    "MULT18X18": _Writer.multiplier,
}
