"""Frames for the benches of ray generators: the corner and the steps come as voxrt_scan gives them."""

import random

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from streams import cancel, drive, reset, take
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
    corner, right, down, _, _ = frame
    return tuple(c + column * r + line * s for c, r, s in zip(corner, right, down, strict=True))


def line_by_line(frame):
    """Give a frame's directions in raster order, each with whether it is the first, its line's last, the last."""
    width, height = frame[3:]
    return [
        (
            direction_at(frame, line, column),
            line == column == 0,
            column == width - 1,
            (line, column) == (height - 1, width - 1),
        )
        for line in range(height)
        for column in range(width)
    ]


async def check_frame(dut, frame, wanted, taking, get):
    """Start a frame and take what comes, by `get`: it is `wanted`, and no more comes."""
    drive(dut, ready_i=0)
    await begin(dut, frame)
    assert await with_timeout(take(dut, len(wanted), taking, get), 1, "ms") == wanted
    await ClockCycles(dut.clk_i, 3)
    assert not int(dut.valid_o.value)


async def check_reset(dut, frame, wanted, get):
    """Reset at a random clock of a frame. Then the same frame is right from its start."""
    drive(dut, ready_i=0)
    await begin(dut, frame)
    taker = cocotb.start_soon(take(dut, len(wanted), "random", get))
    await ClockCycles(dut.clk_i, random.randrange(1, 40))
    cancel(taker)
    await reset(dut)
    assert not int(dut.valid_o.value)
    await check_frame(dut, frame, wanted, "random", get)
