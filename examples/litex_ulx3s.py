"""A LiteX design for ULX3S 85F: the ray tracer draws 160 x 120 pixels, and a monitor shows them four times as large.

It was simulated in parts, and has not run on a board. First ``pip install litex litex-boards`` and
``voxrt core --config tiny --verilog tiny.v``, then::

    python examples/litex_ulx3s.py tiny.v                # writes Verilog to build/litex
    python examples/litex_ulx3s.py tiny.v --build        # yosys, nextpnr-ecp5 and ecppack from your PATH

The serial line is a bridge to the bus: ``litex_server --uart --uart-port /dev/ttyUSB0``. A program then writes what
``docs/first_frame.md`` tells, at the two addresses below.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from litex.gen import LiteXModule
from litex.soc.cores.clock import ECP5PLL
from litex.soc.cores.video import VideoHDMIPHY, VideoTimingGenerator
from litex.soc.integration.builder import Builder
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCMini
from litex_boards.platforms import radiona_ulx3s
from migen import ClockDomain, ClockDomainsRenamer, If, Memory, Signal

from voxrt.rtl.wrappers.litex_module import REGISTER_BYTES, PixelUnpacker, Voxrt

REGISTERS, OCTREE = 0x3000_0000, 0x3100_0000
WIDTH, HEIGHT = 160, 120


class Clocks(LiteXModule):
    """50 MHz for the ray tracer; pixel clock and bit clock of 640 x 480."""

    def __init__(self, platform: radiona_ulx3s.Platform, clock_hz: float) -> None:
        self.cd_sys = ClockDomain()
        self.cd_hdmi = ClockDomain()
        self.cd_hdmi5x = ClockDomain()
        self.pll = pll = ECP5PLL()
        self.comb += [pll.reset.eq(platform.request("rst")), platform.request("wifi_gpio0").eq(1)]
        pll.register_clkin(platform.request("clk25"), 25e6)
        pll.create_clkout(self.cd_sys, clock_hz)
        pll.create_clkout(self.cd_hdmi, 25e6, margin=0)
        pll.create_clkout(self.cd_hdmi5x, 125e6, margin=0)


class Screen(LiteXModule):
    """Keeps a frame in block RAM, and shows it on the DVI pins."""

    def __init__(self, platform: radiona_ulx3s.Platform) -> None:
        self.unpacker = unpacker = PixelUnpacker()
        frame = Memory(24, WIDTH * HEIGHT)
        write, read = frame.get_port(write_capable=True), frame.get_port(clock_domain="hdmi")
        place = Signal(max=WIDTH * HEIGHT)
        pixel = unpacker.source
        self.specials += frame, write, read
        self.comb += [
            pixel.ready.eq(1),
            write.we.eq(pixel.valid),
            write.adr.eq(place),
            If(pixel.first, write.adr.eq(0)),
            write.dat_w[:8].eq(pixel.b),
            write.dat_w[8:16].eq(pixel.g),
            write.dat_w[16:].eq(pixel.r),
        ]
        self.sync += If(pixel.valid, place.eq(write.adr + 1))

        self.timing = timing = ClockDomainsRenamer("hdmi")(VideoTimingGenerator("640x480@60Hz"))
        self.phy = phy = VideoHDMIPHY(platform.request("gpdi"), clock_domain="hdmi")
        scan, sink = timing.source, phy.sink
        row = scan.vcount[2:]
        self.comb += [
            scan.ready.eq(1),
            read.adr.eq((row << 7) + (row << 5) + scan.hcount[2:]),
            sink.valid.eq(1),
            sink.b.eq(read.dat_r[:8]),
            sink.g.eq(read.dat_r[8:16]),
            sink.r.eq(read.dat_r[16:]),
        ]
        self.sync.hdmi += [sink.hsync.eq(scan.hsync), sink.vsync.eq(scan.vsync), sink.de.eq(scan.de)]


class Design(SoCMini):
    """A bus with a serial bridge as master, and the ray tracer."""

    def __init__(self, verilog: Path, clock_hz: float = 50e6) -> None:
        platform = radiona_ulx3s.Platform(device="LFE5U-85F", toolchain="trellis")
        self.crg = Clocks(platform, clock_hz)
        SoCMini.__init__(self, platform, clock_hz, ident="voxrt on ULX3S")
        self.add_uartbone(baudrate=1_000_000)
        self.core = core = Voxrt(platform, verilog)
        self.bus.add_slave("voxrt", core.registers, SoCRegion(REGISTERS, REGISTER_BYTES, cached=False))
        self.bus.add_slave("octree", core.memory, SoCRegion(OCTREE, core.memory_bytes, cached=False))
        self.screen = screen = Screen(platform)
        self.comb += core.source.connect(screen.unpacker.sink)


def main() -> None:
    """Write the design, or build it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("verilog", type=Path, help="the core, of voxrt core --verilog")
    parser.add_argument("--build", action="store_true", help="synthesize, place and route")
    parser.add_argument("--output", type=Path, default=Path("build/litex"))
    options = parser.parse_args()
    builder = Builder(Design(options.verilog), output_dir=str(options.output), compile_software=False)
    builder.build(run=options.build)


if __name__ == "__main__":
    main()
