"""voxrt_lane alone: rays of rays.py, a memory that answers or not, pixels against the oracle of docs/shading.md.

With Light or Mirrors also what stands around it for these: shadow rays come back late and go first, and there are few
places for them. A ray's weights are there some time before it is offered, in any free row.
"""

import random
from collections import deque
from fractions import Fraction
from math import floor

import cocotb
import numpy as np
from bench_brightness import ANGLE, LIGHT, MEAN, lit_point
from cocotb.triggers import ClockCycles, RisingEdge
from oracles.memory import words_of
from oracles.ray import FACE_NONE, shade
from oracles.shading import Shader, shaded_pixel
from rays import ray_of, some_direction
from streams import PACES, drive, pace, reset, start

LEAF, DEPTH, ROWS = 1 << 9, 3, 32
SIDE = 1 << DEPTH
MAX_DEPTH, PLACE, SUM, COUNT = 6, 10, 12, 5
MATERIALS = (5, 9, 255)
SHADOW_RAYS = 3
NOTHING = {"arrives_i": 0, "ray_valid_i": 0, "mem_ack_i": 0, "take_ready_i": 0, "table_write_i": 0}


def encoded(word):
    """Give a word as lanes read it."""
    return LEAF | word & 0xFF if word >> 31 else word >> 3


def arrival(ray, row):
    """Give a ray's weights as they come to the lane, before it is offered."""
    return {
        "arrives_i": 1,
        "arrival_row_i": row,
        "arrival_weight_i": [weight % (1 << 40) for weight in ray.weight],
    }


def inputs(dut, ray, row, tag):
    """Give a ray as the lane takes it; a shadow ray has a tag."""
    return {
        "ray_row_i": row,
        "ray_resolved_i": ray.resolved,
        "ray_pixel_i": FACE_NONE,
        "ray_mirrored_i": ray.mirrored,
        "ray_dead_i": ray.dead,
        "ray_octant_i": ray.octant,
        "ray_entry_time_i": ray.entry_time % (1 << len(dut.ray_entry_time_i)),
        "ray_entry_face_i": ray.entry_face,
        "ray_origin_i": [place % (1 << len(dut.ray_origin_i[0])) for place in ray.origin],
        "ray_tag_i": tag,
        "ray_lit_i": 1,
    }


