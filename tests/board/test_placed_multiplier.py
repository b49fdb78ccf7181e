"""A multiplier of a placed netlist, simulated by Icarus Verilog, against the product of whole numbers."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.placed_cells import constant, netlist, pads
from oracles.icarus import needs_icarus, printed_by

from voxrt.board.designs.simulation.placed_netlist import UnknownCellError, placed_verilog

BITS = 18
A, B, P, LOW, HIGH = 10, 30, 50, 2, 3  # numbers of the first nets


def multiplier(signed_a, signed_b):
    pins = {f"{pin}{i}": [first + i] for pin, first in (("A", A), ("B", B)) for i in range(BITS)}
    pins |= {f"P{i}": [P + i] for i in range(2 * BITS)}
    pins |= {"SIGNEDA": [signed_a], "SIGNEDB": [signed_b], "SOURCEA": [LOW], "SOURCEB": [LOW]}
    ports, cells = pads(("a", "input", A, BITS), ("b", "input", B, BITS), ("p", "output", P, 2 * BITS))
    cells |= {"low": constant(LOW, 0), "high": constant(HIGH, 1)}
    cells["product"] = {"type": "MULT18X18D", "parameters": {}, "connections": pins}
    return netlist(ports, cells)


def number(value, signed):
    return int(value) - (1 << BITS if signed and value >> (BITS - 1) else 0)


@needs_icarus
@pytest.mark.parametrize("signed_a", [False, True])
@pytest.mark.parametrize("signed_b", [False, True])
def test_a_factor_has_a_sign_where_its_pin_says_so(tmp_path, signed_a, signed_b):
    random = np.random.default_rng(5)
    pairs = [(limit, limit) for limit in (0, 1 << 17, (1 << 18) - 1)]
    pairs += random.integers(0, 1 << BITS, (100, 2)).tolist()
    steps = "\n".join(f'a = {a}; b = {b}; #1 $display("%d", p);' for a, b in pairs)
    bench = (
        "module bench; reg [17:0] a, b; wire [35:0] p; top t (.a(a), .b(b), .p(p));\n"
        f"initial begin\n{steps}\nend endmodule\n"
    )
    placed = placed_verilog(multiplier(*(HIGH if one else LOW for one in (signed_a, signed_b))))
    expected = [number(a, signed_a) * number(b, signed_b) % (1 << 2 * BITS) for a, b in pairs]
    assert [int(word) for word in printed_by(tmp_path, bench, placed)] == expected


def test_a_sign_that_changes_is_refused():
    with pytest.raises(UnknownCellError, match="SIGNEDB"):
        placed_verilog(multiplier(LOW, A))
