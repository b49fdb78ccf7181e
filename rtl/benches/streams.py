"""Streams of valid and ready for the benches of modules: always there or idle at random, on both sides."""

import itertools
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout

PACES = {"sending": ["always", "random"], "taking": ["always", "random"]}


def pace(kind):
    """Give for each clock whether a side is there."""
    if kind == "with long breaks":
        return itertools.chain.from_iterable(
            itertools.repeat(there, random.randint(200, 300)) for there in itertools.cycle((1, 0))
        )
    return itertools.repeat(1) if kind == "always" else iter(lambda: random.randrange(2), 2)


def drive(dut, **values):
    """Set inputs; lists go into the elements of arrays."""
    for name, value in values.items():
        getattr(dut, name).value = value


async def reset(dut, clocks=3):
    dut.rst_ni.value = 0
    await ClockCycles(dut.clk_i, clocks)
    dut.rst_ni.value = 1


def start_clock(dut):
    cocotb.start_soon(Clock(dut.clk_i, 10, "ns").start(start_high=False))


async def start(dut, **values):
    drive(dut, **values)
    start_clock(dut)
    await reset(dut)


def cancel(*tasks):
    for task in tasks:
        if not task.done():
            task.cancel()


async def send(dut, items, kind, *, valid="valid_i", ready="ready_o"):
    """Offer items, dictionaries of inputs, one after another."""
    valid = getattr(dut, valid)
    ready = getattr(dut, ready)
    there = pace(kind)
    for item in items:
        while not next(there):
            valid.value = 0
            await RisingEdge(dut.clk_i)
        drive(dut, **item)
        valid.value = 1
        await RisingEdge(dut.clk_i)
        while not int(ready.value):
            await RisingEdge(dut.clk_i)
    valid.value = 0


async def take(dut, count, kind, get, *, valid="valid_o", ready="ready_i"):
    """Take so many items, as `get` reads them; what is offered must stay until it is taken."""
    valid = getattr(dut, valid)
    ready = getattr(dut, ready)
    taken, offered = [], None
    for wanted in pace(kind):
        if len(taken) == count:
            break
        ready.value = wanted
        await RisingEdge(dut.clk_i)
        item = get() if int(valid.value) else None
        assert offered in (None, item), "what was offered changed before it was taken"
        offered = None if wanted else item
        if wanted and item is not None:
            taken.append(item)
    ready.value = 0
    return taken


async def exchange(dut, items, get, sending, taking, *, count=None, **ports):
    """Send all items while as many are taken; give those. `ports` name the output's valid and ready."""
    sender = cocotb.start_soon(send(dut, items, sending))
    taken = await with_timeout(take(dut, count or len(items), taking, get, **ports), 10, "ms")
    await with_timeout(sender, 10, "ms")
    return taken


async def reset_on_the_way(dut, items, get, **ports):
    """Reset, for one to three clocks, after a random number of clocks, with both sides at work.

    `ports` name the output's valid and ready.
    """
    taker = take(dut, len(items), "random", get, **ports)
    tasks = [cocotb.start_soon(send(dut, items, "random")), cocotb.start_soon(taker)]
    await ClockCycles(dut.clk_i, random.randrange(1, 2 * len(items)))
    cancel(*tasks)
    drive(dut, valid_i=0, **{ports.get("ready", "ready_i"): 0})
    await reset(dut, random.randrange(1, 4))


async def check_bytes(dut, sending, taking):
    """Bytes in are the same bytes out."""
    items = list(random.randbytes(300))
    sent = [{"data_i": item} for item in items]
    assert await exchange(dut, sent, lambda: int(dut.data_o.value), sending, taking) == items


async def check_bytes_after_reset(dut):
    """Nothing sent before a reset at any clock comes after it."""
    await reset_on_the_way(dut, [{"data_i": item} for item in random.randbytes(40)], lambda: int(dut.data_o.value))
    await check_bytes(dut, "random", "random")
