"""voxrt_strip_buffer: pixels in strips come out line by line, whatever the size of the frame."""

import random

import cocotb
from cocotb.triggers import RisingEdge
from streams import PACES, drive, exchange, start
from strip_order import in_strips

LANES = 16


async def frame(dut, width, height, sending, taking):
    drive(dut, start_i=1, width_i=width, height_i=height)
    await RisingEdge(dut.clk_i)
    drive(dut, start_i=0)
    items = [{"pixel_i": line << 12 | column} for line, column in in_strips(LANES, width, height)]
    got = await exchange(dut, items, lambda: int(dut.pixel_o.value), sending, taking)
    assert got == [line << 12 | column for line in range(height) for column in range(width)]


@cocotb.test()
@cocotb.parametrize(**PACES)
async def small_frames(dut, sending, taking):
    """Heights that fill the last strip and that do not."""
    await start(dut, valid_i=0, ready_i=0, start_i=0)
    for _ in range(12):
        await frame(dut, random.randrange(1, 20), random.randrange(1, 50), sending, taking)


@cocotb.test()
@cocotb.parametrize(width=[1023, 1024, 1025, 2048, 2049, 4095])
async def wide_frames(dut, width):
    """Give a strip as many lines as the buffer has room for."""
    await start(dut, valid_i=0, ready_i=0, start_i=0)
    await frame(dut, width, 5, "always", "always")
