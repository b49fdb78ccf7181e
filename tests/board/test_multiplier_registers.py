"""Flip-flops that move into a multiplier: Icarus Verilog sees the same products as before, at every clock."""

from __future__ import annotations

import copy
import shutil
import subprocess

import numpy as np
import pytest

from voxrt.board.designs.multiplier_registers import use_multiplier_registers
from voxrt.board.designs.simulation.placed_netlist import UnknownCellError, placed_verilog

BITS = 18
CLOCK, ENABLE, OTHER, LOW = 5, 6, 7, 8  # nets
DATA = {"A": 100, "B": 200}  # of inputs
FACTOR = {"A": 300, "B": 400}  # of flip-flops
PRODUCT = 500  # of the multiplier
OUTPUT = 600  # of the flip-flops behind it
PADS = 1000
needs_icarus = pytest.mark.skipif(
    shutil.which("iverilog") is None, reason="Icarus Verilog is not installed: apt install iverilog"
)


def flip_flop(data, output, enable=None, **settings):
    pins = {"CLK": [CLOCK], "DI": [data], "LSR": ["0"], "Q": [output]}
    parameters = {"CEMUX": "1 ", "CLKMUX": "CLK", "LSRMUX": "LSR", "REGSET": "RESET", "SD": "1"} | settings
    if enable is not None:
        pins["CE"] = [enable]
        parameters["CEMUX"] = "CE"
    directions = {pin: "output" if pin == "Q" else "input" for pin in pins}
    return {"type": "TRELLIS_FF", "parameters": parameters, "port_directions": directions, "connections": pins}


def design(enables):
    """Give the product of two registers; `enables` are theirs, nets or None; with "P", it has a register, too."""
    low = {"INITVAL": "0" * 16}
    cells = {
        "low": {"type": "TRELLIS_COMB", "parameters": low, "port_directions": {"F": "output"}}
        | {"connections": {"F": [LOW]}}
    }
    pins = {f"P{i}": [PRODUCT + i] for i in range(2 * BITS)}
    pins |= {"SIGNEDA": [LOW], "SIGNEDB": [LOW], "SOURCEA": [LOW], "SOURCEB": [LOW]}
    for side in "AB":
        for i in range(BITS):
            cells[f"{side}{i}_q"] = flip_flop(DATA[side] + i, FACTOR[side] + i, enables[side])
            pins[f"{side}{i}"] = [FACTOR[side] + i]
    if "P" in enables:
        cells |= {f"P{i}_q": flip_flop(PRODUCT + i, OUTPUT + i, enables["P"]) for i in range(2 * BITS)}
    directions = {pin: "output" if pin.startswith("P") else "input" for pin in pins}
    cells["product"] = {"type": "MULT18X18D", "parameters": {}, "port_directions": directions, "connections": pins}
    ports = {}
    for name, direction, first, bits in (
        ("clk", "input", CLOCK, 1),
        ("enable", "input", ENABLE, 1),
        ("other", "input", OTHER, 1),
        ("a", "input", DATA["A"], BITS),
        ("b", "input", DATA["B"], BITS),
        ("p", "output", OUTPUT if "P" in enables else PRODUCT, 2 * BITS),
    ):
        ports[name] = {"direction": direction, "bits": [PADS + first + i for i in range(bits)]}
        pin, way = ("O", "output") if direction == "input" else ("I", "input")
        for i in range(bits):
            cells[f"{name}{i}"] = {
                "type": "TRELLIS_IO",
                "parameters": {"DIR": direction.upper()},
                "port_directions": {pin: way, "B": direction},
                "connections": {pin: [first + i], "B": [PADS + first + i]},
            }
    return {"modules": {"top": {"ports": ports, "cells": cells}}}


def flip_flops(netlist):
    return [name for name, cell in netlist["modules"]["top"]["cells"].items() if cell["type"] == "TRELLIS_FF"]


def cells_of(netlist, kind):
    return [cell for cell in netlist["modules"]["top"]["cells"].values() if cell["type"] == kind]


def products(netlist, folder):
    """Give the products of 200 clocks of the same random inputs."""
    random = np.random.default_rng(6)
    steps = "\n".join(
        f'a = {a}; b = {b}; enable = {enable}; other = {other}; #1 clk = 1; #1 clk = 0; #1 $display("%d", p);'
        for a, b, enable, other in zip(
            *random.integers(0, 1 << BITS, (2, 200)).tolist(), *random.integers(0, 2, (2, 200)).tolist(), strict=True
        )
    )
    (folder / "design.v").write_text(placed_verilog(netlist))
    (folder / "bench.v").write_text(
        "module bench; reg [17:0] a, b; reg clk = 0, enable, other; wire [35:0] p;\n"
        "top t (.clk(clk), .enable(enable), .other(other), .a(a), .b(b), .p(p));\n"
        f"initial begin\n{steps}\nend endmodule\n"
    )
    program = folder / "bench"
    subprocess.run(["iverilog", "-g2012", "-o", program, folder / "bench.v", folder / "design.v"], check=True)
    return subprocess.run(["vvp", program], check=True, capture_output=True, text=True).stdout.split()


@needs_icarus
@pytest.mark.parametrize(
    "enables",
    [
        {"A": None, "B": None},
        {"A": ENABLE, "B": ENABLE},
        {"A": ENABLE, "B": None},
        {"A": ENABLE, "B": OTHER},
        {"A": None, "B": None, "P": None},
        {"A": ENABLE, "B": OTHER, "P": ENABLE},
    ],
)
def test_products_are_those_of_the_flip_flops(tmp_path, enables):
    before = design(enables)
    kept = copy.deepcopy(before)
    after = use_multiplier_registers(before)
    assert before == kept
    assert not flip_flops(after)
    found = products(after, tmp_path)
    assert found == products(before, tmp_path)
    assert len(set(found)) > 20


