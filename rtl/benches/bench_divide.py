"""voxrt_divide against Python's division; what waits in a stage stays while its valid is low."""

import random

import cocotb
from cocotb.triggers import RisingEdge
from streams import drive, pace, start_clock

DIVISOR_BITS = QUOTIENT_BITS = 8


def some_division():
    """Make a dividend whose quotient fits, and a divisor: extremes among them."""
    divisor = random.choice([1, 2, 255, random.randint(1, 255)])
    largest = (divisor << QUOTIENT_BITS) - 1
    return random.choice([0, largest, divisor, divisor - 1, random.randint(0, largest)]), divisor


@cocotb.test()
@cocotb.parametrize(sending=["always", "random"])
async def quotients(dut, sending):
    start_clock(dut)
    drive(dut, valid_i=0)
    await RisingEdge(dut.clk_i)
    there, entering, shown = pace(sending), [None] * QUOTIENT_BITS, None
    for _ in range(3000):
        coming = some_division() if next(there) else None
        entering = [coming, *entering[:-1]]
        dividend, divisor = coming or (random.randrange(1 << 16), random.randrange(256))
        valid = sum((division is not None) << stage for stage, division in enumerate(entering))
        drive(dut, valid_i=valid, dividend_i=dividend, divisor_i=divisor)
        await RisingEdge(dut.clk_i)
        if shown is not None:
            assert int(dut.quotient_o.value) == shown[0] // shown[1]
        shown = entering[-1] or shown
