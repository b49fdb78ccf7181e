"""voxrt_ray_setup against rays.py: rays of the camera and shadow rays, one a clock or with idle clocks between."""

import random

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge
from rays import FACE_NONE, ray_of, some_direction
from streams import drive, pace, reset, start

LANES, LATENCY = 3, 40
FLAGS = ("resolved_o", "overflow_o", "shadow_o")
NUMBERS = ("lane_o", "pixel_o", "mirrored_o", "dead_o", "octant_o", "entry_time_o", "entry_face_o", "tag_o")


def some_position(side):
    """Make a camera position, on planes and outside among others."""
    world = 16 * side
    return [
        random.choice([0, world, 16 * random.randint(-side, 2 * side), random.randint(-world, 2 * world)])
        for _ in range(3)
    ]


def some_shadow(side):
    """Make a lit point, 1/32 voxel, on a face, and the way from there."""
    face = random.randrange(3)
    point = [2 * random.randrange(16 * side) + 1 for _ in range(3)]
    way = [random.choice([0, random.randint(-(1 << 20) + 1, (1 << 20) - 1)]) for _ in range(3)]
    point[face] = 32 * random.randint(0, side)
    way[face] = random.randint(1, 1 << 19) * (-1 if point[face] == 32 * side else 1)
    return point, way


def seen(dut):
    """Read what stands at the outputs."""
    values = {name: int(getattr(dut, name).value) for name in FLAGS}
    values |= {name: getattr(dut, name).value.to_unsigned() for name in NUMBERS}
    values["weight_o"] = tuple(value.to_unsigned() for value in dut.weight_o.value)
    values["origin_o"] = tuple(value.to_signed() for value in dut.origin_o.value)
    return values


async def collect(dut, into):
    """Collect rays."""
    while True:
        await RisingEdge(dut.clk_i)
        if int(dut.valid_o.value):
            into.append(seen(dut))


def expected(dut, ray, lane, tag, shadow):
    """Give what `seen` shall give; of a resolved ray only what is of use."""
    values = {"lane_o": lane, "resolved_o": ray.resolved, "overflow_o": ray.overflow, "shadow_o": shadow}
    if shadow:
        values["tag_o"] = tag
    if ray.resolved:
        return values | ({} if shadow else {"pixel_o": FACE_NONE})
    return values | {
        "mirrored_o": ray.mirrored,
        "dead_o": ray.dead,
        "octant_o": ray.octant,
        "weight_o": ray.weight,
        "entry_time_o": ray.entry_time % (1 << len(dut.entry_time_o)),
        "entry_face_o": ray.entry_face,
        "origin_o": ray.origin,
    }


async def frame(dut, count, kind):
    """Send rays of one frame, and compare."""
    depth = random.randint(1, 6)
    side, position, there = 1 << depth, some_position(1 << depth), pace(kind)
    drive(dut, depth_i=depth, world_i=side, root_leaf_i=0, root_material_i=0)
    drive(dut, origin_i=position, mirrored_origin_i=[16 * side - place for place in position])
    got, wanted = [], []
    collector = cocotb.start_soon(collect(dut, got))
    while len(wanted) < count:
        if not next(there):
            drive(dut, valid_i=0)
            await RisingEdge(dut.clk_i)
            continue
        lane, tag, shadow = 1 << random.randrange(LANES), random.randrange(256), random.random() < 0.3
        point, direction = some_shadow(side) if shadow else (position, some_direction())
        ray = ray_of(point, direction, side, unit=32 if shadow else 16, inside=shadow)
        wanted.append(expected(dut, ray, lane, tag, shadow))
        drive(dut, valid_i=1, lane_i=lane, direction_i=direction, shadow_i=shadow, tag_i=tag)
        drive(dut, lit_i=point if shadow else [0, 0, 0])
        await RisingEdge(dut.clk_i)
    drive(dut, valid_i=0)
    await ClockCycles(dut.clk_i, LATENCY)
    collector.cancel()
    assert len(got) == count
    for own, other in zip(got, wanted, strict=True):
        assert {name: own[name] for name in other} == other


@cocotb.test()
@cocotb.parametrize(kind=["always", "random"])
async def rays_as_in_whole_numbers(dut, kind):
    """Many cameras and worlds."""
    await start(dut, valid_i=0)
    for _ in range(30):
        await frame(dut, 60, kind)


@cocotb.test()
async def a_world_of_one_leaf_is_answered(dut):
    """Give the root's material with the face of the entry, to rays that meet the world."""
    await start(dut, valid_i=0)
    drive(dut, depth_i=3, world_i=8, root_leaf_i=1, root_material_i=7, shadow_i=0, lane_i=1)
    drive(dut, origin_i=[-16, 40, 50], mirrored_origin_i=[144, 88, 78])
    got = []
    cocotb.start_soon(collect(dut, got))
    for direction in ([9, 1, 1], [-9, 1, 1]):
        drive(dut, valid_i=1, direction_i=direction)
        await RisingEdge(dut.clk_i)
    drive(dut, valid_i=0)
    await ClockCycles(dut.clk_i, LATENCY)
    assert [(ray["resolved_o"], ray["pixel_o"]) for ray in got] == [(1, 7 << 2), (1, FACE_NONE)]


@cocotb.test()
async def reset_at_any_clock(dut):
    """Drop what is on its way."""
    await start(dut, valid_i=0)
    for _ in range(5):
        sender = cocotb.start_soon(frame(dut, 40, "random"))
        await ClockCycles(dut.clk_i, random.randrange(1, 60))
        sender.cancel()
        drive(dut, valid_i=0)
        await reset(dut)
        await frame(dut, 20, "random")
