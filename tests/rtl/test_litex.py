"""The core in LiteX: a minimal design draws the first frame, by Icarus Verilog; the example for ULX3S elaborates."""

from __future__ import annotations

import runpy
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from oracles.first_frame import SIZE, expected_frame, read_writes
from oracles.icarus import flatten, need, needs_icarus, run_yosys, simulate

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

pytestmark = [
    pytest.mark.filterwarnings("ignore")  # what LiteX warns of is its own
]

LITEX_BENCH = """
module bench;
  reg clk = 0, rst = 1, cyc = 0, we = 1;
  reg [29:0] adr = 0;
  reg [31:0] dat_w = 0;
  wire ack, pixel_valid;
  wire [23:0] pixel_rgb;
  wire [31:0] dat_r;
  reg [63:0] writes [0:COUNT-1];
  integer n, pixels = 0, reads = 0, clocks = 0;
  top dut (.clk(clk), .rst(rst), .host_adr(adr), .host_dat_w(dat_w), .host_sel(4'hF), .host_cyc(cyc), .host_stb(cyc),
    .host_we(we), .host_dat_r(dat_r), .host_cti(3'b0), .host_bte(2'b0), .host_ack(ack),
    .pixel_valid(pixel_valid), .pixel_rgb(pixel_rgb));
  always #5 clk = !clk;
  always @(negedge clk) begin
    clocks = clocks + 1;
    if (clocks == 100000) $finish;
    if (pixel_valid === 1'b1) begin
      $display("%h", pixel_rgb);
      pixels = pixels + 1;
    end
    if (pixels == PIXELS && reads == 3) $finish;
  end
  initial begin
    $readmemh("boot.hex", writes);
    repeat (16) @(negedge clk);
    rst = 0;
    repeat (4) @(negedge clk);
    for (n = 0; n < COUNT; n = n + 1) begin
      adr   = (writes[n][55] ? 32'h31000000 : 32'h30000000) + writes[n][54:32] >> 2;
      dat_w = writes[n][31:0];
      cyc   = 1;
      @(posedge clk);
      while (!ack) @(posedge clk);
      @(negedge clk);
      cyc = 0;
      @(negedge clk);
    end
    we = 0;  // the first writes of the octree, read back while the frame goes on
    for (n = 1; n < 4; n = n + 1) begin
      adr = 32'h31000000 + writes[n][54:32] >> 2;
      cyc = 1;
      @(posedge clk);
      while (!ack) @(posedge clk);
      $display("%h", dat_r);
      reads = reads + 1;
      @(negedge clk);
      cyc = 0;
      @(negedge clk);
    end
  end
endmodule
"""


def litex_top(verilog: Path) -> str:
    """A bus whose master is at the pins, the core, and pixels at the pins."""
    from litex.build.generic_platform import GenericPlatform, Pins, Subsignal
    from litex.soc.integration.soc import SoCRegion
    from litex.soc.integration.soc_core import SoCMini
    from litex.soc.interconnect import wishbone
    from migen import Cat, ClockDomain

    from voxrt.rtl.wrappers.litex_module import REGISTER_BYTES, PixelUnpacker, Voxrt

    host = {"adr": 30, "dat_w": 32, "dat_r": 32, "sel": 4, "cyc": 1, "stb": 1, "we": 1, "ack": 1}
    host |= {"cti": 3, "bte": 2, "err": 1}
    pads = [("clk", 0, Pins(1)), ("rst", 0, Pins(1))]
    pads.append(("host", 0, *(Subsignal(name, Pins(width)) for name, width in host.items())))
    pads.append(("pixel", 0, Subsignal("valid", Pins(1)), Subsignal("rgb", Pins(24))))
    platform = GenericPlatform("none", pads, name="top")

    class Design(SoCMini):
        def __init__(self):
            SoCMini.__init__(self, platform, 50_000_000)
            self.cd_sys = ClockDomain()
            self.comb += [self.cd_sys.clk.eq(platform.request("clk")), self.cd_sys.rst.eq(platform.request("rst"))]
            bus = wishbone.Interface(data_width=32, adr_width=30, addressing="word")
            self.comb += bus.connect_to_pads(platform.request("host"), mode="slave")
            self.bus.add_master("host", bus)
            self.core = core = Voxrt(platform, verilog)
            self.bus.add_slave("voxrt", core.registers, SoCRegion(0x3000_0000, REGISTER_BYTES, cached=False))
            self.bus.add_slave("octree", core.memory, SoCRegion(0x3100_0000, core.memory_bytes, cached=False))
            self.unpacker = PixelUnpacker()
            pixel, pins = self.unpacker.source, platform.request("pixel")
            self.comb += core.source.connect(self.unpacker.sink)
            self.comb += [pixel.ready.eq(1), pins.valid.eq(pixel.valid), pins.rgb.eq(Cat(pixel.b, pixel.g, pixel.r))]

    design = Design()
    design.finalize()
    assert [source[0] for source in platform.sources] == [str(verilog)]
    return str(platform.get_verilog(design, name="top"))


@needs_icarus
def test_litex(verilog, tmp_path):
    need("litex", "migen")
    # LiteX writes processes that start themselves again, for ever, in Icarus.
    (tmp_path / "litex.v").write_text(litex_top(verilog))
    flatten(tmp_path, "read_verilog litex.v")
    count, pixels = len(read_writes()), SIZE[0] * SIZE[1]
    bench = LITEX_BENCH.replace("COUNT", str(count)).replace("PIXELS", str(pixels))
    lines = simulate(tmp_path, bench, tmp_path / "top.v", verilog)
    assert [int(line, 16) for line in lines if len(line) == 8] == [word for _, word in read_writes()[1:4]]
    picture = np.array([list(bytes.fromhex(line)) for line in lines if len(line) == 6], np.uint8)
    assert len(picture) == pixels
    np.testing.assert_array_equal(picture.reshape(SIZE[1], SIZE[0], 3), expected_frame())


def test_litex_for_ulx3s(verilog, tmp_path, monkeypatch):
    need("litex", "litex_boards")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["litex_ulx3s.py", str(verilog), "--output", "out"])
    runpy.run_path(str(EXAMPLES / "litex_ulx3s.py"), run_name="__main__")
    (top,) = (tmp_path / "out").rglob("radiona_ulx3s.v")
    shutil.copy(verilog, top.with_name("core.v"))
    parts = "read_verilog -lib -specify +/ecp5/cells_sim.v +/ecp5/cells_bb.v"
    design = "read_verilog radiona_ulx3s.v core.v; hierarchy -check -top radiona_ulx3s"
    run_yosys(top.parent, f"{parts}; {design}; proc; check -assert")
