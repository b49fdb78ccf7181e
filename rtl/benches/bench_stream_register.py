"""voxrt_stream_register: bytes in, the same bytes out, one per clock."""

from random import randbytes

import cocotb
from cocotb.triggers import FallingEdge, ReadOnly, Timer
from streams import PACES, exchange, reset_on_the_way, start


@cocotb.test()
@cocotb.parametrize(**PACES)
async def order(dut, sending, taking):
    await start(dut, valid_i=0, ready_i=0)
    items = list(randbytes(300))
    taken = await exchange(dut, [{"data_i": item} for item in items], lambda: int(dut.data_o.value), sending, taking)
    assert taken == items


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(20):
        items = list(randbytes(40))
        sent = [{"data_i": item} for item in items]
        await reset_on_the_way(dut, sent, lambda: int(dut.data_o.value))
        assert await exchange(dut, sent, lambda: int(dut.data_o.value), "random", "random") == items


@cocotb.test()
async def ready_within_a_clock(dut):
    """Change ready_i between clock edges: ready_o follows, or with CutsReady it does not."""
    await start(dut, valid_i=0, ready_i=0)
    cuts = int(dut.CutsReady.value)
    # ready_o with ready_i low, and high, while 0, 1 and 2 bytes are in it.
    for expected in [(1, 1), (1, 1), (0, 0)] if cuts else [(1, 1), (0, 1)]:
        await FallingEdge(dut.clk_i)
        seen = []
        for ready in (0, 1, 0):
            dut.ready_i.value = ready
            await ReadOnly()
            seen.append(int(dut.ready_o.value))
            await Timer(1, "ns")
        assert seen == [*expected, expected[0]]
        dut.valid_i.value = 1
