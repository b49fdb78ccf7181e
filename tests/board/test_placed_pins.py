"""Pins of a placed netlist in both directions, with flip-flops, simulated by Icarus Verilog."""

from __future__ import annotations

import pytest
from fakes.placed_cells import constant, netlist
from oracles.icarus import needs_icarus, printed_by

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


def pins(enable=HIGH):
    def pad(number, direction, **connections):
        nets = {"B": [100 + number], **{pin: [net] for pin, net in connections.items()}}
        return {"type": "TRELLIS_IO", "parameters": {"DIR": direction}, "connections": nets}

    cells = {"low": constant(LOW, 0), "high": constant(HIGH, 1)}
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
    return netlist(ports, cells)


_FLIP_FLOP = {"OUTREGMODE": "FF", "REGSET": "SET"}


@needs_icarus
def test_a_pin_drives_or_is_driven(tmp_path):
    assert printed_by(tmp_path, BENCH, placed_verilog(pins())) == ["0011z11"]


def test_a_flip_flop_with_an_enable_is_refused():
    with pytest.raises(UnknownCellError, match="a register at a pin is neither"):
        placed_verilog(pins(enable=DATA))
