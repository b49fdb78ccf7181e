"""Rays directed so that every bin of rtl/coverage/voxrt_lane_coverage.sv is hit.

Levels, exits, ancestors, mirrored octants.
Every world is made in the mirrored frame, in which rays go ahead on all axes, and turned to one of the eight octants.
What a ray must show is known from how the world was made.
"""

import itertools
import random

import cocotb
from cocotb.triggers import RisingEdge
from core_driver import COLOURS, Core
from oracles.ray import FACE_NONE, shade

DEPTH = 10
SIDE = 1 << DEPTH
AHEAD = 32767  # In this direction a ray drifts by less than a voxel on its way through the world.
OCTANTS = list(itertools.product((0, 1), repeat=3))
EMPTY = 0xFFFFFF00


def memory(content, mirrored, depth=DEPTH):
    """Make a memory: `content(corner, level)` gives a cell's material, or None where it is to be divided."""
    words = [0]

    def build(corner, level):
        material = content(corner, level)
        if material is not None:
            return EMPTY | material
        block = len(words)
        words.extend([0] * 8)
        for octant in OCTANTS:
            child = [place + (bit << (level - 1)) for place, bit in zip(corner, octant, strict=True)]
            index = sum((bit ^ mirror) << axis for axis, (bit, mirror) in enumerate(zip(octant, mirrored, strict=True)))
            words[block + index] = build(child, level - 1)
        return block

    words[0] = build([0, 0, 0], depth)
    return words


def around(cells, material, others=0):
    """Give the content of a world of `cells`, pairs of corner and level; all around is in leaves as large as may be."""

    def content(corner, level):
        if any(level == size and list(cell) == corner for cell, size in cells):
            return material
        inside = any(
            level > size and all(place <= at < place + (1 << level) for place, at in zip(corner, cell, strict=True))
            for cell, size in cells
        )
        return None if inside else others

    return content


def uniform(level, depth=DEPTH, word=EMPTY):
    """Make a memory of cells of one level, all of one word; their ancestors are the same block."""
    blocks = depth - level
    words = [1]
    for block in range(blocks):
        words += [8 * (block + 1) + 1 if block + 1 < blocks else word] * 8
    return words


async def look(core, position, direction, mirrored=(0, 0, 0), side=SIDE):
    """Trace one ray, given in the mirrored frame; give its pixel's colour and its direction in the grid's frame."""
    direction = [-d if mirror else d for d, mirror in zip(direction, mirrored, strict=True)]
    for axis in range(3):
        place = 16 * side - position[axis] if mirrored[axis] else position[axis]
        await core.write(f"position[{axis}]", value=place)
        await core.write(f"look[{axis}]", value=direction[axis])
    await core.write("control", start=1)
    await core.wait()
    return core.picture(1, 1)[0, 0].tolist(), direction


async def prepare(dut, depth=DEPTH):
    """Start the core with frames of one pixel, brightness by the angle."""
    core = Core(dut)
    core.ready = itertools.repeat(1)
    await core.start()
    await core.write("shading")
    await core.write("size", width=1, height=1)
    await core.write("depth", depth=depth)
    return core


@cocotb.test()
async def leaves_left_by_every_axis_to_every_ancestor(dut):
    """Cross a row of leaves of one level, each before a plane that is a power of two, out to the end of the world."""
    core = await prepare(dut)
    for level, axis, mirrored in itertools.product(range(DEPTH), range(3), OCTANTS):
        cells = []
        for climbed in range(DEPTH - level + 1):
            corner = [0, 0, 0]
            corner[axis] = (1 << (level + climbed)) - (1 << level)
            cells.append((corner, level))
        await core.load(memory(around(cells, 0), mirrored))
        position, direction = [8, 8, 8], [1, 1, 1]
        position[axis], direction[axis] = -16, AHEAD
        colour, _ = await look(core, position, direction, mirrored)
        assert colour == COLOURS[0].tolist()


@cocotb.test()
async def solid_leaves_met_by_every_face(dut):
    """Meet a solid leaf of each level, entered from outside the world by each of its faces, and from inside."""
    core = await prepare(dut)
    for level, face, mirrored in itertools.product(range(DEPTH), (0, 1, 2, FACE_NONE), OCTANTS):
        await core.load(memory(around([([0, 0, 0], level)], 255), mirrored))
        position, direction = [8, 8, 8], [1, 1, 1]
        if face != FACE_NONE:
            position[face], direction[face] = -16, AHEAD
        colour, seen = await look(core, position, direction, mirrored)
        assert tuple(colour) == shade(COLOURS[255], seen, face)


@cocotb.test()
async def pointers_to_every_child(dut):
    """From the root to a voxel in each corner of the world, the camera in it."""
    core = await prepare(dut)
    for octant, mirrored in itertools.product(OCTANTS, OCTANTS):
        corner = [bit * (SIDE - 1) for bit in octant]
        await core.load(memory(around([(corner, 0)], 2), mirrored))
        colour, _ = await look(core, [16 * place + 8 for place in corner], [1, 1, 1], mirrored)
        assert colour == COLOURS[2].tolist()


@cocotb.test()
async def dead_axes_ties_and_depths(dut):
    """Directions with zeros and equal components, in small worlds of voxels, at every depth."""
    core = await prepare(dut)
    for depth in range(1, DEPTH + 1):
        await core.write("depth", depth=depth)
        await core.load(uniform(max(depth - 3, 0), depth))
        middle = (16 << depth) // 2
        directions = itertools.product((0, 1, 2), repeat=3) if depth == 3 else [(1, 2, 3)]
        for direction in directions:
            colour, _ = await look(core, [middle, middle, middle], list(direction), side=1 << depth)
            assert colour == COLOURS[0].tolist()


@cocotb.test()
async def words_that_do_not_come_and_words_that_are_wrong(dut):
    """Let the processor read while a ray is traced; pointers into the middle of a block, and below the voxels."""
    core = await prepare(dut)

    async def read_all_the_time():
        dut.bram_we_i.value = 0
        dut.bram_addr_i.value = 4
        while True:
            dut.bram_en_i.value = random.randrange(2)  # Random: a ray comes round at a fixed period.
            await RisingEdge(dut.clk_i)

    await core.load(uniform(DEPTH - 3))
    reader = cocotb.start_soon(read_all_the_time())
    colour, _ = await look(core, [-16, 8, 8], [AHEAD, 1, 1])
    assert colour == COLOURS[0].tolist()
    reader.cancel()
    dut.bram_en_i.value = 0
    for words, error in ((uniform(3, word=4), "bad_pointer"), (uniform(0, word=1), "step_limit")):
        await core.load(words)
        colour, _ = await look(core, [-16, 8, 8], [AHEAD, 1, 1])
        assert colour == COLOURS[0].tolist()
        assert await core.read("status", error) == 1
        await core.write("status", **{error: 1})
