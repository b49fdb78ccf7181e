"""voxrt_strip_generator: directions in the order of strips, for frames of all shapes, taken at any pace."""

import cocotb
from raster import check_frame, check_reset, direction_at, some_frame
from streams import PACES, start
from strip_order import in_strips

LANES = 1


def seen(dut):
    return tuple(value.to_signed() for value in dut.direction_o.value)


def expected(frame):
    return [direction_at(frame, line, column) for line, column in in_strips(LANES, *frame[3:])]


@cocotb.test()
@cocotb.parametrize(taking=PACES["taking"])
async def directions(dut, taking):
    """Frames of all shapes, one after another: halves that differ by a column, strips of all heights."""
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(40):
        frame = some_frame(highest=40)
        await check_frame(dut, frame, expected(frame), taking, lambda: seen(dut))


@cocotb.test()
@cocotb.parametrize(width=[1024, 1025, 2048, 2049, 4095])
async def wide_frames(dut, width):
    """Two strips and a line, of fewer lines where the picture is wide."""
    await start(dut, raster_i=0, ready_i=0)
    frame = *some_frame()[:3], width, 9
    await check_frame(dut, frame, expected(frame), "always", lambda: seen(dut))


@cocotb.test()
@cocotb.parametrize(height=[513, 1500, 4095])
async def tall_frames(dut, height):
    await start(dut, raster_i=0, ready_i=0)
    frame = *some_frame()[:3], 1, height
    await check_frame(dut, frame, expected(frame), "always", lambda: seen(dut))


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(20):
        frame = some_frame(highest=20)
        await check_reset(dut, frame, expected(frame), lambda: seen(dut))
