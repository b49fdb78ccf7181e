"""voxrt_free_list against a set: an allocated row is nobody else's, and there is one as long as any is free."""

import random

import cocotb
from cocotb.triggers import RisingEdge
from streams import drive, reset, start

ROWS = 32


async def run(dut, clocks, likely):
    """Allocate and free at random, in any order; `likely` of 4 are allocated. From a reset on."""
    allocated = []
    for _ in range(clocks):
        allocates = len(allocated) < ROWS and random.randrange(4) < likely
        frees = bool(allocated) and random.randrange(4) < 4 - likely
        row = allocated.pop(random.randrange(len(allocated))) if frees else random.randrange(ROWS)
        drive(dut, allocate_i=allocates, free_i=frees, row_i=row)
        await RisingEdge(dut.clk_i)
        if allocates:
            own = dut.row_o.value.to_unsigned()
            assert own not in allocated
            assert not frees or own != row, "freed and allocated at once"
            allocated.append(own)
    drive(dut, allocate_i=0, free_i=0)


@cocotb.test()
@cocotb.parametrize(likely=[1, 2, 3])
async def rows(dut, likely):
    await start(dut, allocate_i=0, free_i=0)
    await run(dut, 1500, likely)


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, allocate_i=0, free_i=0)
    for _ in range(30):
        await run(dut, random.randrange(1, 150), 3)
        await reset(dut)
