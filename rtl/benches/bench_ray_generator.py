"""voxrt_ray_generator: directions of frames, taken at any pace; the corner and the step come as from voxrt_scan."""

import cocotb
from raster import check_frame, check_reset, line_by_line, some_frame
from streams import PACES, start


def seen(dut):
    direction = tuple(value.to_signed() for value in dut.direction_o.value)
    return direction, int(dut.first_o.value), int(dut.line_end_o.value), int(dut.last_o.value)


@cocotb.test()
@cocotb.parametrize(taking=PACES["taking"])
async def directions(dut, taking):
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(30):
        frame = some_frame()
        await check_frame(dut, frame, line_by_line(frame), taking, lambda: seen(dut))


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, raster_i=0, ready_i=0)
    for _ in range(20):
        frame = some_frame()
        await check_reset(dut, frame, line_by_line(frame), lambda: seen(dut))
