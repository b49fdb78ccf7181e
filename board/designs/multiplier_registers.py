"""Move flip-flops into the multipliers that they stand beside, after synthesis.

A MULT18X18D has registers for its factors and for its product, and yosys leaves them unused. Multipliers stand in a few
rows of the part, so a flip-flop before or behind one is far from it, or from what it is computed of. With the flip-flop
inside, a clock holds one of these ways and not two, and nextpnr knows the shorter times of such a multiplier.

A multiplier takes the flip-flops of both factors or of none, since nextpnr knows the times of these two kinds only. All
bits of a factor, or of a product, must have flip-flops of one clock and one enable, without reset, whose first value is
0, as the multiplier's registers have them. A flip-flop of a factor that feeds something else stays there, too. A
product moves only where nothing but its flip-flops reads it.

Multipliers of one block share four wires for enables. So a netlist's enables are numbered, each has the same wire
everywhere, and a register that needs a fifth stays outside.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

FACTOR_BITS = 18
PRODUCT_BITS = 36
ENABLE_WIRES = 4


class _Control(NamedTuple):
    """The clock and the enable of a register: nets; "1" is the enable of one without."""

    clock: int
    enable: int | str


class _Register(NamedTuple):
    """Flip-flops as one register."""

    control: _Control
    pins: dict[str, int | str]
    """What the multiplier's pins are connected to once it is inside: nets, "0" or "1"."""


def use_multiplier_registers(netlist: Mapping[str, Any]) -> dict[str, Any]:
    """Give a netlist of yosys in which multipliers hold the flip-flops beside them.

    Parameters
    ----------
    netlist
        Of ``synth_ecp5``, as its JSON is read. It is not changed.

    Returns
    -------
    dict
        The netlist. Flip-flops that moved, and that nothing else reads, are gone.

    Examples
    --------
    >>> use_multiplier_registers({"modules": {"top": {"ports": {}, "cells": {}}}})
    {'modules': {'top': {'ports': {}, 'cells': {}}}}
    """
    modules = {name: {**module, "cells": _cells(module)} for name, module in netlist["modules"].items()}
    return {**netlist, "modules": modules}


def _cells(module: Mapping[str, Any]) -> dict[str, Any]:
    cells: dict[str, Any] = dict(module.get("cells", {}))
    multipliers = sorted(name for name, cell in cells.items() if cell["type"] == "MULT18X18D")
    enables: dict[int | str, str] = {}

    drivers = {cell["connections"]["Q"][0]: name for name, cell in _flip_flops(cells).items()}
    before: set[str] = set()
    for name in multipliers:
        factors = [_factor(cells, cells[name], side, drivers) for side in "AB"]
        moved = _with_registers(cells[name], dict(zip(("INPUTA", "INPUTB"), factors, strict=True)), enables)
        if moved is not None:
            nets = [cells[name]["connections"][f"{side}{index}"][0] for side in "AB" for index in range(FACTOR_BITS)]
            before |= {drivers[net] for net in nets if net in drivers}
            cells[name] = moved
    reads = _reads(module, cells)
    for name in before:
        if not reads[cells[name]["connections"]["Q"][0]]:
            del cells[name]

    reads = _reads(module, cells)
    takers = {cell["connections"]["DI"][0]: name for name, cell in _flip_flops(cells).items()}
    for name in multipliers:
        moved = _with_registers(cells[name], {"OUTPUT": _product(cells, cells[name], takers, reads)}, enables)
        if moved is not None:
            nets = [bits[0] for pin, bits in cells[name]["connections"].items() if pin.startswith("P")]
            for flip_flop in {takers[net] for net in nets if net in takers}:
                del cells[flip_flop]
            cells[name] = moved
    return cells


def _flip_flops(cells: Mapping[str, Any]) -> dict[str, Any]:
    return {name: cell for name, cell in cells.items() if cell["type"] == "TRELLIS_FF"}


