"""voxrt_lane alone: rays of rays.py, a memory that answers or not, pixels against the oracle of docs/shading.md.

With Light or Mirrors also what is around it for these: shadow rays come back late and go first, and there are few
credits for them. The weights of a ray come some time before it, into any free row.
"""

import random
from collections import deque
from fractions import Fraction
from math import floor

import cocotb
import numpy as np
from bench_brightness import ANGLE, LIGHT, MEAN, lit_point, mirrored_at
from cocotb.triggers import ClockCycles, RisingEdge
from oracles.memory import words_of
from oracles.ray import FACE_NONE, first_cell, shade
from oracles.shading import Shader, shaded_pixel, sub_cell, walk
from rays import bits, ray_of, some_direction, tied_direction
from streams import PACES, drive, pace, reset, start
from structs import HIT_POINT, LIGHT_PLANES, MATERIAL_WRITE, RAY, RESULT, ROW_FREE, SHADING, WEIGHTS_WRITE, WORLD

LEAF = 1 << 9
MAX_DEPTH, PLACE, SUM, COUNT = 6, 10, 12, 5
MATERIALS = (5, 9, 255)
SHADOW_RAYS = 3
SMALL = 8  # Voxels per side of most worlds.
# Materials of voxels whose words are wrong, and the words that lanes read there.
BAD_POINTER, TOO_DEEP = 77, 78
WRONG = {BAD_POINTER: LEAF | 1 << 8, TOO_DEEP: 0}
NOTHING = {"weights_write_i": 0, "ray_valid_i": 0, "mem_ack_i": 0, "allocate_ready_i": 0, "material_write_i": 0}


def encoded(word):
    """Give a word as lanes read it."""
    return WRONG.get(word & 0xFF, LEAF | word & 0xFF) if word >> 31 else word >> 3


def inputs(ray, row, tag, *, shadow):
    """Give a ray as the lane takes it; a shadow ray has a tag."""
    packed = RAY.pack(
        resolved=ray.resolved,
        pixel=FACE_NONE,
        lit=1,
        shadow=shadow,
        tag=tag,
        mirrored=ray.mirrored,
        dead=ray.dead,
        octant=ray.octant,
        entry_time=ray.entry_time,
        entry_face=ray.entry_face,
        origin=ray.origin,
    )
    return {"ray_row_i": row, "ray_i": packed}


