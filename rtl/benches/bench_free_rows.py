"""voxrt_free_rows against a set: a row taken is nobody else's, and there is one as long as any is free."""

import random

import cocotb
from cocotb.triggers import RisingEdge
from streams import drive, reset, start

ROWS = 32


async def run(dut, clocks, likely):
    """Take and give back at random, in any order; `likely` of 4 are taken. From a reset on."""
    taken = []
    for _ in range(clocks):
        takes = len(taken) < ROWS and random.randrange(4) < likely
        gives = bool(taken) and random.randrange(4) < 4 - likely
        row = taken.pop(random.randrange(len(taken))) if gives else random.randrange(ROWS)
        drive(dut, take_i=takes, give_i=gives, row_i=row)
        await RisingEdge(dut.clk_i)
        if takes:
            own = dut.row_o.value.to_unsigned()
            assert own not in taken
            assert not gives or own != row, "given back and taken at once"
            taken.append(own)
    drive(dut, take_i=0, give_i=0)


@cocotb.test()
@cocotb.parametrize(likely=[1, 2, 3])
async def rows(dut, likely):
    """Few are taken, or nearly all."""
    await start(dut, take_i=0, give_i=0)
    await run(dut, 1500, likely)


@cocotb.test()
async def reset_at_any_clock(dut):
    """All rows are free after it."""
    await start(dut, take_i=0, give_i=0)
    for _ in range(30):
        await run(dut, random.randrange(1, 150), 3)
        await reset(dut)
