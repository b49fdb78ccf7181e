"""voxrt_merge: pixels of lanes in turn."""

from random import randrange

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from streams import PACES, cancel, drive, pace, reset, start, take

LANES = 5


async def lanes(dut, pixels, kind):
    waiting = [pixels[lane::LANES] for lane in range(LANES)]
    there = pace(kind)
    offered = [False] * LANES
    while any(waiting):
        offered = [bool(own) and (was or next(there)) for own, was in zip(waiting, offered, strict=True)]
        drive(dut, valid_i=sum(offers << lane for lane, offers in enumerate(offered)))
        drive(dut, pixel_i=[own[0] if own else 0 for own in waiting])
        await RisingEdge(dut.clk_i)
        ready = int(dut.ready_o.value)
        for lane in range(LANES):
            if offered[lane] and ready >> lane & 1:
                waiting[lane].pop(0)
                offered[lane] = False
    drive(dut, valid_i=0)


@cocotb.test()
@cocotb.parametrize(**PACES)
async def order(dut, sending, taking):
    """Frames of any number of pixels; each starts with lane 0."""
    await start(dut, valid_i=0, ready_i=0, start_i=0)
    for count in (1, 7, 100):
        drive(dut, start_i=1)
        await RisingEdge(dut.clk_i)
        drive(dut, start_i=0)
        pixels = [randrange(256) for _ in range(count)]
        sender = cocotb.start_soon(lanes(dut, pixels, sending))
        assert await with_timeout(take(dut, count, taking, lambda: int(dut.pixel_o.value)), 1, "ms") == pixels
        await sender


@cocotb.test()
async def reset_at_any_clock(dut):
    """Lane 0 is next after it."""
    await start(dut, valid_i=0, ready_i=0, start_i=0)
    for _ in range(10):
        pixels = [randrange(256) for _ in range(20)]
        tasks = [cocotb.start_soon(lanes(dut, pixels, "random"))]
        tasks.append(cocotb.start_soon(take(dut, 20, "random", lambda: int(dut.pixel_o.value))))
        await ClockCycles(dut.clk_i, randrange(1, 40))
        cancel(*tasks)
        drive(dut, valid_i=0, ready_i=0)
        await reset(dut)
        sender = cocotb.start_soon(lanes(dut, pixels, "random"))
        assert await take(dut, 20, "random", lambda: int(dut.pixel_o.value)) == pixels
        await sender