class Surroundings:
    """Memory, reorder buffer, free rows, queues of rays and the maker of shadow rays."""

    def __init__(self, dut, world, shader, rays, *, hurry=0.1):
        self.side, words = world
        self.dut, self.shader, self.hurry = dut, shader, hurry
        self.words = [encoded(int(word)) for word in words]
        self.answers = deque([None] * (int(dut.MemoryClocks.value) - 1))
        self.coming, self.ordered, self.credits = deque((ray, 0) for ray in rays), deque(), SHADOW_RAYS
        self.rays, self.shadow_rays = deque(), deque()  # That wait.
        self.free_rows = list(range(1 << len(dut.ray_row_i)))
        self.offers = False
        self.stored, self.hit_points, self.lit = [], {}, {}
        self.errors = [0, 0]  # Bad pointers, pointers of voxels.

    async def run(self, sending, taking):
        dut = self.dut
        sends, allocatable, acknowledges = pace(sending), pace(taking), pace(taking)
        while True:
            drive(dut, allocate_ready_i=next(allocatable), allocate_tag_i=len(self.stored) % 256)
            drive(dut, hit_point_ready_i=self.credits > 0)
            shadow = bool(self.shadow_rays)
            self.offers = self.offers or (bool(self.rays) and bool(next(sends)))
            waiting = self.shadow_rays if shadow else self.rays
            if shadow or self.offers:
                drive(dut, **waiting[0])
            drive(dut, ray_valid_i=shadow or self.offers)
            self.arrive()
            await RisingEdge(dut.clk_i)
            taken = int(dut.ray_ready_o.value)
            if taken:
                waiting.popleft()
                self.offers &= shadow
            assert int(dut.allocate_o.value) == (taken and not shadow)
            if int(dut.allocate_o.value):
                assert int(dut.allocate_ready_i.value)
                self.stored.append(None)
            self.complete()
            self.release()
            self.order(taken and shadow)
            self.errors[0] += int(dut.bad_pointer_o.value)
            self.errors[1] += int(dut.step_limit_o.value)
            self.answer(acknowledges)

    def arrive(self):
        """Let a ray come, which is offered some time later: a shadow ray, or one that leaves rows for these."""
        ray = None
        if self.ordered and random.random() < self.hurry:
            (ray, tag), waiting = self.ordered.popleft(), self.shadow_rays
        elif self.coming and len(self.free_rows) > SHADOW_RAYS and random.random() < 0.9:
            (ray, tag), waiting = self.coming.popleft(), self.rays
        drive(self.dut, weights_write_i=0)
        if ray is not None:
            row = self.free_rows.pop(random.randrange(len(self.free_rows)))
            drive(self.dut, weights_write_i=WEIGHTS_WRITE.pack(valid=1, row=row, weights=ray.weight))
            waiting.append(inputs(ray, row, tag, shadow=waiting is self.shadow_rays))

    def release(self):
        freed = ROW_FREE.unpack(self.dut.row_free_o)
        if freed["valid"]:
            assert freed["row"] not in self.free_rows, "freed twice"
            self.free_rows.append(freed["row"])

    def complete(self):
        result = RESULT.unpack(self.dut.result_o)
        tag = result["tag"]
        if result["store"]:
            assert self.stored[tag] is None, "stored twice"
            self.stored[tag] = self.dut.result_pixel_o.value.to_unsigned()
        if result["complete"]:
            assert self.stored[tag] is not None
            assert tag not in self.lit, "completed twice"
            self.lit[tag] = result["lit"]

    def order(self, issues):
        """Make shadow rays of hit points, sooner or later."""
        claims = int(self.dut.hit_point_claim_o.value)
        self.credits += issues - claims
        assert self.credits >= 0, "a shadow ray without a credit"
        if int(self.dut.hit_point_valid_o.value):
            hit = HIT_POINT.unpack(self.dut.hit_point_o)
            tag, face, mirrored, place = hit["tag"], hit["face"], hit["mirrored"], hit["point"]
            assert self.stored[tag] % 4 == face
            assert hit_point(self.stored[tag]) == (place, mirrored)
            self.hit_points[tag] = place, mirrored
            point = lit_point(place, mirrored, face, self.side)
            direction = [2 * at - own for at, own in zip(self.shader.light, point, strict=True)]
            towards = direction[face] if mirrored >> face & 1 else -direction[face]
            assert towards > 0, "a back face needs no shadow ray"
            self.ordered.append((ray_of(point, direction, self.side, unit=32, inside=True), tag))

    def answer(self, acknowledges):
        """Give a word of before, or none."""
        dut = self.dut
        self.answers.append(None)
        if int(dut.mem_read_o.value):
            self.answers[-1] = self.words[1 + dut.mem_address_o.value.to_unsigned()]
        word = self.answers.popleft()
        answers = word is not None and next(acknowledges)
        drive(dut, mem_ack_i=answers, mem_word_i=word if answers else random.randrange(1 << 10))

    def pixel(self, tag, direction):
        """Give (colour, material, face), as a shader would with what was stored."""
        stored = self.stored[tag]
        face, material, detail = stored % 4, stored >> 2 & 0xFF, stored >> 10
        colour = self.shader.palette[material]
        kind = stored >> len(self.dut.result_pixel_o) - 2 if len(self.dut.result_pixel_o) > 10 else ANGLE
        if kind == ANGLE:
            return self.by_face_or_angle(colour, direction, face, detail), material, face
        if kind == MEAN:
            count = detail % (1 << COUNT)
            sums = [detail >> COUNT + SUM * channel & (1 << SUM) - 1 for channel in range(3)]
            return tuple(floor(Fraction(total, count) + Fraction(1, 2)) for total in sums), material, face
        assert kind == LIGHT
        part = Fraction(self.shader.ambient, 256)
        if self.lit[tag]:
            point = lit_point(*hit_point(stored), face, self.side)
            direction = [2 * at - own for at, own in zip(self.shader.light, point, strict=True)]
            square, total = direction[face] ** 2, sum(d * d for d in direction)
            part = max(part, Fraction(square, total))
        if self.shader.flat or self.shader.faces:
            own = self.of_face(face, hit_point(stored)[1])
            part = own if self.lit[tag] else own * Fraction(self.shader.ambient, 256)
        return tuple(floor(channel * part + Fraction(1, 2)) for channel in colour), material, face

    def by_face_or_angle(self, colour, direction, face, detail):
        """Give the colour of a pixel that is not lit; where rays are mirrored, `detail` has on which axes."""
        if face == FACE_NONE or not (self.shader.flat or self.shader.faces):
            return shade(colour, direction, face)
        mirrored = sum((d < 0) << axis for axis, d in enumerate(direction))
        if len(self.dut.result_pixel_o) > 10:
            mirrored = detail >> mirrored_at(self.dut)
        part = self.of_face(face, mirrored)
        return tuple(floor(channel * part + Fraction(1, 2)) for channel in colour)

    def of_face(self, face, mirrored):
        return Fraction(1) if self.shader.flat else Fraction(self.shader.faces[2 * face + (mirrored >> face & 1)], 255)


