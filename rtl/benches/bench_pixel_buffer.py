"""voxrt_pixel_buffer: entries completed in any order come out in the order in which they were allocated."""

from random import randrange, shuffle

import cocotb
from cocotb.triggers import ClockCycles, FallingEdge, RisingEdge, with_timeout
from streams import PACES, cancel, drive, pace, reset, start, take

DEPTH = 16


async def complete(dut, pixels, kind, disorder):
    """Allocate an entry per pixel; store and complete them late, out of order, the pixel first or with the answer."""
    waiting, there, allocated = [], pace(kind), 0
    while pixels[allocated:] or waiting:
        await FallingEdge(dut.clk_i)  # ready_o is that of the next clock.
        allocates = allocated < len(pixels) and int(dut.ready_o.value) and next(there)
        drive(dut, allocate_i=allocates, complete_i=0, store_i=0)
        if waiting and (len(waiting) > disorder or allocated == len(pixels) or not int(dut.ready_o.value)):
            tag, pixel, lit, stored = waiting.pop(0)
            if not stored and randrange(2):
                drive(dut, store_i=1, tag_i=tag, pixel_i=pixel)
                waiting.insert(randrange(len(waiting) + 1), (tag, pixel, lit, True))
            else:
                drive(dut, complete_i=1, tag_i=tag, lit_i=lit, store_i=not stored, pixel_i=pixel)
        await RisingEdge(dut.clk_i)
        if allocates:
            waiting.append((int(dut.tag_o.value), *pixels[allocated], False))
            allocated += 1
            shuffle(waiting)
        drive(dut, allocate_i=0, complete_i=0, store_i=0)
        await RisingEdge(dut.clk_i)


def seen(dut):
    return int(dut.pixel_o.value), int(dut.lit_o.value)


def some(count):
    return [(randrange(1024), randrange(2)) for _ in range(count)]


@cocotb.test()
@cocotb.parametrize(**PACES, disorder=[0, 7, 99])
async def order(dut, sending, taking, disorder):
    await start(dut, allocate_i=0, complete_i=0, store_i=0, ready_i=0)
    await ClockCycles(dut.clk_i, 20)
    pixels = some(200)
    completer = cocotb.start_soon(complete(dut, pixels, sending, disorder))
    assert await with_timeout(take(dut, len(pixels), taking, lambda: seen(dut)), 1, "ms") == pixels
    await completer
    await ClockCycles(dut.clk_i, 20)
    assert not int(dut.valid_o.value)


@cocotb.test()
async def a_pixel_per_clock(dut):
    """Pixels that are all complete come one per clock; a full buffer has no more entries to allocate."""
    await start(dut, allocate_i=0, complete_i=0, store_i=0, ready_i=0)
    await ClockCycles(dut.clk_i, 20)
    for _ in range(5):
        tags, pixels = [], some(DEPTH)
        for _ in range(2 * DEPTH):
            await FallingEdge(dut.clk_i)
            drive(dut, allocate_i=int(dut.ready_o.value))
            await RisingEdge(dut.clk_i)
            tags += [int(dut.tag_o.value)] * int(dut.allocate_i.value)
        assert len(tags) == DEPTH
        for tag, (pixel, lit) in zip(tags, pixels, strict=True):
            drive(dut, allocate_i=0, complete_i=1, store_i=1, tag_i=tag, pixel_i=pixel, lit_i=lit)
            await RisingEdge(dut.clk_i)
        drive(dut, complete_i=0, store_i=0)
        await ClockCycles(dut.clk_i, 10)
        drive(dut, ready_i=1)
        for pixel in pixels:
            await RisingEdge(dut.clk_i)
            assert int(dut.valid_o.value)
            assert seen(dut) == pixel
        drive(dut, ready_i=0)
        await ClockCycles(dut.clk_i, 3)


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, allocate_i=0, complete_i=0, store_i=0, ready_i=0)
    await ClockCycles(dut.clk_i, 20)
    for _ in range(20):
        pixels = some(40)
        tasks = [cocotb.start_soon(complete(dut, pixels, "random", 5))]
        tasks.append(cocotb.start_soon(take(dut, 40, "random", lambda: seen(dut))))
        await ClockCycles(dut.clk_i, randrange(1, 200))
        cancel(*tasks)
        drive(dut, allocate_i=0, complete_i=0, store_i=0, ready_i=0)
        await reset(dut)
        await ClockCycles(dut.clk_i, 20)
        pixels = some(20)
        completer = cocotb.start_soon(complete(dut, pixels, "always", 3))
        assert await with_timeout(take(dut, 20, "always", lambda: seen(dut)), 1, "ms") == pixels
        await completer
