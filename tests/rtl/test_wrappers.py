"""The core in Amaranth and cocotb: a minimal design of each draws the first frame, by Icarus Verilog."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from oracles.first_frame import BOOT, SIZE, expected_frame, read_writes
from oracles.icarus import flatten, need, needs_icarus, simulate

from voxrt.rtl.wrappers.verilog_file import VerilogFileError, memory_bytes, read_clocks, read_parameters

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

pytestmark = [
    pytest.mark.filterwarnings("ignore")  # what the frameworks warn of is theirs
]


def test_the_file_says_what_it_is(verilog, tmp_path):
    parameters = read_parameters(verilog)
    assert (parameters["Lanes"], parameters["MaxDepth"], parameters["BlockBits"]) == (1, 16, 12)
    assert (read_clocks(parameters), memory_bytes(parameters)) == (3, 1 << 18)
    other = tmp_path / "other.v"
    other.write_text("module other; endmodule\n")
    with pytest.raises(VerilogFileError, match=r"other\.v: is no core; write one: voxrt core --config tiny --verilog"):
        read_parameters(other)
    other.write_text(verilog.read_text().replace("MemoryForm 0", "MemoryForm 2"))
    with pytest.raises(VerilogFileError, match="external memory"):
        read_parameters(other)


AMARANTH_BENCH = """
module bench;
  reg clk = 0, rst = 1;
  wire valid;
  wire [31:0] word;
  integer words = 0, clocks = 0;
  top dut (.clk(clk), .rst(rst), .video__ready(1'b1), .video__valid(valid), .\\video__payload (word));
  always #5 clk = !clk;
  always @(negedge clk) begin
    clocks = clocks + 1;
    if (clocks == 16) rst = 0;
    if (clocks == 100000) $finish;
    if (valid === 1'b1) begin
      $display("%h", word);
      words = words + 1;
      if (words == WORDS) $finish;
    end
  end
endmodule
"""


def amaranth_player(verilog: Path):
    """The core, and a table of writes that is played after reset."""
    from amaranth.hdl import Module, Signal
    from amaranth.lib import memory, wiring
    from amaranth.lib.wiring import Out

    from voxrt.rtl.wrappers.amaranth_component import VIDEO, VoxrtCore

    rows = [address << 32 | data for address, data in read_writes()]

    class Player(wiring.Component):
        def __init__(self):
            super().__init__({"video": Out(VIDEO)})

        def elaborate(self, _platform):
            m = Module()
            m.submodules.core = core = VoxrtCore(verilog)
            m.submodules.table = table = memory.Memory(shape=64, depth=len(rows), init=rows)
            read = table.read_port(domain="comb")
            place, address_taken, data_taken = Signal(range(len(rows) + 1)), Signal(), Signal()
            row, bus = read.data, core.registers
            wiring.connect(m, core.video, wiring.flipped(self.video))
            m.d.comb += [read.addr.eq(place), core.memory.we.eq(0xF), core.memory.wrdata.eq(row[:32])]
            m.d.comb += [core.memory.addr.eq(row[32:55]), bus.awaddr.eq(row[32:43]), bus.wdata.eq(row[:32])]
            m.d.comb += [bus.wstrb.eq(0xF), bus.bready.eq(1), bus.rready.eq(1)]
            with m.FSM():
                with m.State("NEXT"), m.If(place != len(rows)):
                    m.d.sync += [address_taken.eq(0), data_taken.eq(0)]
                    with m.If(row[55]):
                        m.d.comb += core.memory.en.eq(1)
                        m.d.sync += place.eq(place + 1)
                    with m.Else():
                        m.next = "WRITE"
                with m.State("WRITE"):
                    m.d.comb += [bus.awvalid.eq(~address_taken), bus.wvalid.eq(~data_taken)]
                    m.d.sync += [address_taken.eq(address_taken | bus.awready), data_taken.eq(data_taken | bus.wready)]
                    with m.If((address_taken | bus.awready) & (data_taken | bus.wready)):
                        m.next = "ANSWER"
                with m.State("ANSWER"), m.If(bus.bvalid):
                    m.d.sync += place.eq(place + 1)
                    m.next = "NEXT"
            return m

    return Player()


@needs_icarus
def test_amaranth(verilog, tmp_path):
    need("amaranth")
    from amaranth.back import rtlil

    (tmp_path / "top.il").write_text(rtlil.convert(amaranth_player(verilog), emit_src=False))
    flatten(tmp_path, "read_rtlil top.il")
    a_line = -(-3 * SIZE[0] // 4)
    bench = AMARANTH_BENCH.replace("WORDS", str(a_line * SIZE[1]))
    lines = simulate(tmp_path, bench, tmp_path / "top.v", verilog)
    assert len(lines) == a_line * SIZE[1]
    stream = b"".join(bytes.fromhex(line)[::-1] for line in lines)
    picture = np.frombuffer(stream, np.uint8).reshape(SIZE[1], SIZE[0], 3)[..., [2, 0, 1]]
    np.testing.assert_array_equal(picture, expected_frame())


@needs_icarus
def test_cocotb(verilog, tmp_path):
    need("cocotb")
    finished = subprocess.run(
        [sys.executable, EXAMPLES / "cocotb_core.py", verilog, BOOT],
        cwd=tmp_path,
        env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stdout + finished.stderr
    np.testing.assert_array_equal(np.load(tmp_path / "frame.npy"), expected_frame())
