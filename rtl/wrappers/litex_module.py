"""The core as a module of LiteX. ``examples/litex_ulx3s.py`` has a design for a board.

Needs the package litex.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from litex.gen import LiteXModule
from litex.soc.interconnect import axi, stream, wishbone
from migen import FSM, ClockSignal, If, Instance, NextState, NextValue, Replicate, ResetSignal, Signal

from voxrt.rtl.wrappers.verilog_file import memory_bytes, read_clocks, read_parameters

if TYPE_CHECKING:
    import os

REGISTER_BYTES = 2048
_REGISTER_BITS = 11
_EXTERNAL_INPUTS = ("arready", "rvalid", "rdata", "rresp", "rlast")


class Voxrt(LiteXModule):
    """A ray tracer with its octree memory in block RAM.

    Parameters
    ----------
    platform
        Gets the core's Verilog as a source. None: the caller gives it to the tools.
    verilog
        What ``voxrt core --config NAME --verilog FILE`` has written.

    Attributes
    ----------
    registers
        AXI4-Lite slave of 2 KiB: ``soc.bus.add_slave("voxrt", core.registers, SoCRegion(...))``.
    memory
        Wishbone slave of `memory_bytes` bytes, whole words only: word a of the octree is at byte 4 a.
    source
        Video, words of 32 bits as ``docs/rtl.md`` has them; `first` begins a frame, `last` ends a line.

    Raises
    ------
    VerilogFileError
        The file is no core.
    """

    def __init__(self, platform: Any, verilog: str | os.PathLike[str]) -> None:  # noqa: ANN401 - LiteX has no types
        parameters = read_parameters(verilog)
        if platform is not None:
            platform.add_source(str(Path(verilog).resolve()), "verilog")
        self.memory_bytes = memory_bytes(parameters)
        self.registers = axi.AXILiteInterface(data_width=32, address_width=32)
        self.memory = wishbone.Interface(data_width=32, adr_width=30, addressing="word")
        self.source = stream.Endpoint([("data", 32), ("keep", 4)])
        enable, address, read = Signal(), Signal(32), Signal(32)
        memory, bus, source = self.memory, self.registers, self.source

        words = (self.memory_bytes // 4).bit_length() - 1
        self.comb += [address[2 : 2 + words].eq(memory.adr), memory.dat_r.eq(read)]
        clocks = read_clocks(parameters)
        count = Signal(max=clocks)
        self.fsm = fsm = FSM(reset_state="IDLE")
        fsm.act(
            "IDLE",
            enable.eq(memory.cyc & memory.stb),
            If(
                memory.cyc & memory.stb,
                If(memory.we, memory.ack.eq(1)).Else(NextValue(count, clocks - 1), NextState("READ")),
            ),
        )
        fsm.act("READ", If(count == 0, memory.ack.eq(1), NextState("IDLE")).Else(NextValue(count, count - 1)))

        ports = {
            "i_clk_i": ClockSignal(),
            "i_rst_ni": ~ResetSignal(),
            "i_s_axil_awvalid": bus.aw.valid,
            "o_s_axil_awready": bus.aw.ready,
            "i_s_axil_awaddr": bus.aw.addr[:_REGISTER_BITS],
            "i_s_axil_awprot": bus.aw.prot,
            "i_s_axil_wvalid": bus.w.valid,
            "o_s_axil_wready": bus.w.ready,
            "i_s_axil_wdata": bus.w.data,
            "i_s_axil_wstrb": bus.w.strb,
            "o_s_axil_bvalid": bus.b.valid,
            "i_s_axil_bready": bus.b.ready,
            "o_s_axil_bresp": bus.b.resp,
            "i_s_axil_arvalid": bus.ar.valid,
            "o_s_axil_arready": bus.ar.ready,
            "i_s_axil_araddr": bus.ar.addr[:_REGISTER_BITS],
            "i_s_axil_arprot": bus.ar.prot,
            "o_s_axil_rvalid": bus.r.valid,
            "i_s_axil_rready": bus.r.ready,
            "o_s_axil_rdata": bus.r.data,
            "o_s_axil_rresp": bus.r.resp,
            "i_bram_en_i": enable,
            "i_bram_we_i": Replicate(memory.we & (memory.sel == 0xF), 4),
            "i_bram_addr_i": address,
            "i_bram_wrdata_i": memory.dat_w,
            "o_bram_rddata_o": read,
            "o_m_axis_tvalid": source.valid,
            "i_m_axis_tready": source.ready,
            "o_m_axis_tdata": source.data,
            "o_m_axis_tkeep": source.keep,
            "o_m_axis_tuser": source.first,
            "o_m_axis_tlast": source.last,
        }
        ports |= {f"i_m_axi{port}_{name}": 0 for port in (0, 1) for name in _EXTERNAL_INPUTS}
        self.specials += Instance("voxrt_core", **ports)


class PixelUnpacker(LiteXModule):
    """Makes pixels of the words of the video stream. The width of pictures must be a multiple of 4.

    Attributes
    ----------
    sink
        As :attr:`Voxrt.source`.
    source
        Pixels: red, green, blue. `first` begins a frame.
    """

    def __init__(self) -> None:
        self.sink = stream.Endpoint([("data", 32), ("keep", 4)])
        self.source = stream.Endpoint([("r", 8), ("g", 8), ("b", 8)])
        sink, source = self.sink, self.source
        # Three words hold four pixels: pixel n ends in word n, and the last one in the word of the third.
        kept, phase, place = Signal(32), Signal(2), Signal(2)
        pixel = Signal(24)
        self.comb += [
            If(~(sink.valid & sink.first) | (phase == 3), place.eq(phase)),
            pixel.eq(sink.data[:24]),
            If(place == 1, pixel.eq((kept >> 24) | (sink.data << 8))),
            If(place == 2, pixel.eq((kept >> 16) | (sink.data << 16))),
            If(place == 3, pixel.eq(kept >> 8)),
            source.g.eq(pixel[:8]),
            source.b.eq(pixel[8:16]),
            source.r.eq(pixel[16:]),
            source.valid.eq(sink.valid | (place == 3)),
            source.first.eq(sink.valid & sink.first & (place == 0)),
            sink.ready.eq(source.ready & (place != 3)),
        ]
        self.sync += If(source.valid & source.ready, phase.eq(place + 1), If(place != 3, kept.eq(sink.data)))
