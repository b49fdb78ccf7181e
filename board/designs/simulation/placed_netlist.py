"""The netlist that nextpnr-ecp5 writes after place and route (``--write``), as plain Verilog for a simulation.

It is written cell by cell as the hardware works: an unconnected input of a lookup table, a block RAM or a multiplier
is 1; a parameter ``<PIN>MUX`` ties a pin to 0 or 1, or inverts it. What block RAMs hold is read when the simulation
starts, from the files ``bram_WID.hex``: 1,024 rows of 18 bits, as `write_block_rams` takes them from a ``.config``.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from voxrt.board.designs.base_design import read_block_rams

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_HERE = Path(__file__).resolve().parent
MODELS = (_HERE.parent / "ecp5_cells.sv", _HERE / "placed_ram.v")
"""The models of PLL, output register and block RAM that the Verilog needs."""

_PIN_WIDTHS = {"AD": 14, "DI": 18, "DO": 18}


class UnknownCellError(ValueError):
    """A cell, or a use of it, that this module cannot write."""


def write_block_rams(config: str, folder: Path) -> None:
    """Write what the block RAMs of a ``.config`` hold as `bram_WID.hex` into a folder."""
    for wid, rows in read_block_rams(config).items():
        (folder / f"bram_{wid}.hex").write_text("".join(f"{row:05x}\n" for row in rows.tolist()))


def placed_verilog(netlist: Mapping[str, Any]) -> str:
    """Give the Verilog of a netlist after place and route.

    Parameters
    ----------
    netlist
        The JSON of ``nextpnr-ecp5 --write``.

    Returns
    -------
    str
        Module `top` with the ports of the design. MODELS has what it instantiates.

    Raises
    ------
    UnknownCellError
        A cell is used in a way that is not known here.
    """
    return _Writer(netlist["modules"]["top"]).text()


class _Writer:
    def __init__(self, module: Mapping[str, Any]) -> None:
        self._module = module
        self._declarations: list[str] = []
        self._lines: list[str] = []
        self._driven: set[int] = set()
        self._used: set[int] = set()
        self._pads: dict[int, str] = {}

    def text(self) -> str:
        ports = []
        for name, port in self._module["ports"].items():
            width = f"[{len(port['bits']) - 1}:0] " if len(port["bits"]) > 1 else ""
            ports.append(f"  {port['direction']} {width}{name}")
            for index, bit in enumerate(port["bits"]):
                self._pads[bit] = name + (f"[{index}]" if width else "")
        for number, (name, cell) in enumerate(self._module["cells"].items()):
            write = _CELLS.get(cell["type"])
            if write is None:
                raise UnknownCellError(f"{name}: cells of type {cell['type']} are not known")
            write(self, number, cell)
        wires = [f"  wire n{bit};" for bit in sorted(self._used | self._driven)]
        undriven = [f"  assign n{bit} = 1'b1;" for bit in sorted(self._used - self._driven)]
        head = "module top (\n" + ",\n".join(ports) + "\n);\n"
        body = "\n".join([*wires, *self._declarations, *undriven, *self._lines])
        return head + body + "\nendmodule\n"

    def net(self, cell: Mapping[str, Any], pin: str) -> int | str | None:
        """Give the net of a pin: a number, "0" or "1", or None where there is none."""
        bits = cell["connections"].get(pin) or [None]
        bit: int | str | None = bits[0]
        return bit

    def value(self, cell: Mapping[str, Any], pin: str, default: str = "1'b1") -> str:
        """Give what comes in at a pin, as an expression."""
        chosen = cell["parameters"].get(f"{pin}MUX", pin).strip()
        if chosen in {"0", "1"}:
            return f"1'b{chosen}"
        bit = self.net(cell, pin)
        inside = default if bit is None else f"1'b{bit}" if isinstance(bit, str) else self._use(bit)
        if chosen == "INV":
            return {"1'b0": "1'b1", "1'b1": "1'b0"}.get(inside, f"~{inside}")
        return inside

    def _use(self, bit: int) -> str:
        self._used.add(bit)
        return f"n{bit}"

    def drive(self, cell: Mapping[str, Any], pin: str, expression: str) -> None:
        """Connect an output, if anything is connected to it."""
        bit = self.net(cell, pin)
        if isinstance(bit, int):
            self._driven.add(bit)
            self._lines.append(f"  assign n{bit} = {expression};")

    def output(self, cell: Mapping[str, Any], pin: str) -> str:
        """Give the net that an instance drives."""
        bit = self.net(cell, pin)
        if not isinstance(bit, int):
            return ""
        self._driven.add(bit)
        return f"n{bit}"

    def comb(self, number: int, cell: Mapping[str, Any]) -> None:
        parameters = cell["parameters"]
        mode = parameters.get("MODE", "LOGIC").strip()
        if mode == "RAMW_BLOCK":
            return
        initial = int(parameters["INITVAL"].strip()[-16:], 2)
        a, b, c, d = (self.value(cell, pin) for pin in "ABCD")
        if mode == "DPRAM":
            self._declarations.append(f"  reg [15:0] ram{number} = 16'd{initial};")
            clock, enable, data = (self.value(cell, pin) for pin in ("WCK", "WRE", "WD"))
            place = ", ".join(self.value(cell, f"WAD{i}") for i in (3, 2, 1, 0))
            self._lines.append(f"  always @(posedge {clock}) if ({enable}) ram{number}[{{{place}}}] <= {data};")
            f = f"ram{number}[{{{a}, {c}, {b}, {d}}}]"
        else:
            f = lookup(initial, (a, b, c, d))
        if mode == "CCU2":
            # The carry is passed on, or generated by the lowest quarter of the table, of A and B.
            carry, propagates, generates = self.value(cell, "FCI", "1'b0"), f, lookup(initial & 0xF, (a, b))
            if parameters["CCU2_INJECT1"].strip() == "YES":
                generates = "1'b0"
            else:
                f = _xor(propagates, carry)
            self.drive(cell, "FCO", f"{propagates} ? {carry} : {generates}")
        self.drive(cell, "F", f)
        if self.net(cell, "OFX") is not None:
            m = self.value(cell, "M")
            if self.net(cell, "FXA") is not None or self.net(cell, "FXB") is not None:
                self.drive(cell, "OFX", f"{m} ? {self.value(cell, 'FXB')} : {self.value(cell, 'FXA')}")
            else:
                self.drive(cell, "OFX", f"{m} ? {self.value(cell, 'F1')} : ({f})")

    def flip_flop(self, number: int, cell: Mapping[str, Any]) -> None:
        parameters = cell["parameters"]
        data = self.value(cell, "DI" if parameters["SD"].strip() == "1" else "M")
        value = 1 if parameters["REGSET"].strip() == "SET" else 0
        self._declarations.append(f"  reg q{number} = 1'b{value};")
        enable = self.value(cell, "CE")
        assignment = f"q{number} <= {data};"
        if enable != "1'b1":
            assignment = f"if ({enable}) {assignment}"
        edge = ""
        if self.net(cell, "LSR") is not None and parameters["LSRMUX"].strip() not in {"0", "1"}:
            reset = self.value(cell, "LSR")
            mode = parameters.get("SRMODE", "LSR_OVER_CE").strip()
            assignment = f"if ({reset}) q{number} <= 1'b{value}; else {assignment}"
            if mode == "ASYNC":
                edge = f" or posedge {reset}"
            elif mode != "LSR_OVER_CE":
                raise UnknownCellError(f"a flip-flop with SRMODE {mode} is not known")
        self._lines.append(f"  always @(posedge {self.value(cell, 'CLK')}{edge}) {assignment}")
        self.drive(cell, "Q", f"q{number}")

    def ram_write(self, _number: int, cell: Mapping[str, Any]) -> None:
        for output, source in zip(("WADO0", "WADO1", "WADO2", "WADO3"), ("D0", "B0", "C0", "A0"), strict=True):
            self.drive(cell, output, self.value(cell, source))
        for output, source in zip(("WDO0", "WDO1", "WDO2", "WDO3"), ("C1", "A1", "D1", "B1"), strict=True):
            self.drive(cell, output, self.value(cell, source))

    def block_ram(self, number: int, cell: Mapping[str, Any]) -> None:
        parameters = cell["parameters"]
        for port in "AB":
            if parameters.get(f"REGMODE_{port}", "NOREG").strip() != "NOREG":
                raise UnknownCellError("a block RAM with output registers is not known")
            selected = int(parameters[f"CSDECODE_{port}"].replace("0b", ""), 2)
            for index in range(3):
                if self.value(cell, f"CS{port}{index}") != f"1'b{selected >> index & 1}":
                    raise UnknownCellError("a block RAM that is selected by logic is not known")
        pins = []
        for port in "AB":
            pins += [f".{name}{port}({self.value(cell, name + port)})" for name in ("CLK", "CE", "WE", "RST")]
            for name in ("AD", "DI"):
                bits = ", ".join(self.value(cell, f"{name}{port}{i}") for i in reversed(range(_PIN_WIDTHS[name])))
                pins.append(f".{name}{port}({{{bits}}})")
            self._declarations.append(f"  wire [17:0] do{port.lower()}{number};")
            pins.append(f".DO{port}(do{port.lower()}{number})")
            for i in range(18):
                self.drive(cell, f"DO{port}{i}", f"do{port.lower()}{number}[{i}]")
        widths = ", ".join(f".WIDTH_{port}({int(parameters[f'DATA_WIDTH_{port}'], 2)})" for port in "AB")
        wid = int(cell["attributes"]["WID"], 2)
        self._lines.append(f'  placed_ram #({widths}, .FILE("bram_{wid}.hex")) b{number} ({", ".join(pins)});')

    def multiplier(self, number: int, cell: Mapping[str, Any]) -> None:
        for name, setting in cell["parameters"].items():
            known = name.startswith(("REG_INPUTA_", "REG_INPUTB_", "REG_OUTPUT_"))
            if name.startswith("REG_") and name.endswith("_CLK") and not known and setting.strip() != "NONE":
                raise UnknownCellError(f"a multiplier with a register {name.removesuffix('_CLK')} is not known")
        for pin in ("SOURCEA", "SOURCEB"):
            if self._constant(cell, pin) != 0:
                raise UnknownCellError(f"a multiplier whose pin {pin} is used is not known")
        factors = []
        for side in "AB":
            signed = self._constant(cell, f"SIGNED{side}")
            if signed is None:
                raise UnknownCellError(f"a multiplier whose pin SIGNED{side} is not constant is not known")
            factor = f"{side.lower()}{number}"
            bits = ", ".join(self.value(cell, f"{side}{i}") for i in reversed(range(18)))
            self._multiplier_value(cell, f"INPUT{side}", factor, 18, f"{{{bits}}}")
            # The factors have 36 bits, so that the product's 36 bits are right whether a factor has a sign or not.
            sign = f"{factor}[17]" if signed else "1'b0"
            factors.append(f"{{{{18{{{sign}}}}}, {factor}}}")
        self._multiplier_value(cell, "OUTPUT", f"p{number}", 36, f"{factors[0]} * {factors[1]}")
        for i in range(36):
            self.drive(cell, f"P{i}", f"p{number}[{i}]")

    def _multiplier_value(self, cell: Mapping[str, Any], register: str, name: str, bits: int, value: str) -> None:
        """Write a factor or a product of a multiplier under a name, behind its register where that is used."""
        clock, enable, reset = (
            cell["parameters"].get(f"REG_{register}_{kind}", default).strip()
            for kind, default in (("CLK", "NONE"), ("CE", "CE0"), ("RST", "RST0"))
        )
        if clock == "NONE":
            self._declarations.append(f"  wire [{bits - 1}:0] {name};")
            self._lines.append(f"  assign {name} = {value};")
            return
        if self._constant(cell, reset) != 0:
            raise UnknownCellError(f"a multiplier whose register {register} has a reset is not known")
        self._declarations.append(f"  reg [{bits - 1}:0] {name} = {bits}'d0;")
        self._lines.append(
            f"  always @(posedge {self.value(cell, clock)}) if ({self.value(cell, enable)}) {name} <= {value};"
        )

    def _constant(self, cell: Mapping[str, Any], pin: str) -> int | None:
        """Give what a pin always is; None if that changes."""
        bit = self.net(cell, pin)
        chosen = cell["parameters"].get(f"{pin}MUX", "").strip()
        for level in (chosen, bit):
            if level in {"0", "1"}:
                return int(level)
        drivers = [
            other
            for other in self._module["cells"].values()
            if other["type"] == "TRELLIS_COMB" and bit in other["connections"].get("F", [])
        ]
        values = set(drivers[0]["parameters"]["INITVAL"].strip()[-16:]) if len(drivers) == 1 else set()
        return int(values.pop()) if len(values) == 1 else None

    def pad(self, _number: int, cell: Mapping[str, Any]) -> None:
        place = self._pads[cell["connections"]["B"][0]]
        parameters = cell["parameters"]
        direction = parameters["DIR"].strip()
        if direction not in {"INPUT", "OUTPUT", "BIDIR"}:
            raise UnknownCellError(f"{place}: a pin with direction {direction} is not known")
        if direction != "OUTPUT":
            self.drive(cell, "O", place)
        if direction != "INPUT":
            registered = "IOLDO" in {parameters.get(f"DATAMUX_{name}", "").strip() for name in ("ODDR", "OREG")}
            source = self.value(cell, "IOLDO" if registered else "I")
            if direction == "BIDIR":
                release = "IOLTO" if parameters.get("TRIMUX_TSREG", "").strip() == "IOLTO" else "T"
                source = f"{self.value(cell, release)} ? 1'bz : {source}"
            self._lines.append(f"  assign {place} = {source};")

    def pad_register(self, number: int, cell: Mapping[str, Any]) -> None:
        parameters = cell["parameters"]
        mode = parameters["MODE"].strip()
        if mode == "IDDRX1_ODDRX1":
            pins = {"D0": "TXDATA0", "D1": "TXDATA1", "SCLK": "CLK"}
            inputs = ", ".join(f".{name}({self.value(cell, pin)})" for name, pin in pins.items())
            self._lines.append(f"  ODDRX1F o{number} ({inputs}, .RST(1'b0), .Q({self.output(cell, 'IOLDO')}));")
            return
        if mode != "IREG_OREG" or self._constant(cell, "LSR") != 0 or self._constant(cell, "CE") != 1:
            raise UnknownCellError("a register at a pin is neither an ODDRX1F nor a flip-flop without reset and enable")
        for name, data, output in (("OUTREG", "TXDATA0", "IOLDO"), ("TSREG", "TSDATA0", "IOLTO")):
            if parameters.get(f"{name}.OUTREGMODE", "").strip() == "FF":
                value = 1 if parameters[f"{name}.REGSET"].strip() == "SET" else 0
                register = f"{output.lower()}{number}"
                self._declarations.append(f"  reg {register} = 1'b{value};")
                self._lines.append(
                    f"  always @(posedge {self.value(cell, 'CLK')}) {register} <= {self.value(cell, data)};"
                )
                self.drive(cell, output, register)

    def clock_gate(self, _number: int, cell: Mapping[str, Any]) -> None:
        self.drive(cell, "CLKO", self.value(cell, "CLKI"))

    def pll(self, number: int, cell: Mapping[str, Any]) -> None:
        clocks = ["CLKOP", "CLKOS", "CLKOS2"]
        if isinstance(self.net(cell, "CLKOS3"), int):
            clocks.append("CLKOS3")
        names = [f"{clock}_{what}" for clock in clocks for what in ("DIV", "CPHASE")]
        settings = ", ".join(f".{name}({int(cell['parameters'][name], 2)})" for name in names)
        outputs = ", ".join(f".{pin}({self.output(cell, pin)})" for pin in (*clocks, "LOCK"))
        self._lines.append(f"  EHXPLLL #({settings}) l{number} (.CLKI({self.value(cell, 'CLKI')}), {outputs});")


_CELLS: dict[str, Callable[[_Writer, int, Mapping[str, Any]], None]] = {
    "TRELLIS_COMB": _Writer.comb,
    "TRELLIS_FF": _Writer.flip_flop,
    "TRELLIS_RAMW": _Writer.ram_write,
    "DP16KD": _Writer.block_ram,
    "MULT18X18D": _Writer.multiplier,
    "TRELLIS_IO": _Writer.pad,
    "IOLOGIC": _Writer.pad_register,  # of pins at the left and right sides
    "SIOLOGIC": _Writer.pad_register,  # above and below
    "DCCA": _Writer.clock_gate,
    "EHXPLLL": _Writer.pll,
}


def lookup(table: int, inputs: tuple[str, ...]) -> str:
    """Give the function of a table as an expression of Verilog; the last input is the highest bit of the index."""
    if not inputs:
        return f"1'b{table & 1}"
    *rest, last = inputs
    half = 1 << len(rest)
    low, high = table & ((1 << half) - 1), table >> half
    if last == "1'b0" or low == high:
        return lookup(low, tuple(rest))
    if last == "1'b1":
        return lookup(high, tuple(rest))
    ones = (1 << half) - 1
    if low == high ^ ones:
        return _xor(lookup(low, tuple(rest)), last)
    zero, one = lookup(low, tuple(rest)), lookup(high, tuple(rest))
    forms = {low == 0: f"({last} & {one})", low == ones: f"(~{last} | {one})"}
    forms |= {high == 0: f"(~{last} & {zero})", high == ones: f"({last} | {zero})"}
    return forms.get(True, f"({last} ? {one} : {zero})")


def _xor(first: str, second: str) -> str:
    if first in {"1'b0", "1'b1"} or second in {"1'b0", "1'b1"}:
        constant, other = (first, second) if first in {"1'b0", "1'b1"} else (second, first)
        return other if constant == "1'b0" else f"~{other}"
    return f"({first} ^ {second})"
