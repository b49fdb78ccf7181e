"""A multiplier of a placed netlist, simulated by Icarus Verilog, against the product of whole numbers."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest

from voxrt.board.designs.simulation.placed_netlist import UnknownCellError, placed_verilog

BITS = 18
A, B, P, LOW, HIGH = 10, 30, 50, 2, 3  # numbers of the first nets
CONSTANTS = {
    name: {"type": "TRELLIS_COMB", "parameters": {"INITVAL": value * 16}, "connections": {"F": [net]}}
    for name, value, net in (("low", "0", LOW), ("high", "1", HIGH))
}


def netlist(signed_a, signed_b):
    pins = {f"{pin}{i}": [first + i] for pin, first in (("A", A), ("B", B)) for i in range(BITS)}
    pins |= {f"P{i}": [P + i] for i in range(2 * BITS)}
    pins |= {"SIGNEDA": [signed_a], "SIGNEDB": [signed_b], "SOURCEA": [LOW], "SOURCEB": [LOW]}
    cells = {**CONSTANTS, "product": {"type": "MULT18X18D", "parameters": {}, "connections": pins}}
    ports = {}
    for name, direction, first, bits in (
        ("a", "input", A, BITS),
        ("b", "input", B, BITS),
        ("p", "output", P, 2 * BITS),
    ):
        ports[name] = {"direction": direction, "bits": list(range(100 + first, 100 + first + bits))}
        for i in range(bits):
            pad, inside = {"B": [100 + first + i]}, first + i
            kind = {"parameters": {"DIR": direction.upper()}, "type": "TRELLIS_IO"}
            cells[f"{name}{i}"] = kind | {"connections": {**pad, "O" if direction == "input" else "I": [inside]}}
    return {"modules": {"top": {"ports": ports, "cells": cells}}}


def number(value, signed):
    return int(value) - (1 << BITS if signed and value >> (BITS - 1) else 0)


@pytest.mark.skipif(shutil.which("iverilog") is None, reason="Icarus Verilog is not installed: apt install iverilog")
@pytest.mark.parametrize("signed_a", [False, True])
@pytest.mark.parametrize("signed_b", [False, True])
def test_a_factor_has_a_sign_where_its_pin_says_so(tmp_path, signed_a, signed_b):
    random = np.random.default_rng(5)
    pairs = [
        (0, 0),
        (1 << 17, 1 << 17),
        ((1 << 18) - 1, (1 << 18) - 1),
        *random.integers(0, 1 << BITS, (100, 2)).tolist(),
    ]
    (tmp_path / "placed.v").write_text(placed_verilog(netlist(*(HIGH if one else LOW for one in (signed_a, signed_b)))))
    steps = "\n".join(f'a = {a}; b = {b}; #1 $display("%d", p);' for a, b in pairs)
    (tmp_path / "bench.v").write_text(
        "module bench; reg [17:0] a, b; wire [35:0] p; top t (.a(a), .b(b), .p(p));\n"
        f"initial begin\n{steps}\nend endmodule\n"
    )
    program = tmp_path / "bench"
    subprocess.run(["iverilog", "-g2012", "-o", program, tmp_path / "bench.v", tmp_path / "placed.v"], check=True)
    printed = subprocess.run(["vvp", program], check=True, capture_output=True, text=True).stdout.split()
    expected = [number(a, signed_a) * number(b, signed_b) % (1 << 2 * BITS) for a, b in pairs]
    assert [int(word) for word in printed] == expected


def test_a_sign_that_changes_is_refused():
    with pytest.raises(UnknownCellError, match="SIGNEDB"):
        placed_verilog(netlist(LOW, A))