class Surroundings:
    """Memory, pixel buffer, free rows, queues of rays and the maker of shadow rays."""

    def __init__(self, dut, words, shader, rays, hurry=0.1):
        self.dut, self.shader, self.hurry = dut, shader, hurry
        self.words = [encoded(int(word)) for word in words]
        self.asked = deque([None] * (int(dut.MemoryClocks.value) - 1))
        self.coming, self.ordered, self.places = deque((ray, 0) for ray in rays), deque(), SHADOW_RAYS
        self.rays, self.shadow_rays = deque(), deque()  # That wait.
        self.free_rows = list(range(ROWS))
        self.offers = False
        self.stored, self.lit = [], {}
        self.errors = 0

    async def run(self, sending, taking):
        """Serve for ever."""
        dut = self.dut
        sends, has_place, acknowledges = pace(sending), pace(taking), pace(taking)
        while True:
            drive(dut, take_ready_i=next(has_place), take_tag_i=len(self.stored) % 256)
            drive(dut, request_ready_i=self.places > 0)
            shadow = bool(self.shadow_rays)
            self.offers = self.offers or (bool(self.rays) and bool(next(sends)))
            waiting = self.shadow_rays if shadow else self.rays
            if shadow or self.offers:
                drive(dut, **waiting[0])
            drive(dut, ray_valid_i=shadow or self.offers, ray_shadow_i=shadow)
            self.arrive()
            await RisingEdge(dut.clk_i)
            taken = int(dut.ray_ready_o.value)
            if taken:
                waiting.popleft()
                self.offers &= shadow
            assert int(dut.take_o.value) == (taken and not shadow)
            if int(dut.take_o.value):
                assert int(dut.take_ready_i.value)
                self.stored.append(None)
            self.fill()
            self.release()
            self.order(taken and shadow)
            self.errors += int(dut.bad_pointer_o.value) + int(dut.step_limit_o.value)
            self.answer(acknowledges)

    def arrive(self):
        """Let a ray come, which is offered some time later: a shadow ray, or one that leaves rows for these."""
        ray = None
        if self.ordered and random.random() < self.hurry:
            (ray, tag), waiting = self.ordered.popleft(), self.shadow_rays
        elif self.coming and len(self.free_rows) > SHADOW_RAYS and random.random() < 0.9:
            (ray, tag), waiting = self.coming.popleft(), self.rays
        drive(self.dut, arrives_i=0)
        if ray is not None:
            row = self.free_rows.pop(random.randrange(len(self.free_rows)))
            drive(self.dut, **arrival(ray, row))
            waiting.append(inputs(self.dut, ray, row, tag))

    def release(self):
        """Take rows back."""
        if int(self.dut.releases_o.value):
            row = self.dut.released_row_o.value.to_unsigned()
            assert row not in self.free_rows, "released twice"
            self.free_rows.append(row)

    def fill(self):
        """Keep what comes for the pixel buffer."""
        dut = self.dut
        tag = dut.fill_tag_o.value.to_unsigned()
        if int(dut.store_o.value):
            assert self.stored[tag] is None, "stored twice"
            self.stored[tag] = dut.store_pixel_o.value.to_unsigned()
        if int(dut.fill_o.value):
            assert self.stored[tag] is not None
            assert tag not in self.lit, "filled twice"
            self.lit[tag] = int(dut.fill_lit_o.value)

    def order(self, starts):
        """Make shadow rays of sub-cells, sooner or later."""
        dut = self.dut
        requests = int(dut.request_o.value)
        self.places += starts - requests
        assert self.places >= 0, "a shadow ray without a place"
        if requests:
            tag, face = dut.request_tag_o.value.to_unsigned(), dut.request_face_o.value.to_unsigned()
            mirrored = dut.request_mirrored_o.value.to_unsigned()
            place = [value.to_unsigned() for value in dut.request_place_o.value]
            assert self.stored[tag] % 4 == face
            assert sub_cell(self.stored[tag]) == (place, mirrored)
            point = lit_point(place, mirrored, face, SIDE)
            way = [2 * at - own for at, own in zip(self.shader.light, point, strict=True)]
            self.ordered.append((ray_of(point, way, SIDE, unit=32, inside=True), tag))

    def answer(self, acknowledges):
        """Give a word of before, or none."""
        dut = self.dut
        self.asked.append(None)
        if int(dut.mem_read_o.value):
            address = 1 + 8 * dut.mem_block_o.value.to_unsigned() + dut.mem_octant_o.value.to_unsigned()
            self.asked[-1] = self.words[address]
        word = self.asked.popleft()
        answers = word is not None and next(acknowledges)
        drive(dut, mem_ack_i=answers, mem_word_i=word if answers else random.randrange(1 << 10))

    def pixel(self, tag, direction):
        """Give (colour, material, face), as a shader would with what was stored."""
        stored = self.stored[tag]
        face, material, detail = stored % 4, stored >> 2 & 0xFF, stored >> 10
        colour = self.shader.palette[material]
        kind = stored >> len(self.dut.store_pixel_o) - 2 if len(self.dut.store_pixel_o) > 10 else ANGLE
        if kind == ANGLE:
            return tuple(colour) if self.shader.flat else shade(colour, direction, face), material, face
        if kind == MEAN:
            count = detail % (1 << COUNT)
            sums = [detail >> COUNT + SUM * channel & (1 << SUM) - 1 for channel in range(3)]
            return tuple(floor(Fraction(total, count) + Fraction(1, 2)) for total in sums), material, face
        assert kind == LIGHT
        part = Fraction(self.shader.ambient, 256)
        if self.lit[tag]:
            point = lit_point(*sub_cell(stored), face, SIDE)
            way = [2 * at - own for at, own in zip(self.shader.light, point, strict=True)]
            part = Fraction(1) if self.shader.flat else max(part, Fraction(way[face] ** 2, sum(d * d for d in way)))
        return tuple(floor(channel * part + Fraction(1, 2)) for channel in colour), material, face


def sub_cell(stored):
    """Give the sub-cell of a pixel that is lit, and the mirrored axes."""
    detail = stored >> 10
    place = [detail >> PLACE * axis & (1 << PLACE) - 1 for axis in range(3)]
    return place, detail >> 3 * PLACE & 7


def some_world(leaves):
    """Make a world; where the lane goes into a root that is a leaf, sometimes such a one."""
    if leaves and random.random() < 0.1:
        return np.full((SIDE,) * 3, random.choice([0, *MATERIALS]), np.uint8)
    materials = [0] * random.choice([2, 6, 12, 40]) + [*MATERIALS]
    return np.random.default_rng(random.randrange(1 << 30)).choice(materials, (SIDE,) * 3).astype(np.uint8)


def some_place():
    """Make a position in the world or around it, on planes among others."""
    if random.random() < 0.5:
        return [random.choice([16 * random.randint(0, SIDE), random.randint(0, 16 * SIDE)]) for _ in range(3)]
    return [random.choice([16 * random.randint(-4, 12), random.randint(-200, 300)]) for _ in range(3)]


def into_the_world(position):
    """Make a direction from there to somewhere in the world."""
    return [random.randint(0, 16 * SIDE) - place for place in position]


