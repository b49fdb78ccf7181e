"""voxrt_strip_generator: directions in the order of strips, for frames of all shapes, taken at any pace."""

import random

import cocotb
from cocotb.triggers import ClockCycles, with_timeout
from raster import begin, direction_at, some_frame
from streams import PACES, drive, reset, start, take
from strip_order import in_strips

LANES = 1


def seen(dut):
    """Read a direction."""
    return tuple(value.to_signed() for value in dut.direction_o.value)


def expected(frame):
    """Give all directions of a frame."""
    return [direction_at(frame, line, column) for line, column in in_strips(LANES, *frame[3:])]


@cocotb.test()
@cocotb.parametrize(taking=PACES["taking"])
async def directions(dut, taking):
    """Frames of all shapes, one after another: halves that differ by a column, strips of all heights."""
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(40):
        frame = some_frame(highest=40)
        drive(dut, ready_i=0)
        await begin(dut, frame)
        wanted = expected(frame)
        assert await with_timeout(take(dut, len(wanted), taking, lambda: seen(dut)), 1, "ms") == wanted
        await ClockCycles(dut.clk_i, 3)
        assert not int(dut.valid_o.value)


@cocotb.test()
@cocotb.parametrize(width=[1024, 1025, 2048, 2049, 4095])
async def wide_frames(dut, width):
    """Two strips and a line, of fewer lines where the picture is wide."""
    await start(dut, raster_i=0, ready_i=0)
    frame = *some_frame()[:3], width, 9
    await begin(dut, frame)
    wanted = expected(frame)
    assert await with_timeout(take(dut, len(wanted), "always", lambda: seen(dut)), 1, "ms") == wanted


@cocotb.test()
async def reset_at_any_clock(dut):
    """Begin again after it."""
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(20):
        frame = some_frame(highest=20)
        drive(dut, ready_i=0)
        await begin(dut, frame)
        taker = cocotb.start_soon(take(dut, frame[3] * frame[4], "random", lambda: seen(dut)))
        await ClockCycles(dut.clk_i, random.randrange(1, 40))
        if not taker.done():
            taker.cancel()
        await reset(dut)
        assert not int(dut.valid_o.value)
        drive(dut, ready_i=0)
        await begin(dut, frame)
        assert await take(dut, frame[3] * frame[4], "random", lambda: seen(dut)) == expected(frame)
