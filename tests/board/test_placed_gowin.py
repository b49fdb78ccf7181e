"""Cells of a placed netlist of a Gowin GW2A, simulated by Icarus Verilog, against whole numbers."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.placed_cells import netlist
from oracles.icarus import needs_icarus, printed_by

from voxrt.board.designs.simulation.placed_gowin import MODELS, placed_verilog
from voxrt.board.designs.simulation.placed_netlist import UnknownCellError

A, B, ADDS, SUM, CARRY, LOW, HIGH, CLOCK, WRITE = 10, 20, 30, 40, 50, 2, 3, 4, 5  # numbers of the first nets
BITS = 4


def cell(kind, connections, **parameters):
    pins = {pin: net if isinstance(net, list) else [net] for pin, net in connections.items()}
    return {"type": kind, "parameters": parameters, "connections": pins, "port_directions": {}, "attributes": {}}


def constants():
    return {"high": cell("GOWIN_VCC", {"V": HIGH}), "low": cell("GOWIN_GND", {"G": LOW})}


def port(direction, first, bits):
    return {"direction": direction, "bits": list(range(first, first + bits))}


def chain(head):
    """Add or subtract four bits: a head, a cell per bit, and a cell whose sum is the carry, as nextpnr makes them."""
    cells = constants() | {"head": head}
    for bit in range(BITS):
        pins = {"I0": A + bit, "I1": B + bit, "I2": HIGH, "I3": ADDS, "CIN": CARRY + bit}
        pins |= {"SUM": SUM + bit, "COUT": CARRY + bit + 1}
        cells[f"bit{bit}"] = cell("ALU", pins, ALU_MODE=f"{2:032b}")
    tail = {"CIN": CARRY + BITS, "I2": HIGH, "SUM": SUM + BITS}
    cells["tail"] = cell("ALU", tail, ALU_MODE="C2L")
    ports = {"a": port("input", A, BITS), "b": port("input", B, BITS), "adds": port("input", ADDS, 1)}
    return netlist(ports | {"sum": port("output", SUM, BITS + 1)}, cells)


HEADS = {
    0: cell("ALU", {"COUT": CARRY, "I2": HIGH}, ALU_MODE="C2L"),
    1: cell("ALU", {"COUT": CARRY, "I2": HIGH}, ALU_MODE="ONE2C"),
    "adds": cell("ALU", {"COUT": CARRY, "I0": ADDS, "I2": HIGH}, RAW_ALU_LUT=f"{0x505A:032b}"),
}


@needs_icarus
@pytest.mark.parametrize("head", HEADS)
def test_chains_add_and_subtract(tmp_path, head):
    bench = """module bench; reg [3:0] a, b; reg adds; wire [4:0] sum; integer i;
      top t (.a(a), .b(b), .adds(adds), .sum(sum));
      initial for (i = 0; i < 512; i = i + 1) begin {adds, a, b} = i; #1 $display("%d", sum); end
    endmodule
    """
    wanted = []
    for adds in (0, 1):
        carry = adds if head == "adds" else head
        wanted += [a + (b if adds else 15 - b) + carry for a in range(16) for b in range(16)]
    assert [int(word) for word in printed_by(tmp_path, bench, placed_verilog(chain(HEADS[head])))] == wanted


@needs_icarus
def test_a_memory_in_logic_is_written_at_the_clock_and_read_at_once(tmp_path):
    random = np.random.default_rng(2)
    steps = [(*random.integers(0, 16, 3).tolist(), int(random.integers(0, 2))) for _ in range(200)]
    pins = {"WAD": [A, A + 1, A + 2, A + 3], "DI": [B, B + 1, B + 2, B + 3], "RAD": [30, 31, 32, 33]}
    pins |= {"DO": [40, 41, 42, 43], "CLK": CLOCK, "WRE": WRITE}
    ports = {
        "w": port("input", A, 4),
        "d": port("input", B, 4),
        "r": port("input", 30, 4),
        "clk": port("input", CLOCK, 1),
    }
    ports |= {"e": port("input", WRITE, 1), "q": port("output", 40, 4)}
    lines = [f"w = {n}; d = 0; e = 1; #1 clk = 1; #1 clk = 0;" for n in range(16)]
    wanted, memory = [], [0] * 16
    for write, data, read, enable in steps:
        lines.append(
            f'w = {write}; d = {data}; r = {read}; e = {enable}; #1 clk = 1; #1 clk = 0; #1 $display("%d", q);'
        )
        if enable:
            memory[write] = data
        wanted.append(memory[read])
    top = "top t (.w(w), .d(d), .r(r), .clk(clk), .e(e), .q(q));"
    bench = f"module bench; reg [3:0] w, d, r; reg clk = 0, e; wire [3:0] q; {top} initial begin\n"
    placed = placed_verilog(netlist(ports, {"ram": cell("RAM16SDP4", pins)}))
    assert [
        int(word) for word in printed_by(tmp_path, bench + "\n".join(lines) + "\nend endmodule\n", placed)
    ] == wanted


@needs_icarus
def test_a_block_ram_of_two_rows_keeps_whole_words(tmp_path):
    """Port B has the upper row of a single port, with write enables of its own."""
    rng = np.random.default_rng(3)
    words = [int(word) for word in rng.integers(0, 1 << 36, 20)]
    places = [int(place) for place in rng.permutation(512)[:20]]
    pins = {"CLK": CLOCK, "CE": HIGH, "WRE": WRITE, "CLKB": CLOCK, "CEB": HIGH, "WREB": WRITE, "ADB4": HIGH, "AD4": LOW}
    for letter in ("AD", "ADB"):
        pins |= {f"{letter}{bit}": WRITE if bit < 2 else LOW for bit in range(4)}
        pins |= {f"{letter}{bit}": 95 + bit for bit in range(5, 14)}
    pins |= {f"DI{bit}": 200 + bit for bit in range(36)} | {f"DO{bit}": 300 + bit for bit in range(36)}
    ports = {"a": port("input", 100, 9), "d": port("input", 200, 36), "q": port("output", 300, 36)}
    ports |= {"clk": port("input", CLOCK, 1), "e": port("input", WRITE, 1)}
    placed = placed_verilog(
        netlist(ports, constants() | {"ram": cell("SP", pins, BIT_WIDTH=f"{36:032b}", WRITE_MODE=f"{2:032b}")})
    )
    lines = [
        f"a = {place}; d = {word}; e = 1; #1 clk = 1; #1 clk = 0;" for place, word in zip(places, words, strict=True)
    ]
    lines += [f'a = {place}; e = 0; #1 clk = 1; #1 clk = 0; #1 $display("%d", q);' for place in places]
    top = "top t (.a(a), .d(d), .clk(clk), .e(e), .q(q));"
    bench = f"module bench; reg [8:0] a; reg [35:0] d; reg clk = 0, e; wire [35:0] q; {top} initial begin\n"
    models = MODELS[1].read_text()
    found = printed_by(tmp_path, bench + "\n".join(lines) + "\nend endmodule\n", placed + models)
    assert [int(word) for word in found] == words
    pins["ADB9"] = LOW
    with pytest.raises(UnknownCellError, match="two rows at two addresses is not known"):
        placed_verilog(netlist(ports, constants() | {"ram": cell("SP", pins, BIT_WIDTH=f"{36:032b}")}))


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (cell("ALU", {}, ALU_MODE="9"), "other: an ALU of mode 9 is not known"),
        (cell("OSC", {}), "other: cells of type OSC are not known"),
        (cell("MULT18X18", {}, AREG="1"), "other: a multiplier with registers is not known"),
        (cell("SP", {}, READ_MODE="1"), "other: a block RAM with output registers is not known"),
        (cell("SP", {"RESET": WRITE}), "other: a block RAM whose pin RESET is used is not known"),
    ],
)
def test_what_is_not_known_is_refused(other, message):
    with pytest.raises(UnknownCellError, match=f"^{message}$"):
        placed_verilog(netlist({}, constants() | {"other": other}))
