"""The clock-domain crossings of a netlist of yosys: which registers of one clock depend on those of another.

A crossing is a register, a memory or a pin's register with an input that a register of another clock, or a pin, reaches
through logic. Both edges of a clock are one domain.

Usage: ``python -m voxrt.board.designs.crossings FOLDER/top.json`` prints the list.
"""

from __future__ import annotations

import json
import re
import sys
from collections import Counter, defaultdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

PINS = "pins"
"""The domain of what comes from outside: input pins, and the PLL's lock."""

_BLOCK_RAM = re.compile(r"^(?:AD|DI|DO|CE|OCE|WE|RST|CS)([AB])\d*$")
_OUTSIDE = {"EHXPLLL": "LOCK", "BB": "O", "TRELLIS_IO": "O"}
_MADE_UP = re.compile(r"_(?:LUT4|TRELLIS_FF|PFUMX|L6MUX21|CCU2C|DP16KD|TRELLIS_DPR16X4|MULT18X18D)_")
_CLOCKS = {"CLKOP": "bit", "CLKOS": "pixel", "CLKOS2": "system", "CLKOS3": "chip"}  # board_pll.sv


class Crossing(Value, frozen=True, order=True):
    """Registers that depend on registers of another clock.

    Attributes
    ----------
    start, end
        The clocks.
    source, target
        The registers, by their names without the numbers of bits; of a memory, the name of its cell.
    bits
        Bits of the target that depend on the source; of a memory with two clocks, its block RAMs.
    is_synchronized
        Each of the bits is taken as it is, without logic, by a flip-flop that another flip-flop alone reads.
    """

    start: str
    end: str
    source: str
    target: str
    bits: int
    is_synchronized: bool


class _Element(Value, frozen=True):
    """What one clock of a cell takes, and what it gives."""

    clock: int
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    cell: str


def find_crossings(netlist: Mapping[str, Any], top: str) -> list[Crossing]:
    """List the crossings of a netlist.

    Parameters
    ----------
    netlist
        The JSON of yosys, mapped for the ECP5 and flat.
    top
        The module.

    Returns
    -------
    list of Crossing
        Sorted.
    """
    module = netlist["modules"][top]
    names = _names_of(module)
    elements, drivers = _read_cells(module)
    launched = _launched(module, elements, names)
    readers: Counter[int] = Counter(bit for element in elements for bit in element.inputs)
    taken = set(readers)  # by a register, without logic
    readers.update(bit for before in drivers.values() for bit in set(before))
    reached: dict[int, frozenset[tuple[str, str]]] = {}
    found: dict[tuple[str, str, str, str], dict[int, bool]] = defaultdict(dict)
    for element in elements:
        end, outputs = names[element.clock], element.outputs
        alone = len(outputs) == 1 and readers[outputs[0]] == 1 and outputs[0] in taken
        for bit in element.inputs:
            for start, source in _sources(bit, launched, drivers, reached):
                if start != end:
                    target = _register(names, outputs[0] if outputs else -1, element.cell)
                    bits = found[start, end, source, target]
                    mark = outputs[0] if len(outputs) == 1 else bit
                    bits[mark] = bits.get(mark, True) and alone and bit in launched
    crossings = [Crossing(*key, len(bits), all(bits.values())) for key, bits in found.items()]
    return sorted(crossings + _memories(elements, names))


def _memories(elements: Sequence[_Element], names: Mapping[int, str]) -> list[Crossing]:
    """Give the memories with two clocks; what they hold is not followed."""
    found: dict[str, list[str]] = defaultdict(list)
    for element in elements:
        found[element.cell].append(names[element.clock])
    shared = Counter(
        (*sorted(both), re.sub(r"(\.\d+)*$", "", cell)) for cell, both in found.items() if len(set(both)) > 1
    )
    return [
        Crossing(start, end, name, name, cells, is_synchronized=False) for (start, end, name), cells in shared.items()
    ]


def _launched(
    module: Mapping[str, Any], elements: Sequence[_Element], names: Mapping[int, str]
) -> dict[int, tuple[str, str]]:
    """Give the clock and the register that each net comes from which no logic drives."""
    launched = {
        bit: (names[element.clock], _register(names, bit, element.cell))
        for element in elements
        for bit in element.outputs
    }
    for name, port in module["ports"].items():
        if port["direction"] != "output":
            launched |= {bit: (PINS, name) for bit in port["bits"] if isinstance(bit, int)}
    for name, cell in module["cells"].items():
        if cell["type"] in _OUTSIDE:
            launched |= {bit: (PINS, _register(names, bit, name)) for bit in _bits(cell, _OUTSIDE[cell["type"]])}
    return launched


