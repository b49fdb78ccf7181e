"""voxrt_scan: the direction of the top left pixel and the step from line to line, for any registers."""

import random

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge
from streams import drive, reset, start
from structs import SCAN, packed_array, signed, unpacked_array

SIZE_BITS = 12


def some_registers():
    """Make look, right and up, the largest among them."""
    return [[random.choice([-32768, 32767, random.randint(-32768, 32767)]) for _ in range(3)] for _ in range(3)]


def line_step(dut):
    return [signed(value, SCAN) for value in unpacked_array(dut.line_step_o.value.to_unsigned(), 3, SCAN)]


async def check(dut):
    look, right, up = some_registers()
    width, height = (random.choice([0, 2047, random.randrange(2048)]) for _ in range(2))
    drive(dut, **{f"{name}_i": packed_array(row, 16) for name, row in (("look", look), ("right", right), ("up", up))})
    drive(dut, half_width_i=width, half_height_i=height, start_i=1)
    await RisingEdge(dut.clk_i)
    drive(dut, start_i=0)
    await ClockCycles(dut.clk_i, 2 * SIZE_BITS + 1)
    assert int(dut.corner_o.value)
    assert line_step(dut) == [a - b * width + c * height for a, b, c in zip(look, right, up, strict=True)]
    await ClockCycles(dut.clk_i, 2)
    for _ in range(3):
        assert line_step(dut) == [-c for c in up]
        await RisingEdge(dut.clk_i)


@cocotb.test()
async def corners(dut):
    await start(dut, start_i=0)
    for _ in range(60):
        await check(dut)
        drive(dut, start_i=1)
        await RisingEdge(dut.clk_i)
        drive(dut, start_i=0)
        await ClockCycles(dut.clk_i, random.randrange(1, 30))
        await reset(dut)
