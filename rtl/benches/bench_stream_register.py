"""voxrt_stream_register: bytes in, the same bytes out, one per clock."""

import cocotb
from cocotb.triggers import FallingEdge, ReadOnly, Timer
from streams import PACES, check_bytes, check_bytes_after_reset, start


@cocotb.test()
@cocotb.parametrize(**PACES)
async def order(dut, sending, taking):
    await start(dut, valid_i=0, ready_i=0)
    await check_bytes(dut, sending, taking)


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(20):
        await check_bytes_after_reset(dut)


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
