"""voxrt_light_direction against whole numbers of any size; while enable_i is low nothing moves."""

import random

import cocotb
from bench_brightness import lit_point, some_place
from cocotb.triggers import RisingEdge
from streams import drive, pace, start_clock
from structs import HIT_POINT, packed_array

DEPTH = 6
FARTHEST = 1 << 20  # The light is -2**20 .. 2**20 - 1, in 1/16 voxel.
LATENCY = 2


def some_hit_point(side):
    """Make one behind any face, those at the world's ends among them."""
    face = random.randrange(3)
    place = some_place(side, face)
    if random.random() < 0.3:
        place = [random.choice([0, 16 * side - 1]) for _ in range(3)]
        place[face] -= place[face] % 16
    return place, random.randrange(8), face


def some_light(side):
    """Make a light: on planes, in the world, at the ends of its range."""
    reach = random.choice([16 * side, FARTHEST])
    return [random.choice([-FARTHEST, FARTHEST - 1, 16 * side, 0, random.randrange(-reach, reach)]) for _ in range(3)]


@cocotb.test()
@cocotb.parametrize(enabled=["always", "random"])
async def exact(dut, enabled):
    drive(dut, enable_i=0)
    start_clock(dut)
    await RisingEdge(dut.clk_i)
    counts = pace(enabled)
    for _ in range(40):
        side = 1 << random.randint(1, DEPTH)
        light = some_light(side)
        drive(dut, side_i=side, light_i=packed_array(light, 32))
        on_the_way = [None] * LATENCY
        for _ in range(60):
            place, mirrored, face = some_hit_point(side)
            counted = next(counts)
            drive(dut, enable_i=counted, hit_point_i=HIT_POINT.pack(point=place, mirrored=mirrored, face=face))
            await RisingEdge(dut.clk_i)
            if on_the_way[0] is not None:
                shown = [[value.to_signed() for value in output.value] for output in (dut.point_o, dut.direction_o)]
                assert shown == on_the_way[0]
            if counted:
                point = lit_point(place, mirrored, face, side)
                direction = [2 * at - own for at, own in zip(light, point, strict=True)]
                on_the_way = [*on_the_way[1:], [point, direction]]