async def some_shader(dut):
    """Set what a frame's shading is, of what is built in; give the same to the oracle."""
    palette = [[random.choice([0, 255, random.randrange(256)]) for _ in range(3)] for _ in range(256)]
    shader = Shader(palette, flat=random.random() < 0.3)
    if int(dut.Mirrors.value):
        shader.bounces = random.choice([0, 1, 1, 3, 15])
        shader.mirrors = frozenset(random.choice([[5], [5, 9], [*MATERIALS]]))
        for material in MATERIALS:
            red, green, blue = palette[material]
            row = (material in shader.mirrors) << 24 | red << 16 | green << 8 | blue
            drive(dut, table_write_i=1, table_material_i=material, table_row_i=row)
            await RisingEdge(dut.clk_i)
        drive(dut, table_write_i=0)
    if int(dut.Light.value) and random.random() < 0.8:
        set_light(dut, shader, some_place())
    drive(dut, light_i=shader.light is not None, bounces_i=shader.bounces)
    return shader


def set_light(dut, shader, light):
    """Set where the light is, among the planes, and how bright it is in shadow."""
    shader.light, shader.ambient = light, random.choice([0, random.randrange(100)])
    for mirrored in range(2):
        for axis, place in enumerate(light):
            own = 16 * SIDE - place if mirrored else place
            dut.before_light_i[mirrored][axis].value = sum(16 * plane < own for plane in range(SIDE))
            dut.to_light_i[mirrored][axis].value = sum(16 * plane <= own for plane in range(SIDE))


async def frame(dut, count, sending, taking):
    """Trace rays from one position, and compare."""
    shader = await some_shader(dut)
    voxels = some_world(int(dut.Light.value) or int(dut.Mirrors.value))
    position = some_place()
    directions = [random.choice([some_direction(), into_the_world(position)]) for _ in range(count)]
    await trace(dut, (voxels, shader, position, directions), sending, taking)


async def trace(dut, scene, sending, taking, **hurry):
    """Trace all rays of a scene, and compare."""
    voxels, shader, position, directions = scene
    words = words_of(voxels)
    rays = [ray_of(position, direction, SIDE) for direction in directions]
    drive(dut, world_i=SIDE, beyond_i=(1 << MAX_DEPTH) - SIDE, root_i=encoded(int(words[0])))
    drive(dut, origin_i=position, mirrored_origin_i=[16 * SIDE - place for place in position])
    surroundings = Surroundings(dut, words, shader, rays, **hurry)
    runner = cocotb.start_soon(surroundings.run(sending, taking))
    try:
        for _ in range(500):
            if len(surroundings.lit) == len(rays):
                break
            await ClockCycles(dut.clk_i, 50)
    finally:
        runner.cancel()
    drive(dut, ray_valid_i=0)
    assert len(surroundings.lit) == len(rays)
    for tag, (ray, direction) in enumerate(zip(rays, directions, strict=True)):
        background = tuple(shader.palette[0]), 0, FACE_NONE
        wanted = background if ray.overflow else shaded_pixel(voxels, shader, position, direction)
        assert surroundings.pixel(tag, direction) == wanted, (position, direction)
    assert not surroundings.errors
    assert len(surroundings.free_rows) == ROWS


async def begin(dut):
    """Start with nothing to do."""
    await start(dut, ray_shadow_i=0, request_ready_i=0, **NOTHING)


@cocotb.test()
@cocotb.parametrize(**PACES)
async def pixels(dut, sending, taking):
    """Random worlds and troublesome rays; words that do not come, pixel buffers that are full."""
    await begin(dut)
    for _ in range(8):
        await frame(dut, 60, sending, taking)


@cocotb.test()
async def all_slots_ask_for_a_shadow_ray(dut):
    """Shadow rays come when no slot is free, and there are no places for others: a ray that asks makes way."""
    await begin(dut)
    shader = await some_shader(dut)
    voxels = np.zeros((SIDE,) * 3, np.uint8)
    voxels[:, :, SIDE // 2 :] = MATERIALS[-1]
    position = [8 * SIDE, 8 * SIDE, -16]
    if int(dut.Light.value):
        set_light(dut, shader, position)
        drive(dut, light_i=1)
    directions = [[random.randint(-20, 20), random.randint(-20, 20), 60] for _ in range(60)]
    await trace(dut, (voxels, shader, position, directions), "always", "always", hurry=0.01)


@cocotb.test()
async def reset_at_any_clock(dut):
    """Drop all rays."""
    await begin(dut)
    for _ in range(8):
        running = cocotb.start_soon(frame(dut, 60, "random", "random"))
        await ClockCycles(dut.clk_i, random.randrange(1, 400))
        running.cancel()
        drive(dut, **NOTHING)
        await reset(dut)
        await ClockCycles(dut.clk_i, 3)
        assert not int(dut.mem_read_o.value)
        assert not int(dut.fill_o.value)
        await frame(dut, 30, "random", "random")
