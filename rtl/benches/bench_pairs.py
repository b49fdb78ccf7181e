"""A core of any parameters, from its pins: plain, lit and mirrored pictures, cameras at the ends of the register."""

import random

import cocotb
import numpy as np
from bench_cached_core import CachedCore
from bench_positions import cameras
from core_driver import COLOURS, MIRRORS, Core
from oracles.memory import words_of
from oracles.random_cameras import random_camera
from oracles.ray import directions, render
from oracles.shading import Shader, shaded_pixel

SIZE = (9, 5)


async def loaded(dut, voxels):
    """A core that shows a scene, whatever its memory is."""
    if int(dut.MemoryForm.value) == 2:
        core = CachedCore(dut)
        await core.begin(voxels)
        return core
    core = Core(dut)
    await core.start()
    await core.load(words_of(voxels))
    return core


def scene_of(dut):
    """As large a random world as the memory holds for certain, of at most 8 voxels a side."""
    depth = 2 if int(dut.MaxDepth.value) == 2 or int(dut.BlockBits.value) == 5 else 3
    side = 1 << depth
    return depth, np.random.default_rng(21).choice([0, 0, 0, 0, 1, 2, 255], (side,) * 3).astype(np.uint8)


@cocotb.test()
async def pictures_are_exact(dut):
    """Random cameras within the register, under back-pressure; then from the corners of the register's range."""
    depth, voxels = scene_of(dut)
    core = await loaded(dut, voxels)
    chance, stalls = np.random.default_rng(5), random.Random(5)
    core.ready = iter(lambda: stalls.random() < 0.8, 2)
    bits = int(dut.PositionBits.value)
    limit = 1 << (bits - 1)
    some = [np.asarray(random_camera(chance, 1 << depth)) for _ in range(6)]
    for camera in [*some, *cameras(16 << depth, bits)]:
        camera[0] = np.clip(camera[0], -limit, limit - 1)
        await core.set_frame(camera, *SIZE, depth)
        colour, _, _ = render(voxels, camera, *SIZE, COLOURS)
        np.testing.assert_array_equal(await core.trace(*SIZE), colour)


@cocotb.test()
async def features_are_exact(dut):
    """Light and mirrors, where they are built in."""
    depth, voxels = scene_of(dut)
    core = await loaded(dut, voxels)
    await core.write_mirrors()
    side = 16 << depth
    camera = np.array([[-side // 3, side, -side // 3], [90, -70, 100], [9, 0, -9], [1, 9, 2]], np.int32)
    light = (side // 2, 2 * side, -side // 4)
    shadings = [{}]
    if await core.read("features", "light"):
        shadings.append({"light": light, "ambient": 60})
    if await core.read("features", "mirrors"):
        shadings.append({"bounces": 2, "mirrors": MIRRORS})
    limit = 1 << (int(dut.PositionBits.value) - 1)
    camera[0] = np.clip(camera[0], -limit, limit - 1)
    for shading in shadings:
        await core.set_frame(camera, *SIZE, depth)
        await core.set_light(light)
        await core.write(
            "shading", light="light" in shading, ambient=shading.get("ambient", 0), bounces=shading.get("bounces", 0)
        )
        shader = Shader(COLOURS, **shading)
        rays = directions(camera, *SIZE).reshape(-1, 3)
        expected = [shaded_pixel(voxels, shader, camera[0], direction)[0] for direction in rays]
        expected = np.array(expected, np.uint8).reshape(SIZE[1], SIZE[0], 3)
        np.testing.assert_array_equal(await core.trace(*SIZE), expected)
