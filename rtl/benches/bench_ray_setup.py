"""voxrt_ray_setup against rays.py: rays of the camera and shadow rays, one a clock or with idle clocks between."""

import random

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge
from rays import FACE_NONE, aimed_direction, edge_direction, ray_of, some_direction
from streams import drive, pace, reset, start
from structs import DISTANCE, RAY, SHADOW_POINT, WEIGHT, WORLD, packed_array, signed, unpacked_array

LANES, LATENCY = 3, 60
SHADOW_INPUTS = {"shadow_i", "tag_i", "point_i"}
SCAN_BITS = 29  # voxrt_pkg::ScanBits.
KEY_BITS = 51  # voxrt_pkg::key_bits(6, 0).


def some_position(side):
    """Make a camera position, on planes and outside among others."""
    world = 16 * side
    return [
        random.choice([0, world, 16 * random.randint(-side, 2 * side), random.randint(-world, 2 * world)])
        for _ in range(3)
    ]


def some_shadow(side):
    """Make a lit point, 1/32 voxel, on a face, and the direction from there."""
    face = random.randrange(3)
    point = [2 * random.randrange(16 * side) + 1 for _ in range(3)]
    most = (1 << 20) - 1
    direction = [random.choice([0, most, -most, random.randint(-most, most)]) for _ in range(3)]
    point[face] = 32 * random.randint(0, side)
    direction[face] = random.choice([most, random.randint(1, most)]) * (-1 if point[face] == 32 * side else 1)
    return point, direction


def world(position, depth):
    mirrored = [(16 << depth) - place for place in position]
    return WORLD.pack(origin=position, mirrored_origin=mirrored, depth=depth, side=1 << depth)


def seen(dut):
    values = RAY.unpack(dut.ray_o)
    values["origin"] = tuple(signed(value, DISTANCE) for value in values["origin"])
    values["weights"] = tuple(unpacked_array(dut.weights_o.value.to_unsigned(), 3, WEIGHT))
    values["lane"] = dut.lane_o.value.to_unsigned()
    values["overflow"] = int(dut.overflow_o.value)
    return values


async def collect(dut, into):
    while True:
        await RisingEdge(dut.clk_i)
        if int(dut.valid_o.value):
            into.append(seen(dut))


def expected(ray, lane, tag, shadow, key_bits):
    """Give what `seen` shall give; of a resolved ray only what is of use."""
    values = {"lane": lane, "resolved": ray.resolved, "overflow": ray.overflow, "shadow": shadow}
    if shadow:
        values["tag"] = tag
    if ray.resolved:
        return values | ({"lit": not ray.overflow} if shadow else {"pixel": FACE_NONE})
    return values | {
        "mirrored": ray.mirrored,
        "dead": ray.dead,
        "octant": ray.octant,
        "weights": ray.weight,
        "entry_time": ray.entry_time % (1 << key_bits),
        "entry_face": ray.entry_face,
        "origin": ray.origin,
    }


def has_light(dut):
    """Tell whether shadow rays come, too."""
    return hasattr(dut, "Light") and int(dut.Light.value)


def drive_ray(dut, **values):
    """Drive a ray; voxrt_serial_ray_setup has no inputs of shadow rays."""
    drive(dut, **{name: value for name, value in values.items() if has_light(dut) or name not in SHADOW_INPUTS})


async def taken(dut):
    """Wait for the clock edge at which the ray is taken."""
    await RisingEdge(dut.clk_i)
    while not int(dut.ready_o.value):
        await RisingEdge(dut.clk_i)


async def frame(dut, count, kind):
    """Send rays of one frame, and compare."""
    depth = random.randint(1, 6)
    side, position, there = 1 << depth, some_position(1 << depth), pace(kind)
    light = has_light(dut)
    drive(dut, world_i=world(position, depth), root_leaf_i=0, root_material_i=0)
    got, wanted = [], []
    collector = cocotb.start_soon(collect(dut, got))
    while len(wanted) < count:
        if not next(there):
            drive(dut, valid_i=0)
            await RisingEdge(dut.clk_i)
            continue
        lane, tag, shadow = 1 << random.randrange(LANES), random.randrange(256), light and random.random() < 0.3
        away = random.choice([some_direction(), aimed_direction(position, side), edge_direction(position, side)])
        point, direction = some_shadow(side) if shadow else (position, away)
        ray = ray_of(point, direction, side, unit=32 if shadow else 16, inside=shadow)
        wanted.append(expected(ray, lane, tag, shadow, KEY_BITS + light))
        drive_ray(dut, valid_i=1, lane_i=lane, direction_i=direction, shadow_i=shadow, tag_i=tag)
        drive_ray(dut, point_i=packed_array(point if shadow else [0, 0, 0], SHADOW_POINT))
        await taken(dut)
    drive(dut, valid_i=0)
    await ClockCycles(dut.clk_i, LATENCY)
    collector.cancel()
    assert len(got) == count
    for own, other in zip(got, wanted, strict=True):
        assert {name: own[name] for name in other} == other


@cocotb.test()
@cocotb.parametrize(kind=["always", "random"])
async def rays_as_in_whole_numbers(dut, kind):
    await start(dut, valid_i=0)
    for _ in range(30):
        await frame(dut, 60, kind)


@cocotb.test()
async def a_world_of_one_leaf_is_answered(dut):
    """Give the root's material with the face of the entry, to rays that meet the world."""
    await start(dut, valid_i=0)
    drive_ray(dut, world_i=world([-16, 40, 50], 3), root_leaf_i=1, root_material_i=7, shadow_i=0, lane_i=1)
    got = []
    cocotb.start_soon(collect(dut, got))
    for direction in ([9, 1, 1], [-9, 1, 1]):
        drive(dut, valid_i=1, direction_i=direction)
        await taken(dut)
    drive(dut, valid_i=0)
    await ClockCycles(dut.clk_i, LATENCY)
    assert [(ray["resolved"], ray["pixel"]) for ray in got] == [(1, 7 << 2), (1, FACE_NONE)]


@cocotb.test()
async def a_component_of_2_to_20_or_more_is_flagged(dut):
    """Flag the least and the most that does not fit, and every higher power of two, of either sign."""
    await start(dut, valid_i=0)
    drive_ray(dut, world_i=world([40, 40, 50], 3), root_leaf_i=0, root_material_i=0, shadow_i=0, lane_i=1)
    got, wanted = [], []
    cocotb.start_soon(collect(dut, got))
    for size in {(1 << bits) - below for bits in range(19, SCAN_BITS) for below in (0, 1)}:
        for component in (size, -size):
            if component < 1 << (SCAN_BITS - 1):
                wanted.append(int(size >= 1 << 20))
                axis = random.randrange(3)
                drive(dut, valid_i=1, direction_i=[component if a == axis else 3 for a in range(3)])
                await taken(dut)
    drive(dut, valid_i=0)
    await ClockCycles(dut.clk_i, LATENCY)
    assert [ray["overflow"] for ray in got] == wanted


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, valid_i=0)
    for _ in range(5):
        sender = cocotb.start_soon(frame(dut, 40, "random"))
        await ClockCycles(dut.clk_i, random.randrange(1, 60))
        sender.cancel()
        drive(dut, valid_i=0)
        await reset(dut)
        await frame(dut, 20, "random")