def _sources(
    bit: int,
    launched: Mapping[int, tuple[str, str]],
    drivers: Mapping[int, tuple[int, ...]],
    reached: dict[int, frozenset[tuple[str, str]]],
) -> frozenset[tuple[str, str]]:
    """Give the registers that reach a net through logic: clocks and names."""
    stack = [bit]
    while stack:
        now = stack[-1]
        if now in reached:
            stack.pop()
        elif now in launched:
            reached[stack.pop()] = frozenset((launched[now],))
        else:
            before = drivers.get(now, ())
            missing = [each for each in before if each not in reached]
            if missing:
                stack += missing
            else:
                reached[stack.pop()] = frozenset().union(*(reached[each] for each in before))
    return reached[bit]


def _read_cells(module: Mapping[str, Any]) -> tuple[list[_Element], dict[int, tuple[int, ...]]]:
    """Give what has clocks, and the nets that each other net depends on."""
    elements: list[_Element] = []
    drivers: dict[int, tuple[int, ...]] = {}
    for name, cell in module["cells"].items():
        clocks = list(_clocks(cell))
        inputs, outputs = (
            {pin: _bits(cell, pin) for pin, way in cell["port_directions"].items() if way == direction}
            for direction in ("input", "output")
        )
        for pin, side in clocks:
            bits = _bits(cell, pin)
            if not bits:
                continue
            taken, launched = (
                tuple(bit for other, bits in pins.items() if other != pin and _is_of(other, side) for bit in bits)
                for pins in (inputs, outputs)
            )
            elements.append(_Element(bits[0], taken, launched, name))
        if not clocks and cell["type"] not in _OUTSIDE:
            before = tuple(bit for bits in inputs.values() for bit in bits)
            drivers |= {bit: before for bits in outputs.values() for bit in bits}
    return elements, drivers


def _clocks(cell: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Give the clock pins of a cell, each with the side of a block RAM that it is of; "" for all pins."""
    kind, parameters = cell["type"], cell["parameters"]
    if kind == "TRELLIS_FF":
        yield "CLK", ""
    elif kind in {"ODDRX1F", "OFS1P3BX"}:
        yield "SCLK", ""
    elif kind == "TRELLIS_DPR16X4":
        yield "WCK", ""
    elif kind == "DP16KD":
        yield from (("CLKA", "A"), ("CLKB", "B"))
    elif kind == "MULT18X18D":
        used = {value for name, value in parameters.items() if name.startswith("REG_") and name.endswith("_CLK")}
        yield from ((clock, "") for clock in sorted(used - {"NONE"}))


def _is_of(pin: str, side: str) -> bool:
    match = _BLOCK_RAM.match(pin) if side else None
    return not side or (match is not None and match[1] == side)


def _bits(cell: Mapping[str, Any], pin: str) -> tuple[int, ...]:
    return tuple(bit for bit in cell["connections"].get(pin, ()) if isinstance(bit, int))


def _names_of(module: Mapping[str, Any]) -> dict[int, str]:
    """Name each net: of its public names that of a register if there is one, then the longest."""
    names: dict[int, str] = {}
    for name, net in module["netnames"].items():
        if net["hide_name"] or _MADE_UP.search(name):
            continue
        for index, bit in enumerate(net["bits"]):
            if isinstance(bit, int):
                full = f"{name}[{index}]" if len(net["bits"]) > 1 else name
                names[bit] = max(names.get(bit, ""), full, key=_preference)
    for cell in module["cells"].values():
        if cell["type"] == "EHXPLLL":
            names |= {bit: clock for pin, clock in _CLOCKS.items() for bit in _bits(cell, pin)}
    return names


def _preference(name: str) -> tuple[bool, int, str]:
    return re.search(r"_n?q(\[\d+\])*$", name) is not None, len(name), name


def _register(names: Mapping[int, str], bit: int, cell: str) -> str:
    """Name the register that drives a net: a star for each number of a bit or an instance."""
    return re.sub(r"(\[\*\])+$", "", re.sub(r"\[\d+\]", "[*]", names.get(bit, cell)))


if __name__ == "__main__":
    for crossing in find_crossings(json.loads(Path(sys.argv[1]).read_text()), sys.argv[2]):
        print(*(getattr(crossing, name) for name in crossing.__struct_fields__), sep="\t")
