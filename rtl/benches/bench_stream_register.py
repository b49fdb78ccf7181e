"""voxrt_stream_register: bytes in, the same bytes out, one a clock."""

from random import randbytes

import cocotb
from streams import PACES, exchange, reset_on_the_way, start


@cocotb.test()
@cocotb.parametrize(**PACES)
async def order(dut, sending, taking):
    """Send and take at any pace; what is offered stays until it is taken."""
    await start(dut, valid_i=0, ready_i=0)
    items = list(randbytes(300))
    taken = await exchange(dut, [{"data_i": item} for item in items], lambda: int(dut.data_o.value), sending, taking)
    assert taken == items


@cocotb.test()
async def reset_at_any_clock(dut):
    """Drop what is in it."""
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(20):
        items = list(randbytes(40))
        sent = [{"data_i": item} for item in items]
        await reset_on_the_way(dut, sent, lambda: int(dut.data_o.value))
        assert await exchange(dut, sent, lambda: int(dut.data_o.value), "random", "random") == items