def test_a_flip_flop_that_feeds_something_else_stays():
    netlist = design({"A": None, "B": None})
    cells = netlist["modules"]["top"]["cells"]
    cells["reader"] = flip_flop(FACTOR["A"] + 3, 900)
    left = use_multiplier_registers(netlist)
    assert flip_flops(left) == ["A3_q", "reader"]
    assert cells_of(left, "MULT18X18D")[0]["connections"]["A3"] == [DATA["A"] + 3]


@needs_icarus
def test_a_product_moves_where_factors_cannot(tmp_path):
    netlist = design({"A": None, "B": None, "P": OTHER})
    with_logic(netlist["modules"]["top"]["cells"])
    after = use_multiplier_registers(netlist)
    assert {name[0] for name in flip_flops(after)} == {"A", "B"}
    assert products(after, tmp_path) == products(netlist, tmp_path)


def test_a_product_that_something_else_reads_stays():
    netlist = design({"A": None, "B": None, "P": None})
    netlist["modules"]["top"]["cells"]["reader"] = flip_flop(PRODUCT + 9, 900)
    after = use_multiplier_registers(netlist)
    assert len(flip_flops(after)) == 2 * BITS + 1


def test_a_bit_of_a_product_that_nothing_reads_needs_no_flip_flop():
    netlist = design({"A": None, "B": None, "P": None})
    cells = netlist["modules"]["top"]["cells"]
    for i in range(30, 2 * BITS):
        del cells[f"P{i}_q"], cells[f"p{i}"]
    after = use_multiplier_registers(netlist)
    assert not flip_flops(after)


def with_logic(cells):
    cells["product"]["connections"]["A4"] = [DATA["A"] + 4]


def with_a_constant_one(cells):
    cells["product"]["connections"]["B17"] = ["1"]


def with_a_second_enable(cells):
    cells["A7_q"] = flip_flop(DATA["A"] + 7, FACTOR["A"] + 7, ENABLE)


def with_a_reset(cells):
    cells["B0_q"]["connections"]["LSR"] = [OTHER]


def with_a_first_value(cells):
    cells["B0_q"]["parameters"]["REGSET"] = "SET"


def with_the_other_edge(cells):
    cells["B0_q"]["parameters"]["CLKMUX"] = "INV"


def with_an_inverted_enable(cells):
    cells["A7_q"] = flip_flop(DATA["A"] + 7, FACTOR["A"] + 7, ENABLE, CEMUX="INV")


def with_two_clocks(cells):
    for i in range(BITS):
        cells[f"B{i}_q"]["connections"]["CLK"] = [OTHER]


@pytest.mark.parametrize(
    "change",
    [
        with_logic,
        with_a_constant_one,
        with_a_second_enable,
        with_a_reset,
        with_a_first_value,
        with_the_other_edge,
        with_an_inverted_enable,
        with_two_clocks,
    ],
    ids=lambda change: change.__name__,
)
def test_a_multiplier_whose_registers_cannot_do_it_stays_as_it_is(change):
    netlist = design({"A": None, "B": None})
    change(netlist["modules"]["top"]["cells"])
    assert use_multiplier_registers(netlist) == netlist


@needs_icarus
def test_a_constant_zero_needs_no_flip_flop(tmp_path):
    netlist = design({"A": None, "B": ENABLE})
    for i in range(12, BITS):
        netlist["modules"]["top"]["cells"]["product"]["connections"][f"B{i}"] = ["0"]
    after = use_multiplier_registers(netlist)
    assert cells_of(after, "MULT18X18D")[0]["parameters"]["REG_INPUTB_CLK"] == "CLK0"
    assert products(after, tmp_path) == products(netlist, tmp_path)


def test_one_enable_has_one_wire_everywhere_and_a_fifth_has_none():
    netlist = {"modules": {"top": {"ports": {}, "cells": {}}}}
    cells = netlist["modules"]["top"]["cells"]
    for number in range(6):
        one = design({"A": None, "B": 10 + number})["modules"]["top"]["cells"]
        for name, cell in one.items():
            if cell["type"] in {"TRELLIS_FF", "MULT18X18D"}:
                moved = {
                    pin: [bit + 10_000 * number] for pin, (bit,) in cell["connections"].items() if pin[0] in "ABPQ"
                }
                cells[f"{number}.{name}"] = cell | {"connections": cell["connections"] | moved}
    wires = {}
    for name, cell in use_multiplier_registers(netlist)["modules"]["top"]["cells"].items():
        if cell["type"] == "MULT18X18D":
            found = {pin: bits[0] for pin, bits in cell["connections"].items() if pin.startswith("CE")}
            for pin, net in found.items():
                assert wires.setdefault(pin, net) == net
            assert bool(found) == (int(name[0]) < 3)
    assert wires == {"CE0": "1", "CE1": 10, "CE2": 11, "CE3": 12}


def test_registers_that_the_simulation_does_not_know_are_refused():
    netlist = use_multiplier_registers(design({"A": None, "B": None}))
    product = netlist["modules"]["top"]["cells"]["product"]
    product["parameters"]["REG_PIPELINE_CLK"] = "CLK0"
    with pytest.raises(UnknownCellError, match="REG_PIPELINE"):
        placed_verilog(netlist)
    del product["parameters"]["REG_PIPELINE_CLK"]
    product["connections"]["RST0"] = [OTHER]
    with pytest.raises(UnknownCellError, match="INPUTA has a reset"):
        placed_verilog(netlist)
