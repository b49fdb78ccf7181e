"""Pins of a placed netlist in both directions, with flip-flops, simulated by Icarus Verilog."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from voxrt.board.designs.simulation.placed_netlist import UnknownCellError, placed_verilog

LOW, HIGH, CLOCK, DATA, RELEASE, SEEN, PAD_DATA, PAD_RELEASE = range(2, 10)
BENCH = """module bench;
  reg clock = 0, data, release_, drive; wire seen; wire both;
  top t (.clock(clock), .data(data), .release_(release_), .seen(seen), .both(both));
  assign both = drive ? 1'b1 : 1'bz;
  initial begin
    {data, release_, drive} = 3'b000; #1 clock = 1; #1 clock = 0;
    #1 $write("%b", both);              // drives 0
    data = 1; #1 $write("%b", both);    // not before the clock
    clock = 1; #1 $write("%b%b", both, seen); clock = 0;
    release_ = 1; #1 clock = 1; #1 $write("%b", both); clock = 0;
    drive = 1; #1 $display("%b%b", both, seen);
  end
endmodule
"""


def netlist(enable=HIGH):
    def pad(number, direction, **connections):
        pins = {"B": [100 + number], **{pin: [net] for pin, net in connections.items()}}
        return {"type": "TRELLIS_IO", "parameters": {"DIR": direction}, "connections": pins}

    cells = {
        name: {"type": "TRELLIS_COMB", "parameters": {"INITVAL": value * 16}, "connections": {"F": [net]}}
        for name, value, net in (("low", "0", LOW), ("high", "1", HIGH))
    }
    cells |= {f"in{net}": pad(net, "INPUT", O=net) for net in (CLOCK, DATA, RELEASE)}
    cells["seen"] = pad(20, "OUTPUT", I=SEEN)
    cells["both"] = pad(21, "BIDIR", O=SEEN, IOLDO=PAD_DATA, IOLTO=PAD_RELEASE)
    cells["both"]["parameters"] |= {"DATAMUX_OREG": "IOLDO", "TRIMUX_TSREG": "IOLTO"}
    registers = {"CLK": CLOCK, "LSR": LOW, "CE": enable, "TXDATA0": DATA, "TSDATA0": RELEASE}
    registers |= {"IOLDO": PAD_DATA, "IOLTO": PAD_RELEASE}
    settings = {f"{name}.{key}": value for name in ("OUTREG", "TSREG") for key, value in _FLIP_FLOP.items()}
    cells["registers"] = {
        "type": "IOLOGIC",
        "parameters": {"MODE": "IREG_OREG", **settings},
        "connections": {pin: [net] for pin, net in registers.items()},
    }
    names = {"clock": CLOCK, "data": DATA, "release_": RELEASE, "seen": 20, "both": 21}
    directions = {"seen": "output", "both": "inout"}
    ports = {name: {"direction": directions.get(name, "input"), "bits": [100 + n]} for name, n in names.items()}
    return {"modules": {"top": {"ports": ports, "cells": cells}}}


_FLIP_FLOP = {"OUTREGMODE": "FF", "REGSET": "SET"}


@pytest.mark.skipif(shutil.which("iverilog") is None, reason="Icarus Verilog is not installed: apt install iverilog")
def test_a_pin_drives_or_is_driven(tmp_path):
    (tmp_path / "placed.v").write_text(placed_verilog(netlist()))
    (tmp_path / "bench.v").write_text(BENCH)
    subprocess.run(["iverilog", "-g2012", "-o", "bench", "placed.v", "bench.v"], cwd=tmp_path, check=True)
    finished = subprocess.run(["vvp", "bench"], cwd=tmp_path, check=True, capture_output=True, text=True)
    assert finished.stdout.split() == ["0011z11"]


def test_a_flip_flop_with_an_enable_is_refused():
    with pytest.raises(UnknownCellError, match="a register at a pin is neither"):
        placed_verilog(netlist(enable=DATA))
