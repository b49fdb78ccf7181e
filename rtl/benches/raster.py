"""Frames for the benches of ray generators: the corner and the steps come as voxrt_scan gives them."""

import random

from cocotb.triggers import ClockCycles, RisingEdge
from streams import drive
from structs import RASTER


def some_frame(*, widest=20, highest=9):
    """Make a corner, a step to the right, one to the next line, and a size."""
    corner, right, line = ([random.randint(-30000, 30000) for _ in range(3)] for _ in range(3))
    width = random.choice([1, 2, random.randint(1, widest)])
    return corner, right, line, width, random.choice([1, random.randint(1, highest)])


async def begin(dut, frame):
    """Start a frame as voxrt_scan does."""
    corner, right, line, width, height = frame
    held = {"right": right, "width": width, "height": height}
    drive(dut, raster_i=RASTER.pack(start=1, **held))
    await RisingEdge(dut.clk_i)
    drive(dut, raster_i=RASTER.pack(**held))
    await ClockCycles(dut.clk_i, random.randrange(1, 9))
    drive(dut, raster_i=RASTER.pack(corner=1, line_step=corner, **held))
    await RisingEdge(dut.clk_i)
    drive(dut, raster_i=RASTER.pack(**held))
    await RisingEdge(dut.clk_i)
    drive(dut, raster_i=RASTER.pack(line_step=line, **held))


def direction_at(frame, line, column):
    """Give the direction of a pixel."""
    corner, right, down, _, _ = frame
    return tuple(c + column * r + line * s for c, r, s in zip(corner, right, down, strict=True))
