"""voxrt_multiply against Python's product: a new pair each clock."""

import random

import cocotb
from cocotb.triggers import RisingEdge
from streams import drive, start_clock

LATENCY = 2


def some_number(bits):
    size = random.randint(0, bits)
    largest = (1 << bits) - 1
    return random.choice([0, 1, largest, largest >> 1, (1 << size) - 1, 1 << size & largest, random.getrandbits(bits)])


@cocotb.test()
async def products(dut):
    start_clock(dut)
    await RisingEdge(dut.clk_i)
    on_the_way = [None] * LATENCY
    for _ in range(5000):
        a, b = some_number(len(dut.a_i)), some_number(len(dut.b_i))
        drive(dut, a_i=a, b_i=b)
        await RisingEdge(dut.clk_i)
        if on_the_way[0] is not None:
            assert dut.product_o.value.to_unsigned() == on_the_way[0]
        on_the_way = [*on_the_way[1:], a * b]