def _reads(module: Mapping[str, Any], cells: Mapping[str, Any]) -> Counter[int]:
    """Count the pins that read a net. The module's ports count, too."""
    reads: Counter[int] = Counter()
    for cell in cells.values():
        for pin, bits in cell["connections"].items():
            if cell["port_directions"][pin] != "output":
                reads.update(bit for bit in bits if isinstance(bit, int))
    for port in module["ports"].values():
        reads.update(bit for bit in port["bits"] if isinstance(bit, int))
    return reads


def _factor(
    cells: Mapping[str, Any], multiplier: Mapping[str, Any], side: str, drivers: Mapping[int, str]
) -> _Register | None:
    """Give the register that drives a factor; None if none does."""
    controls = set()
    pins: dict[str, int | str] = {}
    for pin in (f"{side}{index}" for index in range(FACTOR_BITS)):
        bit = multiplier["connections"][pin][0]
        if bit == "0":
            pins[pin] = bit
        elif bit in drivers:
            flip_flop = cells[drivers[bit]]
            controls.add(_control(flip_flop))
            pins[pin] = flip_flop["connections"]["DI"][0]
        else:  # Logic; or a 1, which is none before the first clock in a register.
            return None
    control = controls.pop() if len(controls) == 1 else None
    return None if control is None else _Register(control, pins)


def _product(
    cells: Mapping[str, Any], multiplier: Mapping[str, Any], takers: Mapping[int, str], reads: Mapping[int, int]
) -> _Register | None:
    """Give the register that takes a product; None if none does."""
    controls = set()
    pins: dict[str, int | str] = {}
    for pin in (f"P{index}" for index in range(PRODUCT_BITS)):
        bit = multiplier["connections"].get(pin, [None])[0]
        if bit is None or not reads[bit]:
            continue
        if reads[bit] > 1 or bit not in takers:
            return None
        flip_flop = cells[takers[bit]]
        controls.add(_control(flip_flop))
        pins[pin] = flip_flop["connections"]["Q"][0]
    control = controls.pop() if len(controls) == 1 else None
    return None if control is None else _Register(control, pins)


def _control(flip_flop: Mapping[str, Any]) -> _Control | None:
    """Give the control of a flip-flop; None if a multiplier's registers cannot work so."""
    settings = {name: str(value).strip() for name, value in flip_flop["parameters"].items()}
    pins = flip_flop["connections"]
    if settings.get("REGSET", "RESET") != "RESET" or settings.get("CLKMUX", "CLK") != "CLK":
        return None
    if pins.get("LSR", ["0"])[0] != "0" or settings.get("LSRMUX", "LSR") != "LSR":
        return None
    enable = {"1": "1", "CE": pins.get("CE", [None])[0]}.get(settings.get("CEMUX", "1"))
    return None if enable is None else _Control(pins["CLK"][0], enable)


def _with_registers(
    multiplier: Mapping[str, Any], registers: Mapping[str, _Register | None], enables: dict[int | str, str]
) -> dict[str, Any] | None:
    """Give a multiplier with registers inside; None if they cannot all be there. `enables` gains what they need."""
    inside = {name: register for name, register in registers.items() if register is not None}
    clocks = {register.control.clock for register in inside.values()}
    clocks |= set(multiplier["connections"].get("CLK0", []))
    wires = dict(enables)
    for register in inside.values():
        wires.setdefault(register.control.enable, f"CE{len(wires)}")
    if len(inside) < len(registers) or len(clocks) > 1 or len(wires) > ENABLE_WIRES:
        return None
    enables.update(wires)
    pins: dict[str, int | str] = {"CLK0": clocks.pop(), "RST0": "0"}
    settings: dict[str, str] = {}
    for name, register in inside.items():
        enable = register.control.enable
        pins |= {wires[enable]: enable, **register.pins}
        settings |= {f"REG_{name}_CLK": "CLK0", f"REG_{name}_CE": wires[enable], f"REG_{name}_RST": "RST0"}
    directions = {pin: "output" if pin.startswith("P") else "input" for pin in pins}
    return {
        **multiplier,
        "parameters": {**multiplier["parameters"], **settings},
        "port_directions": {**multiplier["port_directions"], **directions},
        "connections": {**multiplier["connections"], **{pin: [bit] for pin, bit in pins.items()}},
    }
