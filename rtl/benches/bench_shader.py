"""voxrt_shader, and voxrt_divide in it, against exact fractions: pixels at any pace on both sides."""

import random
from fractions import Fraction
from math import floor

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from oracles.ray import FACE_NONE, shade
from raster import begin, line_by_line
from streams import PACES, drive, exchange, reset_on_the_way, start
from structs import MATERIAL_WRITE, SHADED_PIXEL, SHADING

SQUARE, SUM = 40, 12
OUTPUT = {"valid": "pixel_valid_o", "ready": "pixel_ready_i"}


def packed(*fields):
    """Pack values, each with its width, the first one highest."""
    number = 0
    for value, width in fields:
        number = number << width | value
    return number


def some_frame():
    """Make a frame whose directions are small enough, or steep; the least ones show each bit of their squares."""
    largest = random.choice([1, 3, 100, 20000])
    farthest = largest * random.choice([1, 20])
    corner, right, line = ([random.randint(-bound, bound) for _ in range(3)] for bound in (farthest, largest, largest))
    return corner, right, line, random.randint(1, 9), random.randint(1, 7)


def inputs_of(kind):
    """Make what voxrt_brightness may say: (packed, sums or None, part or None)."""
    whole = random.choice([1, 3, random.randint(1, 3 << SQUARE - 1)])
    part = random.randint(0, min(whole, (1 << SQUARE) - 1))
    if kind == "angle":
        return 0, None, None
    if kind == "part":
        return packed((1, 1), (0, 1), (part, SQUARE), (whole, SQUARE + 2), (0, 3 * SUM)), None, Fraction(part, whole)
    count = random.randint(1, 16)
    sums = [random.randint(0, 255 * count) for _ in range(3)]
    fields = [(1, 1), (1, 1), (1, SQUARE), (count, SQUARE + 2), *((channel, SUM) for channel in reversed(sums))]
    return packed(*fields), sums, Fraction(1, count)


def is_given(dut):
    """Tell whether voxrt_brightness is there."""
    return hasattr(dut, "Given") and int(dut.Given.value)


def kinds_of(dut):
    """Name what voxrt_brightness may say, if it is there; then those of faces are its own."""
    return ["angle", "angle", "part", "mean"] if is_given(dut) else ["angle"]


def some_shading(dut):
    """Make a frame's shading: flat, six brightnesses or None."""
    flat, by_face = random.random() < 0.3, not is_given(dut) and random.random() < 0.5
    faces = [random.choice([0, 255, random.randrange(256)]) for _ in range(6)]
    return flat, faces if by_face else None


def shading_of(flat, faces):
    """Pack what `some_shading` gives; those of faces that look along +axis are higher."""
    return SHADING.pack(
        flat=flat, faces=faces is not None, brightness=[*(faces or [7] * 6)[::2], *(faces or [7] * 6)[1::2]]
    )


def some_pixels(frame, colours, flat, faces, kinds):
    """Make a frame's pixels and what shall come of them."""
    items, wanted = [], []
    for direction, first, line_end, last in line_by_line(frame):
        material = random.randrange(256)
        face = random.choice([axis for axis in range(3) if direction[axis]] + [FACE_NONE])
        brightness, sums, part = inputs_of(random.choice(kinds))
        items.append({"pixel_i": material << 2 | face} | ({} if kinds == ["angle"] else {"brightness_i": brightness}))
        own = sums or colours[material]
        if faces and not flat and face != FACE_NONE:
            part = Fraction(faces[2 * face + (direction[face] < 0)], 255)
        if part is not None:
            colour = tuple(floor(channel * part + Fraction(1, 2)) for channel in own)
        else:
            colour = tuple(own) if flat else shade(own, direction, face)
        wanted.append((packed(*((channel, 8) for channel in colour)), material << 2 | face, first, line_end, last))
    return items, wanted


def seen(dut):
    return tuple(SHADED_PIXEL.unpack(dut.pixel_o).values())[::-1]


async def prepare(dut):
    await start(dut, raster_i=0, valid_i=0, pixel_ready_i=0, material_write_i=0, shading_i=0)
    colours = [tuple(random.choice([0, 255, random.randrange(256)]) for _ in range(3)) for _ in range(256)]
    for material, (red, green, blue) in enumerate(colours):
        drive(dut, material_write_i=MATERIAL_WRITE.pack(valid=1, material=material, red=red, green=green, blue=blue))
        await RisingEdge(dut.clk_i)
    drive(dut, material_write_i=0)
    return colours


@cocotb.test()
@cocotb.parametrize(**PACES)
async def colours(dut, sending, taking):
    table = await prepare(dut)
    for _ in range(15):
        flat, faces = some_shading(dut)
        frame = some_frame()
        drive(dut, shading_i=shading_of(flat, faces))
        items, wanted = some_pixels(frame, table, flat, faces, kinds_of(dut))
        await begin(dut, frame)
        assert await with_timeout(exchange(dut, items, lambda: seen(dut), sending, taking, **OUTPUT), 1, "ms") == wanted


@cocotb.test()
async def breaks_fill_all_places(dut):
    """No pixel is lost where the output waits for so long that all credits are used."""
    table = await prepare(dut)
    for _ in range(15):
        frame = (*some_frame()[:3], 10, 8)
        items, wanted = some_pixels(frame, table, flat=False, faces=None, kinds=kinds_of(dut))
        await begin(dut, frame)
        assert await exchange(dut, items, lambda: seen(dut), "always", "with long breaks", **OUTPUT) == wanted


@cocotb.test()
async def reset_at_any_clock(dut):
    """Begin again after it; the material table stays."""
    table = await prepare(dut)
    for _ in range(10):
        frame = some_frame()
        items, wanted = some_pixels(frame, table, flat=False, faces=None, kinds=kinds_of(dut))
        await begin(dut, frame)
        await reset_on_the_way(dut, items, lambda: seen(dut), **OUTPUT)
        await ClockCycles(dut.clk_i, 2)
        await begin(dut, frame)
        assert await exchange(dut, items, lambda: seen(dut), "random", "random", **OUTPUT) == wanted
