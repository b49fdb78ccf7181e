"""Level of detail of the whole core, from its pins: the dialect of the memory port, and pixels against the oracle."""

import random

import cocotb
import numpy as np
from cocotb.triggers import RisingEdge
from core_driver import COLOURS, LOADED, Core
from oracles import lod, ray
from oracles.memory import words_of
from oracles.random_cameras import random_camera

SIZE = (9, 7)
NUMBERS = (0, *LOADED)


def some_scene(chance, numbers=NUMBERS):
    """Make a random world with a random mean material for each block, and its words in both dialects."""
    depth = int(chance.integers(2, 4))
    voxels = chance.choice([*[0] * 12, 1, 2, 255], (1 << depth,) * 3).astype(np.uint8)
    words = words_of(voxels)
    means = chance.choice(numbers, len(words) // 8).astype(np.uint8)
    leaves = words >> 31 == 1
    return depth, words, means, np.where(leaves, words, words >> 3 << 8 | means[np.where(leaves, 0, words) >> 3])


def scales_of(chance, camera):
    """Make scales with which a ray through the corner of the picture reaches up to 64 voxels, if it is long enough."""
    largest = int(np.abs(ray.directions(camera, *SIZE)[0, 0]).max())
    return np.minimum((chance.integers(0, 1 << chance.integers(0, 7, 4)) << 20) // max(largest, 1) + 1, (1 << 20) - 1)


async def read_back(dut, count):
    """Read words through the memory port, one at a time."""
    words = []
    for address in range(count):
        dut.bram_en_i.value = 1
        dut.bram_addr_i.value = 4 * address
        await RisingEdge(dut.clk_i)
        dut.bram_en_i.value = 0
        for _ in range(3):
            await RisingEdge(dut.clk_i)
        words.append(int(dut.bram_rddata_o.value))
    return words


@cocotb.test()
async def pixels_are_the_oracles(dut):
    """With every kind of camera, near and far; off, the pixels are those of the voxels."""
    chance = np.random.default_rng(random.randrange(1 << 30))
    core = Core(dut)
    await core.start()
    assert await core.read("features", "lod") == 1
    for _ in range(40):
        depth, words, means, lod_words = some_scene(chance)
        camera = np.asarray(random_camera(chance, 1 << depth))
        limit = 1 << int(dut.PositionBits.value) - 1
        camera[0] = np.clip(camera[0], -limit, limit - 1)
        scale = int(
            chance.choice([0, 1, *chance.integers(1, 1 << chance.integers(2, 21), 2), *scales_of(chance, camera)])
        )
        await core.write("lod", words=1, scale=scale)
        await core.load(lod_words)
        assert await read_back(dut, 9) == lod_words[:9].tolist()
        await core.set_frame(camera, *SIZE, depth)
        await compare(core, (words, means, depth), camera, scale)


async def compare(core, memory, camera, scale):
    """Trace a frame; compare its pixels with the oracle's."""
    await core.write("control", start=1)
    await core.wait()
    expected = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    for (row, column), direction in zip(
        np.ndindex(SIZE[1], SIZE[0]), ray.directions(camera, *SIZE).reshape(-1, 3), strict=True
    ):
        material, face = lod.trace(memory, camera[0], direction, scale)
        expected[row, column] = ray.shade(COLOURS[material], direction, face)
    np.testing.assert_array_equal(core.picture(*SIZE), expected)


@cocotb.test()
async def rays_stop_at_their_reach_along_any_axis(dut):
    """Cells are about as far along two axes or three, and some are just at the reach."""
    chance = np.random.default_rng(7)
    core = Core(dut)
    await core.start()
    for _ in range(16):
        depth, words, means, lod_words = some_scene(chance, LOADED)
        reach, sides = int(chance.integers(1, 5)), chance.integers(0, 2, 3)
        away = 2 * reach - int(chance.integers(0, 3))  # of cells of 2 voxels, some are at the reach
        places = [-16 * (away + int(chance.integers(0, 2))) + int(chance.integers(0, 16)) for _ in range(3)]
        position = np.where(sides, (16 << depth) - np.array(places), places)
        look = np.where(sides, -90, 90) + chance.integers(-9, 10, 3)
        camera = np.array([position, look, chance.integers(-9, 10, 3), chance.integers(-9, 10, 3)], np.int32)
        largest = int(np.abs(ray.directions(camera, *SIZE)).max())
        scale = ((reach - 1) << 20) // largest + 1
        await core.write("lod", words=1, scale=scale)
        await core.load(lod_words)
        await core.set_frame(camera, *SIZE, depth)
        await compare(core, (words, means, depth), camera, scale)


@cocotb.test()
async def words_of_the_report_dialect_stop_no_ray(dut):
    """Whatever the scale says."""
    chance = np.random.default_rng(5)
    core = Core(dut)
    await core.start()
    depth, words, _, _ = some_scene(chance)
    camera = np.array([[-900, 300, -800], [90, -30, 80], [1, 0, -1], [0, 1, 0]])
    await core.write("lod", words=0, scale=1)
    await core.load(words)
    await core.set_frame(camera, *SIZE, depth)
    await compare(core, (words, [], depth), camera, 0)
