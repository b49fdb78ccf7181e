"""voxrt_plane_time against Python's product, signed, modulo the width of the time: a new distance each clock."""

import random

import cocotb
from bench_multiply import some_number
from cocotb.triggers import RisingEdge
from streams import drive, start_clock

LATENCY = 3


def some_distance(bits):
    limit = 1 << bits - 1
    return random.choice([-limit, limit - 1, -1, 0, some_number(bits) - limit, -some_number(bits - 1)])


@cocotb.test()
async def times(dut):
    start_clock(dut)
    await RisingEdge(dut.clk_i)
    modulus = 1 << len(dut.time_o)
    on_the_way = [None] * LATENCY
    for _ in range(5000):
        distance, weight = some_distance(len(dut.distance_i)), some_number(len(dut.weight_i))
        drive(dut, distance_i=distance, weight_i=weight)
        await RisingEdge(dut.clk_i)
        if on_the_way[0] is not None:
            assert dut.time_o.value.to_unsigned() == on_the_way[0]
        on_the_way = [*on_the_way[1:], distance * weight % modulus]
