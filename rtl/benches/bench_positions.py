"""Cameras at the ends of the position register: the distance to the world's far plane has its most bits there."""

import itertools

import cocotb
import numpy as np
from core_driver import COLOURS, scene, started
from oracles.ray import render

SIZE = (7, 5)


def cameras(world, bits):
    """Give a camera per corner of the register's range, turned to the middle of a world of `world` 1/16 voxels."""
    ends = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
    for position in itertools.product(ends, repeat=3):
        to_middle = [world // 2 - place for place in position]
        look = [90 * sign for sign in np.sign(to_middle)]
        right = [9 * look[1] // 90, -9 * look[0] // 90, 0]
        up = [0, 9 * look[2] // 90, -9 * look[1] // 90]
        yield np.array([position, look, right, up], np.int32)


@cocotb.test()
async def the_ends_of_the_position_register(dut):
    """From every corner of its range, into a world of the greatest depth."""
    depth, bits = int(dut.MaxDepth.value), int(dut.PositionBits.value)
    voxels = scene(11).repeat(1 << (depth - 3), 0).repeat(1 << (depth - 3), 1).repeat(1 << (depth - 3), 2)
    core = await started(dut, voxels)
    hits = 0
    for camera in cameras(16 << depth, bits):
        await core.set_frame(camera, *SIZE, depth)
        colour, material, _ = render(voxels, camera, *SIZE, COLOURS)
        np.testing.assert_array_equal(await core.trace(*SIZE), colour)
        hits += (material > 0).sum()
    assert hits > SIZE[0] * SIZE[1]
