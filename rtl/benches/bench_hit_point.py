"""voxrt_hit_point against exact fractions: rays that hit at any clock, of which some are taken; resets at any clock.

The bench is the ring: a ray's weights are there at stage 3, times and the leaf's size at stage 6, all else at stage 9.
"""

import random
from fractions import Fraction
from math import floor
from typing import NamedTuple

import cocotb
from cocotb.triggers import ClockCycles, FallingEdge, RisingEdge
from rays import ray_of, some_direction
from streams import drive, pace, reset, start
from structs import HIT_POINT, WEIGHT, packed_array, wrapped

STAGES = range(3, 10)


class Hit(NamedTuple):
    """A ray in a leaf, what stages 3, 6 and 9 give of it, and its hit point."""

    weights: tuple
    since: tuple
    size: int
    known: dict
    material: int
    point: list


def some_hit(depth):
    """Make a ray that hits a leaf, from a point of the world, mirrored frame: its key is a plane of the leaf's."""
    side = 1 << depth
    while True:
        size = 1 << random.randrange(depth)
        position = [random.choice([random.randint(-40, 16 * side), 16 * random.randint(0, side)]) for _ in range(3)]
        ray = ray_of(position, [abs(d) for d in some_direction()], side)
        live = [axis for axis in range(3) if not ray.dead >> axis & 1]
        if ray.overflow or not live:
            continue
        axis = random.choice(live)
        corner = [0, 0, 0]
        corner[axis] = size * random.randrange(side // size)
        time = (16 * corner[axis] - position[axis]) * ray.weight[axis]
        point = [sub_cell(position[a], ray, a, (time, axis)) for a in range(3)]
        if all(0 <= at < 16 * side for at in point):
            break
    for a in range(3):
        corner[a] = point[a] // (16 * size) * size
    since = tuple(since_near_plane(position[a], ray, a, corner[a], (time, axis)) for a in range(3))
    known = {"tag": random.randrange(512), "face": axis, "mirrored": random.randrange(8)}
    known["point"] = [16 * low for low in corner]
    return Hit(ray.weight, since, size, known, random.randrange(256), point)


def sub_cell(origin, ray, axis, key):
    """Give the last sub-cell whose lower plane the ray has crossed, by fractions: planes count by (T, axis)."""
    if ray.dead >> axis & 1:
        return origin
    place = origin + Fraction(key[0], ray.weight[axis])
    return floor(place) - (place == floor(place) and axis > key[1])


def since_near_plane(origin, ray, axis, corner, key):
    """Give what has passed since a leaf's near plane; on a dead axis, T is of a plane one before."""
    dead = ray.dead >> axis & 1
    time = (16 * corner - origin - dead) * ray.weight[axis]
    return -1 - time if dead else key[0] - time - (axis > key[1])


class Ring:
    """What is around it: rays that go from stage to stage, and a reorder buffer that takes hit points or not."""

    def __init__(self, dut, hitting, taking):
        self.dut, self.depth = dut, int(dut.MaxDepth.value)
        self.hits, self.takes = pace(hitting), pace(taking)
        self.stages = dict.fromkeys(STAGES)
        self.wanted, self.answers = [], 0

    async def run(self, clocks, *, hit=True):
        dut = self.dut
        for _ in range(clocks):
            coming = some_hit(self.depth) if hit and next(self.hits) else None
            self.stages = {3: coming} | {stage: self.stages[stage - 1] for stage in STAGES[1:]}
            at3, at6, at9 = (self.stages[stage] or some_hit(self.depth) for stage in (3, 6, 9))
            drive(dut, hit3_i=coming is not None, weights3_i=packed_array(at3.weights, WEIGHT), size6_i=at6.size)
            for axis, value in enumerate(at6.since):
                dut.until6_i[axis].value = wrapped(-1 - value, len(dut.until6_i[axis]))
            drive(dut, hit9_i=HIT_POINT.pack(**at9.known), material9_i=at9.material, ready_i=next(self.takes))
            await FallingEdge(dut.clk_i)
            holds = int(dut.holds9_o.value)
            assert not holds or self.stages[9], "a place without a ray"
            takes = holds and random.random() < 0.7
            drive(dut, takes9_i=takes)
            await RisingEdge(dut.clk_i)
            if takes:
                self.wanted.append(at9)
            if int(dut.valid_o.value) and int(dut.ready_i.value):
                wanted = self.wanted.pop(0)
                assert HIT_POINT.unpack(dut.hit_point_o) == wanted.known | {"point": wanted.point}
                assert int(dut.material_o.value) == wanted.material
                self.answers += 1


QUIET = {"hit3_i": 0, "takes9_i": 0, "ready_i": 0}


@cocotb.test()
@cocotb.parametrize(hitting=["always", "random"], taking=["always", "random"])
async def hit_points(dut, hitting, taking):
    await start(dut, **QUIET)
    for _ in range(10):
        ring = Ring(dut, hitting, taking)
        await ring.run(400)
        await ring.run(60, hit=False)
        assert not ring.wanted
        assert ring.answers > 10


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, **QUIET)
    for _ in range(60):
        ring = Ring(dut, "random", "random")
        await ring.run(random.randrange(1, 60))
        drive(dut, **QUIET)
        await reset(dut, clocks=1)
        await ClockCycles(dut.clk_i, random.randrange(1, 30))
        assert not int(dut.valid_o.value)
        assert not int(dut.holds9_o.value)
