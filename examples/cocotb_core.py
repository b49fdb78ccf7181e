"""The core in a cocotb bench of its own: plays the writes of boot.hex, and keeps the picture of the video stream.

``pip install 'cocotb>=2' numpy``, Icarus Verilog, and ``voxrt core --config tiny --verilog tiny.v``, then::

    python examples/cocotb_core.py tiny.v boot.hex       # draws to frame.npy
"""

import os
import sys
from pathlib import Path

import cocotb
import numpy as np
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, FallingEdge, RisingEdge
from cocotb_tools.runner import get_runner

WRITES = Path(os.environ.get("BOOT", os.devnull)).read_text().split()
ALL_ONES = ("s_axil_bready", "s_axil_rready", "m_axis_tready", "s_axil_wstrb")


@cocotb.test()
async def first_frame(dut):
    """Draw the frame."""
    for port in dut:  # inputs that nothing drives are unknown in a simulation
        if port._name.endswith(("_i", "_ni")) or port._name.startswith(("s_axil", "m_axi")):  # noqa: SLF001
            port.value = (1 << len(port)) - 1 if port._name in ALL_ONES else 0  # noqa: SLF001
    cocotb.start_soon(Clock(dut.clk_i, 10, unit="step").start())
    await ClockCycles(dut.clk_i, 16)
    await FallingEdge(dut.clk_i)
    dut.rst_ni.value = 1
    size, stream = 0, bytearray()
    for line in WRITES:
        address, data = (int(part, 16) for part in line.split("_"))
        size = data if address == 0x014 else size
        await (write_word(dut, address & 0x7FFFFF, data) if address >> 23 else write_register(dut, address, data))
    width, height = size & 0xFFF, size >> 16
    while len(stream) < 3 * width * height:
        await RisingEdge(dut.clk_i)
        if dut.m_axis_tvalid.value == 1:
            word, keep = int(dut.m_axis_tdata.value), int(dut.m_axis_tkeep.value)
            stream += bytes(word >> 8 * byte & 0xFF for byte in range(4) if keep >> byte & 1)
    np.save("frame.npy", np.frombuffer(stream, np.uint8).reshape(height, width, 3)[..., [2, 0, 1]])


async def write_register(dut, address, data):
    """Write a register by AXI4-Lite."""
    dut.s_axil_awaddr.value, dut.s_axil_wdata.value = address, data
    pending = {dut.s_axil_awvalid: dut.s_axil_awready, dut.s_axil_wvalid: dut.s_axil_wready}
    for valid in pending:
        valid.value = 1
    while pending:
        await RisingEdge(dut.clk_i)
        taken = [valid for valid, ready in pending.items() if ready.value == 1]
        await FallingEdge(dut.clk_i)
        for valid in taken:
            valid.value = 0
            del pending[valid]


async def write_word(dut, address, word):
    """Write a word of the octree by the memory port."""
    dut.bram_en_i.value, dut.bram_we_i.value, dut.bram_addr_i.value, dut.bram_wrdata_i.value = 1, 0xF, address, word
    await FallingEdge(dut.clk_i)
    dut.bram_en_i.value = 0


if __name__ == "__main__":
    runner = get_runner("icarus")
    runner.build(
        sources=[Path(sys.argv[1]).resolve()], hdl_toplevel="voxrt_core", build_dir="build/cocotb", always=True
    )
    runner.test(
        hdl_toplevel="voxrt_core",
        test_module=Path(__file__).stem,
        build_dir="build/cocotb",
        test_dir=Path.cwd(),
        extra_env={"BOOT": str(Path(sys.argv[2]).resolve()), "PYTHONPATH": str(Path(__file__).resolve().parent)},
    )