def hit_point(stored):
    detail = stored >> 10
    place = [detail >> PLACE * axis & (1 << PLACE) - 1 for axis in range(3)]
    return place, detail >> 3 * PLACE & 7


def exact_hit_point(voxels, position, direction):
    """Give a hit point, 1/16 voxel, and which axes are mirrored: the point is in that frame."""
    origin = [Fraction(place, 16) for place in position]
    cell = [first_cell(at, d) for at, d in zip(origin, direction, strict=True)]
    _, face, _, t = walk(voxels, origin, direction, cell)
    crossed = [16 * (at + t * d) for at, d in zip(origin, direction, strict=True)]
    place = [sub_cell(at, d, axis, face) for axis, (at, d) in enumerate(zip(crossed, direction, strict=True))]
    place[face] = crossed[face]
    mirrored = [d < 0 for d in direction]
    last = [16 * len(voxels) - (axis != face) for axis in range(3)]
    return [end - at if flips else at for end, at, flips in zip(last, place, mirrored, strict=True)], bits(mirrored)


def some_world(leaves):
    """Make a world; where the lane goes into a root that is a leaf, sometimes such a one."""
    if leaves and random.random() < 0.1:
        return np.full((SMALL,) * 3, random.choice([0, *MATERIALS]), np.uint8)
    materials = [0] * random.choice([2, 6, 12, 40]) + [*MATERIALS]
    return np.random.default_rng(random.randrange(1 << 30)).choice(materials, (SMALL,) * 3).astype(np.uint8)


