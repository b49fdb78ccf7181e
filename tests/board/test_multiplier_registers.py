"""Flip-flops that move into a multiplier: Icarus Verilog sees the same products as before, at every clock."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from fakes.placed_cells import constant, netlist, pads
from oracles.icarus import needs_icarus, printed_by

from voxrt.board.designs.multiplier_registers import use_multiplier_registers
from voxrt.board.designs.simulation.placed_netlist import UnknownCellError, placed_verilog

BITS = 18
CLOCK, ENABLE, OTHER, LOW = 5, 6, 7, 8  # nets
DATA = {"A": 100, "B": 200}  # of inputs
FACTOR = {"A": 300, "B": 400}  # of flip-flops
PRODUCT = 500  # of the multiplier
OUTPUT = 600  # of the flip-flops behind it


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
    cells = {"low": constant(LOW, 0)}
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
    ports, at_pins = pads(
        ("clk", "input", CLOCK, 1),
        ("enable", "input", ENABLE, 1),
        ("other", "input", OTHER, 1),
        ("a", "input", DATA["A"], BITS),
        ("b", "input", DATA["B"], BITS),
        ("p", "output", OUTPUT if "P" in enables else PRODUCT, 2 * BITS),
    )
    return netlist(ports, cells | at_pins)


def flip_flops(made):
    return [name for name, cell in made["modules"]["top"]["cells"].items() if cell["type"] == "TRELLIS_FF"]


def cells_of(made, kind):
    return [cell for cell in made["modules"]["top"]["cells"].values() if cell["type"] == kind]


def products(made, folder):
    """Give the products of 200 clocks of the same random inputs."""
    random = np.random.default_rng(6)
    steps = "\n".join(
        f'a = {a}; b = {b}; enable = {enable}; other = {other}; #1 clk = 1; #1 clk = 0; #1 $display("%d", p);'
        for a, b, enable, other in zip(
            *random.integers(0, 1 << BITS, (2, 200)).tolist(), *random.integers(0, 2, (2, 200)).tolist(), strict=True
        )
    )
    bench = (
        "module bench; reg [17:0] a, b; reg clk = 0, enable, other; wire [35:0] p;\n"
        "top t (.clk(clk), .enable(enable), .other(other), .a(a), .b(b), .p(p));\n"
        f"initial begin\n{steps}\nend endmodule\n"
    )
    return printed_by(folder, bench, placed_verilog(made))


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
    made = design({"A": None, "B": None})
    cells = made["modules"]["top"]["cells"]
    cells["reader"] = flip_flop(FACTOR["A"] + 3, 900)
    left = use_multiplier_registers(made)
    assert flip_flops(left) == ["A3_q", "reader"]
    assert cells_of(left, "MULT18X18D")[0]["connections"]["A3"] == [DATA["A"] + 3]


@needs_icarus
def test_a_product_moves_where_factors_cannot(tmp_path):
    made = design({"A": None, "B": None, "P": OTHER})
    change(made, LOGIC)
    after = use_multiplier_registers(made)
    assert {name[0] for name in flip_flops(after)} == {"A", "B"}
    assert products(after, tmp_path) == products(made, tmp_path)


def test_a_product_that_something_else_reads_stays():
    made = design({"A": None, "B": None, "P": None})
    made["modules"]["top"]["cells"]["reader"] = flip_flop(PRODUCT + 9, 900)
    after = use_multiplier_registers(made)
    assert len(flip_flops(after)) == 2 * BITS + 1


def test_a_bit_of_a_product_that_nothing_reads_needs_no_flip_flop():
    made = design({"A": None, "B": None, "P": None})
    cells = made["modules"]["top"]["cells"]
    for i in range(30, 2 * BITS):
        del cells[f"P{i}_q"], cells[f"p{i}"]
    after = use_multiplier_registers(made)
    assert not flip_flops(after)


LOGIC = {"product": {"connections": {"A4": [DATA["A"] + 4]}}}
CHANGES = {
    "logic": LOGIC,
    "a constant one": {"product": {"connections": {"B17": ["1"]}}},
    "a second enable": {"A7_q": flip_flop(DATA["A"] + 7, FACTOR["A"] + 7, ENABLE)},
    "a reset": {"B0_q": {"connections": {"LSR": [OTHER]}}},
    "a first value": {"B0_q": {"parameters": {"REGSET": "SET"}}},
    "the other edge": {"B0_q": {"parameters": {"CLKMUX": "INV"}}},
    "an inverted enable": {"A7_q": flip_flop(DATA["A"] + 7, FACTOR["A"] + 7, ENABLE, CEMUX="INV")},
    "two clocks": {f"B{i}_q": {"connections": {"CLK": [OTHER]}} for i in range(BITS)},
}


def change(made, changes):
    cells = made["modules"]["top"]["cells"]
    for name, parts in changes.items():
        for part in ("connections", "parameters", "port_directions"):
            cells[name][part] |= parts.get(part, {})


@pytest.mark.parametrize("changes", CHANGES.values(), ids=CHANGES)
def test_a_multiplier_whose_registers_cannot_do_it_stays_as_it_is(changes):
    made = design({"A": None, "B": None})
    change(made, changes)
    assert use_multiplier_registers(made) == made


@needs_icarus
def test_a_constant_zero_needs_no_flip_flop(tmp_path):
    made = design({"A": None, "B": ENABLE})
    for i in range(12, BITS):
        made["modules"]["top"]["cells"]["product"]["connections"][f"B{i}"] = ["0"]
    after = use_multiplier_registers(made)
    assert cells_of(after, "MULT18X18D")[0]["parameters"]["REG_INPUTB_CLK"] == "CLK0"
    assert products(after, tmp_path) == products(made, tmp_path)


def test_one_enable_has_one_wire_everywhere_and_a_fifth_has_none():
    made = netlist({}, {})
    cells = made["modules"]["top"]["cells"]
    for number in range(6):
        one = design({"A": None, "B": 10 + number})["modules"]["top"]["cells"]
        for name, cell in one.items():
            if cell["type"] in {"TRELLIS_FF", "MULT18X18D"}:
                moved = {
                    pin: [bit + 10_000 * number] for pin, (bit,) in cell["connections"].items() if pin[0] in "ABPQ"
                }
                cells[f"{number}.{name}"] = cell | {"connections": cell["connections"] | moved}
    wires = {}
    for name, cell in use_multiplier_registers(made)["modules"]["top"]["cells"].items():
        if cell["type"] == "MULT18X18D":
            found = {pin: bits[0] for pin, bits in cell["connections"].items() if pin.startswith("CE")}
            for pin, net in found.items():
                assert wires.setdefault(pin, net) == net
            assert bool(found) == (int(name[0]) < 3)
    assert wires == {"CE0": "1", "CE1": 10, "CE2": 11, "CE3": 12}


def test_registers_that_the_simulation_does_not_know_are_refused():
    made = use_multiplier_registers(design({"A": None, "B": None}))
    product = made["modules"]["top"]["cells"]["product"]
    product["parameters"]["REG_PIPELINE_CLK"] = "CLK0"
    with pytest.raises(UnknownCellError, match="REG_PIPELINE"):
        placed_verilog(made)
    del product["parameters"]["REG_PIPELINE_CLK"]
    product["connections"]["RST0"] = [OTHER]
    with pytest.raises(UnknownCellError, match="INPUTA has a reset"):
        placed_verilog(made)
