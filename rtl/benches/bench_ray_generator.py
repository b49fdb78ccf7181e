"""voxrt_ray_generator: directions of frames, taken at any pace; the corner and the step come as from voxrt_scan."""

import random

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from streams import PACES, drive, reset, start, take
from structs import RASTER


def some_frame():
    """Make a corner, a step to the right, one to the next line, and a size."""
    corner, right, line = ([random.randint(-30000, 30000) for _ in range(3)] for _ in range(3))
    return corner, right, line, random.choice([1, 2, random.randint(1, 20)]), random.choice([1, random.randint(1, 9)])


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


def seen(dut):
    """Read a direction and its marks."""
    direction = tuple(value.to_signed() for value in dut.direction_o.value)
    return direction, int(dut.first_o.value), int(dut.line_end_o.value), int(dut.last_o.value)


def expected(corner, right, line, width, height):
    """Give all directions of a frame."""
    return [
        (
            tuple(c + column * r + row * s for c, r, s in zip(corner, right, line, strict=True)),
            row == column == 0,
            column == width - 1,
            (row, column) == (height - 1, width - 1),
        )
        for row in range(height)
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
        wanted = expected(*frame)
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
        assert await take(dut, frame[3] * frame[4], "random", lambda: seen(dut)) == expected(*frame)