def deep_world():
    """Make a world of all levels: large octants, and some voxels that differ from them."""
    chance, large = np.random.default_rng(random.randrange(1 << 30)), 4
    octants = chance.choice([0] * random.choice([6, 20]) + [*MATERIALS], (large,) * 3).astype(np.uint8)
    voxels = np.kron(octants, np.ones(((1 << MAX_DEPTH) // large,) * 3, np.uint8))
    for place in chance.integers(0, 1 << MAX_DEPTH, (30, 3)):
        voxels[tuple(place)] = chance.choice([0, *MATERIALS])
    return voxels


def some_place(side):
    if random.random() < 0.5:
        return [random.choice([16 * random.randint(0, side), random.randint(0, 16 * side)]) for _ in range(3)]
    return [
        random.choice([16 * random.randint(-side // 2, 3 * side // 2), random.randint(-25 * side, 38 * side)])
        for _ in range(3)
    ]


def beside():
    """Give how far before a wall a light is, 1/16 voxel; or, below 0, behind it."""
    return random.randint(*random.choice([(0, 16), (0, 16), (-16, 0)]))


def into_the_world(position, side):
    """Make a direction from there to somewhere in the world."""
    return [random.randint(0, 16 * side) - place for place in position]


async def some_shader(dut, side):
    """Set what a frame's shading is, of what is built in; give the same to the oracle."""
    palette = [[random.choice([0, 255, random.randrange(256)]) for _ in range(3)] for _ in range(256)]
    for material in MATERIALS:  # A black one would hide its light.
        palette[material][random.randrange(3)] = 255
    faces = tuple(random.randrange(256) for _ in range(6)) if random.random() < 0.5 else None
    shader = Shader(palette, flat=random.random() < 0.3, faces=faces)
    if int(dut.Mirrors.value):
        shader.bounces = random.choice([0, 1, 1, 3, 15])
        shader.mirrors = frozenset(random.choice([[5], [5, 9], [*MATERIALS]]))
        for material in MATERIALS:
            red, green, blue = palette[material]
            entry = {"mirror": material in shader.mirrors, "red": red, "green": green, "blue": blue}
            drive(dut, material_write_i=MATERIAL_WRITE.pack(valid=1, material=material, **entry))
            await RisingEdge(dut.clk_i)
        drive(dut, material_write_i=0)
    if int(dut.Light.value) and random.random() < 0.8:
        set_light(dut, side, shader, some_place(side))
    drive(dut, shading_i=SHADING.pack(light=shader.light is not None, bounces=shader.bounces))
    return shader


def set_light(dut, side, shader, light):
    shader.light, shader.ambient = light, random.choice([0, random.randrange(100)])
    places = [*light, *(16 * side - place for place in light)]
    occluder = [sum(16 * plane < place for plane in range(side)) for place in places]
    backface = [sum(16 * plane <= place for plane in range(side)) for place in places]
    drive(dut, light_planes_i=LIGHT_PLANES.pack(occluder=occluder, backface=backface))


async def frame(dut, count, sending, taking, *, deep=False):
    voxels = deep_world() if deep else some_world(int(dut.Light.value) or int(dut.Mirrors.value))
    side = len(voxels)
    shader = await some_shader(dut, side)
    position = some_place(side)
    directions = [random.choice([some_direction(), into_the_world(position, side)]) for _ in range(count)]
    await trace(dut, (voxels, shader, position, directions), sending, taking)


async def trace(dut, scene, sending, taking, **hurry):
    voxels, shader, position, directions = scene
    side, words = len(voxels), words_of(voxels)
    rays = [ray_of(position, direction, side) for direction in directions]
    world = WORLD.pack(
        origin=position,
        mirrored_origin=[16 * side - place for place in position],
        depth=side.bit_length() - 1,
        side=side,
        outside_mask=(1 << MAX_DEPTH) - side,
    )
    drive(dut, world_i=world, root_i=encoded(int(words[0])))
    surroundings = Surroundings(dut, (side, words), shader, rays, **hurry)
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
    errors = [0, 0]
    for tag, (ray, direction) in enumerate(zip(rays, directions, strict=True)):
        background = tuple(shader.palette[0]), 0, FACE_NONE
        wanted = background if ray.overflow else shaded_pixel(voxels, shader, position, direction)
        if wanted[1] in WRONG:
            errors[wanted[1] == TOO_DEEP] += 1
            wanted = background
        assert surroundings.pixel(tag, direction) == wanted, (position, direction)
        if tag in surroundings.hit_points and not shader.bounces:
            assert surroundings.hit_points[tag] == exact_hit_point(voxels, position, direction)
    assert surroundings.errors == errors
    assert len(surroundings.free_rows) == 1 << len(dut.ray_row_i)


async def begin(dut):
    await start(dut, hit_point_ready_i=0, **NOTHING)


@cocotb.test()
@cocotb.parametrize(**PACES)
async def pixels(dut, sending, taking):
    await begin(dut)
    for _ in range(8):
        await frame(dut, 60, sending, taking)


@cocotb.test()
async def pixels_of_all_levels(dut):
    await begin(dut)
    for _ in range(6):
        await frame(dut, 60, "always", "random", deep=True)


@cocotb.test()
async def pixels_of_tied_planes(dut):
    """Rays of all lengths that cross planes at once, in worlds of all sizes."""
    await begin(dut)
    for side in (2, 4, SMALL, *[1 << MAX_DEPTH] * 7):
        cells = min(side, SMALL)
        voxels = np.kron(some_world(leaves=False)[:cells, :cells, :cells], np.ones((side // cells,) * 3, np.uint8))
        position = some_place(side)
        directions = [tied_direction(position, side, apart=side // cells) for _ in range(60)]
        await trace(dut, (voxels, await some_shader(dut, side), position, directions), "always", "always")


@cocotb.test()
async def rooms_with_a_lamp(dut):
    """Rays from within a room to its walls; shadow rays pass the light, and hit what is behind it.

    The light is in the middle, or near walls: before them, or behind.
    """
    await begin(dut)
    for side in [SMALL, 1 << MAX_DEPTH] * 3 if int(dut.Light.value) else []:
        walls = [[side // SMALL * plane for plane in sorted(random.sample(range(SMALL + 1), 2))] for _ in range(3)]
        voxels = np.full((side,) * 3, MATERIALS[-1], np.uint8)
        voxels[tuple(slice(*pair) for pair in walls)] = 0
        position = [random.randint(16 * low, 16 * high) for low, high in walls]
        light = [random.choice([16 * low + beside(), 16 * high - beside(), 8 * (low + high)]) for low, high in walls]
        shader = await some_shader(dut, side)
        set_light(dut, side, shader, light)
        drive(dut, shading_i=SHADING.pack(light=1, bounces=shader.bounces))
        directions = [into_the_world(position, side) for _ in range(60)]
        await trace(dut, (voxels, shader, position, directions), "always", "always")


@cocotb.test()
async def wrong_words_end_rays(dut):
    """Count pointers that were refused, and pointers of voxels; rays that read one show the background."""
    await begin(dut)
    for _ in range(3):
        voxels = some_world(leaves=False)
        voxels[::2, ::2, ::2] = 0
        corners = np.random.default_rng(random.randrange(1 << 30)).choice([0, 0, *MATERIALS, *WRONG], (SMALL // 2,) * 3)
        voxels[1::2, 1::2, 1::2] = corners
        shader, position = await some_shader(dut, SMALL), some_place(SMALL)
        shader.light, shader.bounces = None, 0
        drive(dut, shading_i=0)
        directions = [into_the_world(position, SMALL) for _ in range(60)]
        await trace(dut, (voxels, shader, position, directions), "random", "random")


@cocotb.test()
async def all_slots_ask_for_a_shadow_ray(dut):
    """Shadow rays come when no slot is free, and there are no credits for others: a ray that hits gives its slot up."""
    await begin(dut)
    shader = await some_shader(dut, SMALL)
    voxels = np.zeros((SMALL,) * 3, np.uint8)
    voxels[:, :, SMALL // 2 :] = MATERIALS[-1]
    position = [8 * SMALL, 8 * SMALL, -16]
    if int(dut.Light.value):
        set_light(dut, SMALL, shader, position)
        drive(dut, shading_i=SHADING.pack(light=1, bounces=shader.bounces))
    directions = [[random.randint(-20, 20), random.randint(-20, 20), 60] for _ in range(60)]
    await trace(dut, (voxels, shader, position, directions), "always", "always", hurry=0.01)


@cocotb.test()
async def reset_at_any_clock(dut):
    await begin(dut)
    for _ in range(8):
        running = cocotb.start_soon(frame(dut, 60, "random", "random"))
        await ClockCycles(dut.clk_i, random.randrange(1, 400))
        running.cancel()
        drive(dut, **NOTHING)
        await reset(dut)
        await ClockCycles(dut.clk_i, 3)
        assert not int(dut.mem_read_o.value)
        assert not RESULT.unpack(dut.result_o)["complete"]
        await frame(dut, 30, "random", "random")
