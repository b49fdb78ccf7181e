"""voxrt_ray_queue against two queues, of which the shadow rays' goes first."""

from collections import deque
from random import randrange

import cocotb
from cocotb.triggers import RisingEdge
from streams import drive, reset, start

DEPTH = 16


async def run(dut, clocks, likely):
    """Compare clock by clock; writers hold credits, so none comes to a full queue."""
    queues = deque(), deque()
    for _ in range(clocks):
        shadow, item = randrange(2), randrange(256)
        coming = randrange(4) < likely and len(queues[shadow]) < DEPTH
        going = randrange(4) < 4 - likely
        drive(dut, valid_i=coming, shadow_i=shadow, data_i=item, ready_i=going)
        await RisingEdge(dut.clk_i)
        first = bool(queues[1])
        assert int(dut.valid_o.value) == any(queues)
        if any(queues):
            assert int(dut.shadow_o.value) == first
            assert int(dut.data_o.value) == queues[first][0]
            if going:
                queues[first].popleft()
        if coming:
            queues[shadow].append(item)


@cocotb.test()
@cocotb.parametrize(likely=[1, 2, 3, 4])
async def every_clock_as_two_queues(dut, likely):
    await start(dut, valid_i=0, ready_i=0)
    await run(dut, 600, likely)


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(20):
        await run(dut, randrange(1, 60), 3)
        drive(dut, valid_i=0)
        await reset(dut)
