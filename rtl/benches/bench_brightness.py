"""voxrt_brightness against exact fractions, pixels at any pace on both sides."""

import random
from fractions import Fraction

import cocotb
from bench_shader import packed
from cocotb.triggers import with_timeout
from streams import PACES, drive, exchange, reset_on_the_way, start
from structs import SHADING, packed_array

DEPTH, PLACE, SUM = 6, 10, 12
ANGLE, MEAN, LIGHT = range(3)


def lit_point(place, mirrored, face, side):
    """Give the lit point of a hit point, 1/32 voxel, grid frame."""
    mirrored_point = [2 * p + (axis != face) for axis, p in enumerate(place)]
    return [32 * side - p if mirrored >> axis & 1 else p for axis, p in enumerate(mirrored_point)]


def some_place(side, face):
    """Make a hit point, 1/16 voxel, behind a face."""
    place = [random.randrange(16 * side) for _ in range(3)]
    place[face] -= place[face] % 16
    return place


def some_pixel(dut, side, light, shading):
    """Make a pixel and what shall be said of it: whether part and sums are given, part / whole, the sums."""
    ambient, flat, faces = shading
    payload = len(dut.detail_i) - 2
    shades = [ANGLE] + int(dut.Mirrors.value) * [MEAN] + 2 * int(dut.Light.value) * [LIGHT]
    face, shade, lit = random.randrange(3), random.choice(shades), random.randrange(2)
    pixel = random.randrange(256) << 2 | face
    item = {"pixel_i": pixel, "lit_i": lit}
    if shade == ANGLE:
        detail = random.randrange(1 << payload)
        if flat or faces:
            return item | {"detail_i": detail}, (
                pixel,
                1,
                0,
                of_face(flat, faces, face, detail >> mirrored_at(dut) + face & 1),
            )
        return item | {"detail_i": detail}, (pixel, 0, 0)
    if shade == MEAN:
        count = random.randint(1, 16)
        sums = packed(*((random.randint(0, 255 * count), SUM) for _ in range(3)))
        detail = packed((MEAN, 2), (sums, payload - 5), (count, 5))
        return item | {"detail_i": detail}, (pixel, 1, 1, Fraction(1, count), sums)
    place, mirrored = some_place(side, face), random.randrange(8)
    direction = direction_to(light, place, mirrored, face, side)
    lit = item["lit_i"] = lit and any(direction)
    part = Fraction(ambient, 256)
    if flat or faces:
        own = of_face(flat, faces, face, mirrored >> face & 1)
        part = own if lit else own * part
    elif lit:
        part = max(part, share_of(direction, face))
    return item | {"detail_i": lit_detail(dut, place, mirrored)}, (pixel, 1, 0, part)


def direction_to(light, place, mirrored, face, side):
    """Give the direction from a lit point to the light, 1/32 voxel."""
    return [2 * at - own for at, own in zip(light, lit_point(place, mirrored, face, side), strict=True)]


def share_of(direction, face):
    return Fraction(direction[face] ** 2, sum(d * d for d in direction))


def lit_detail(dut, place, mirrored):
    payload = len(dut.detail_i) - 2
    return packed((LIGHT, 2), (0, payload - 3 - 3 * PLACE), (mirrored, 3), *((p, PLACE) for p in reversed(place)))


def mirrored_at(dut):
    """Give the bit of a pixel's detail from which on it has the mirrored axes."""
    return 3 * PLACE * int(dut.Light.value)


def of_face(flat, faces, face, upper):
    return Fraction(1) if flat else Fraction(faces[3 * upper + face], 255)


def seen(dut):
    number = dut.brightness_o.value.to_unsigned()
    sums, number = number % (1 << 3 * SUM), number >> 3 * SUM
    whole, number = number % (1 << 42), number >> 42
    part, number = number % (1 << 40), number >> 40
    request = (dut.pixel_o.value.to_unsigned(), number >> 1, number & 1)
    if not number >> 1:
        return request
    return (*request, Fraction(part, whole), sums) if number & 1 else (*request, Fraction(part, whole))


def begin(dut):
    side = 1 << random.randint(1, DEPTH)
    reach = random.choice([16 * side, 1 << 18])
    light = [random.randint(-reach, reach) for _ in range(3)]
    ambient, flat = random.choice([0, 255, random.randrange(256)]), random.random() < 0.2
    brightness = [random.choice([0, 255, random.randrange(256)]) for _ in range(6)]
    faces = brightness if random.random() < 0.5 else None
    shading = SHADING.pack(flat=flat, faces=faces is not None, brightness=brightness, ambient=ambient)
    drive(dut, side_i=side, light_i=packed_array(light, 32), shading_i=shading)
    return lambda: some_pixel(dut, side, light, (ambient, flat, faces))


@cocotb.test()
@cocotb.parametrize(**PACES)
async def fractions(dut, sending, taking):
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(15):
        make = begin(dut)
        items, wanted = zip(*(make() for _ in range(40)), strict=True)
        got = await with_timeout(exchange(dut, items, lambda: seen(dut), sending, taking), 1, "ms")
        assert got == list(wanted)


@cocotb.test()
async def nearly_the_ambient_light(dut):
    """Compare the light with the ambient light where they are as near as can be: close to the light and far away."""
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(400 * int(dut.Light.value)):
        side, face, mirrored = 1 << random.randint(1, DEPTH), random.randrange(3), random.randrange(8)
        place, reach = some_place(side, face), 1 << random.randint(1, 17)
        point = lit_point(place, mirrored, face, side)
        light = [own // 2 + random.randint(-reach, reach) for own in point]
        direction = direction_to(light, place, mirrored, face, side)
        nearest = round(256 * share_of(direction, face)) + random.randint(-1, 1) if any(direction) else 0
        ambient = min(max(nearest, 0), 255)
        drive(dut, side_i=side, light_i=packed_array(light, 32), shading_i=SHADING.pack(ambient=ambient))
        item = {"pixel_i": face, "lit_i": any(direction), "detail_i": lit_detail(dut, place, mirrored)}
        part = max(Fraction(ambient, 256), share_of(direction, face) if any(direction) else Fraction(0))
        assert await exchange(dut, [item], lambda: seen(dut), "always", "always") == [(face, 1, 0, part)]


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, valid_i=0, ready_i=0)
    for _ in range(10):
        make = begin(dut)
        items, wanted = zip(*(make() for _ in range(30)), strict=True)
        await reset_on_the_way(dut, items, lambda: seen(dut))
        assert await exchange(dut, items, lambda: seen(dut), "random", "random") == list(wanted)
