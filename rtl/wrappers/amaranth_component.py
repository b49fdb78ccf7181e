"""The core as a component of Amaranth. Needs the package amaranth.

A minimal design::

    m.submodules.core = core = VoxrtCore("tiny.v")
    platform.add_file("tiny.v", Path("tiny.v").read_text())
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from amaranth.hdl import ClockSignal, Const, Instance, Module, ResetSignal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from voxrt.rtl.wrappers.verilog_file import read_clocks, read_parameters

if TYPE_CHECKING:
    import os

_EXTERNAL_INPUTS = {"arready": 1, "rvalid": 1, "rdata": 64, "rresp": 2, "rlast": 1}

AXI_LITE = wiring.Signature(
    {
        "awvalid": Out(1),
        "awready": In(1),
        "awaddr": Out(11),
        "awprot": Out(3),
        "wvalid": Out(1),
        "wready": In(1),
        "wdata": Out(32),
        "wstrb": Out(4),
        "bvalid": In(1),
        "bready": Out(1),
        "bresp": In(2),
        "arvalid": Out(1),
        "arready": In(1),
        "araddr": Out(11),
        "arprot": Out(3),
        "rvalid": In(1),
        "rready": Out(1),
        "rdata": In(32),
        "rresp": In(2),
    }
)
"""The registers, as their master sees them."""

MEMORY_PORT = wiring.Signature({"en": Out(1), "we": Out(4), "addr": Out(32), "wrdata": Out(32), "rddata": In(32)})
"""The octree memory, as its master sees it: byte addresses, whole words."""

VIDEO = stream.Signature(data.StructLayout({"data": 32, "keep": 4, "user": 1, "last": 1}))
"""The picture, as ``docs/rtl.md`` has it: `user` marks a frame's first word, `last` a line's last."""


class VoxrtCore(wiring.Component):
    """A ray tracer with its octree memory in block RAM, in the domain ``sync``.

    Parameters
    ----------
    verilog
        What ``voxrt core --config NAME --verilog FILE`` has written. The platform, or the simulator, must get the file.

    Attributes
    ----------
    registers, memory, video
        Its ports.
    parameters
        Of the core, by name.
    read_clocks
        Clocks from an address of `memory` to its word.

    Raises
    ------
    VerilogFileError
        The file is no core.
    """

    def __init__(self, verilog: str | os.PathLike[str]) -> None:
        self.parameters = read_parameters(verilog)
        self.read_clocks = read_clocks(self.parameters)
        super().__init__({"registers": In(AXI_LITE), "memory": In(MEMORY_PORT), "video": Out(VIDEO)})

    def elaborate(self, _platform: Any) -> Module:  # noqa: ANN401 - whatever Amaranth gives
        """Make the instance."""
        m = Module()
        ports: dict[str, Any] = {"i_clk_i": ClockSignal(), "i_rst_ni": ~ResetSignal()}
        for prefix, interface in (("s_axil", self.registers), ("bram", self.memory)):
            for name, member in interface.signature.members.items():
                inward = member.flow == In  # as the master's partner sees it
                suffix = "" if prefix == "s_axil" else "_i" if inward else "_o"
                ports[f"{'i' if inward else 'o'}_{prefix}_{name}{suffix}"] = getattr(interface, name)
        video = self.video
        ports |= {"o_m_axis_tvalid": video.valid, "i_m_axis_tready": video.ready}
        ports |= {f"o_m_axis_t{name}": getattr(video.payload, name) for name in ("data", "keep", "user", "last")}
        ports |= {
            f"i_m_axi{port}_{name}": Const(0, width) for port in (0, 1) for name, width in _EXTERNAL_INPUTS.items()
        }
        m.submodules.core = Instance("voxrt_core", **ports)
        return m
