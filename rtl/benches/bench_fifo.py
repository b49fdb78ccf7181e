"""voxrt_fifo against a queue."""

from collections import deque
from random import randrange

import cocotb
from cocotb.triggers import RisingEdge
from streams import PACES, check_bytes, check_bytes_after_reset, drive, start

DEPTH = 16


@cocotb.test()
@cocotb.parametrize(**PACES)
async def order(dut, sending, taking):
    await start(dut, valid_i=0, ready_i=0)
    await check_bytes(dut, sending, taking)


@cocotb.test()
async def every_clock_as_a_queue(dut):
    """Ready and valid tell full and empty at every clock, in long spells of more coming and more going."""
    await start(dut, valid_i=0, ready_i=0)
    queue = deque()
    for clock in range(2000):
        likely = 1 if clock // 50 % 2 else 3
        coming, going, item = randrange(4) < likely, randrange(4) < 4 - likely, randrange(256)
        drive(dut, valid_i=coming, data_i=item, ready_i=going)
        await RisingEdge(dut.clk_i)
        assert int(dut.ready_o.value) == (len(queue) < DEPTH)
        assert int(dut.valid_o.value) == bool(queue)
        full = len(queue) == DEPTH
        if queue:
            assert int(dut.data_o.value) == queue[0]
            if going:
                queue.popleft()
        if coming and not full:
            queue.append(item)


@cocotb.test()
async def reset(dut):
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(20):
        await check_bytes_after_reset(dut)
