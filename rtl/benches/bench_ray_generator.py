"""voxrt_ray_generator: directions of frames, taken at any pace; the corner and the step come as from voxrt_scan."""

import random

import cocotb
from cocotb.triggers import ClockCycles, with_timeout
from raster import begin, direction_at, some_frame
from streams import PACES, drive, reset, start, take


def seen(dut):
    """Read a direction and its marks."""
    direction = tuple(value.to_signed() for value in dut.direction_o.value)
    return direction, int(dut.first_o.value), int(dut.line_end_o.value), int(dut.last_o.value)


def expected(frame):
    """Give all directions of a frame."""
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


@cocotb.test()
@cocotb.parametrize(taking=PACES["taking"])
async def directions(dut, taking):
    """Frames of all shapes, one after another."""
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(30):
        frame = some_frame()
        drive(dut, ready_i=0)
        await begin(dut, frame)
        wanted = expected(frame)
        assert await with_timeout(take(dut, len(wanted), taking, lambda: seen(dut)), 1, "ms") == wanted
        await ClockCycles(dut.clk_i, 3)
        assert not int(dut.valid_o.value)


@cocotb.test()
async def reset_at_any_clock(dut):
    """Begin again after it."""
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(20):
        frame = some_frame()
        drive(dut, ready_i=0)
        await begin(dut, frame)
        taker = cocotb.start_soon(take(dut, frame[3] * frame[4], "random", lambda: seen(dut)))
        await ClockCycles(dut.clk_i, random.randrange(1, 30))
        if not taker.done():
            taker.cancel()
        await reset(dut)
        assert not int(dut.valid_o.value)
        drive(dut, ready_i=0)
        await begin(dut, frame)
        assert await take(dut, frame[3] * frame[4], "random", lambda: seen(dut)) == expected(frame)
