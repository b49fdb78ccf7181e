"""Flat pictures, lights with shadows and mirrors, against rational arithmetic."""

import numpy as np
import pytest
from oracles import ray, worlds
from oracles.adversary import adversarial_cameras
from oracles.cuts import memory_of
from oracles.shading import Shader, shaded_pixel

from voxrt.sim import _model

PALETTE = np.random.default_rng(21).integers(0, 256, (256, 3), dtype=np.uint8)
EVERY_OTHER = frozenset(range(1, 256, 2))
SIZE = (13, 11)


def room():
    """A room of mirrors, open to the front, with something to see in it."""
    voxels = np.zeros((8, 8, 8), np.uint8)
    voxels[[0, -1]] = 1
    voxels[:, [0, -1]] = 3
    voxels[:, :, 0] = 5
    voxels[3, 2, 4] = 2
    voxels[5, 5, 3] = 7
    return voxels


WORLDS = {"noise": worlds.noise(3, 0.15, 22), "boxes": worlds.boxes(4, 9, 23), "room": room()}
SHADERS = {
    "flat": {"flat": True},
    "faces": {"brightness": (1, 37, 140, 255, 219, 0)},
    "faces, flat": {"brightness": (1, 37, 140, 255, 219, 0), "flat": True},
    "faces, light": {"brightness": (189, 37, 140, 255, 219, 254), "light": (61, 70, 77), "ambient": 90},
    "faces, light, two bounces": {
        "brightness": (189, 37, 140, 255, 219, 0),
        "light": (70, 300, 50),
        "ambient": 255,
        "bounces": 2,
    },
    "faces, fifteen bounces": {"brightness": (9, 250, 140, 255, 1, 219), "bounces": 15},
    "light above": {"light": (70, 300, 50), "ambient": 40},
    "light within": {"light": (61, 70, 77), "ambient": 0},
    "light on a corner of the grid": {"light": (64, 64, 64), "ambient": 9},
    "light far away": {"light": (-(2**30), 2**31 - 1, 77), "ambient": 13},
    "light, flat": {"light": (70, 300, 50), "ambient": 100, "flat": True},
    "one bounce": {"bounces": 1},
    "four bounces, light": {"bounces": 4, "light": (70, 100, 90), "ambient": 20},
    "fifteen bounces, flat": {"bounces": 15, "flat": True},
}


def rendered(voxels, registers, options, **cut):
    flags = np.array([material in EVERY_OTHER for material in range(256)], np.uint8)
    light = options.get("light")
    memory = _model.Memory(memory_of(voxels, **cut), len(voxels).bit_length() - 1)
    return memory.render(
        PALETTE,
        registers,
        *SIZE,
        flat=options.get("flat", False),
        brightness=np.array(options["brightness"], np.uint8) if "brightness" in options else None,
        light=None if light is None else np.array(light, np.int32),
        ambient=options.get("ambient", 0),
        bounces=options.get("bounces", 0),
        mirrors=flags,
    )


def cameras_of(voxels, seed):
    side = len(voxels)
    middle = [8 * side + 1, 8 * side + 3, 16 * side - 5]
    into = [middle, [0, 0, -12], [2, 0, 0], [0, 2, 0]]
    far = [[2**31 - 1, -(2**31), 1000], [-(2**19), 2**19, 0], [50, 0, 0], [0, 60, 0]]
    return [np.array(into, np.int32), np.array(far, np.int32), *adversarial_cameras(side, 7, seed)]


@pytest.mark.parametrize("shader", SHADERS)
@pytest.mark.parametrize("world", WORLDS)
def test_every_pixel_has_the_oracles_colour(world, shader):
    voxels, options = WORLDS[world], SHADERS[shader]
    settings = {{"brightness": "faces"}.get(name, name): value for name, value in options.items()}
    oracle = Shader(PALETTE, mirrors=EVERY_OTHER, **settings)
    for registers in cameras_of(voxels, seed=len(shader)):
        frame = rendered(voxels, registers, options)
        for (row, column), _ in np.ndenumerate(frame.face):
            direction = ray.directions(registers, *SIZE)[row, column]
            colour, material, face = shaded_pixel(voxels, oracle, registers[0], direction)
            found = (*frame.colour[row, column].tolist(), frame.material[row, column], frame.face[row, column])
            assert found == (*colour, material, face), (registers.tolist(), (row, column), direction.tolist())


@pytest.mark.parametrize("shader", ["light within", "four bounces, light", "faces, light"])
def test_the_picture_does_not_depend_on_how_the_octree_is_cut(shader):
    voxels = WORLDS["boxes"]
    for registers in cameras_of(voxels, seed=3):
        whole = rendered(voxels, registers, SHADERS[shader])
        split = rendered(voxels, registers, SHADERS[shader], share=False, split=True)
        np.testing.assert_array_equal(whole.colour, split.colour)


def test_no_bounce_means_no_mirror():
    registers = cameras_of(WORLDS["room"], 1)[0]
    with_mirrors = rendered(WORLDS["room"], registers, {"bounces": 0})
    without = _model.Memory(memory_of(WORLDS["room"]), 3).render(PALETTE, registers, *SIZE)
    np.testing.assert_array_equal(with_mirrors.colour, without.colour)


@pytest.mark.parametrize(("what", "value"), [("ambient", 256), ("ambient", -1), ("bounces", 16), ("bounces", -1)])
def test_values_out_of_range_are_refused(what, value):
    with pytest.raises(ValueError, match=f"{what} is {value}"):
        rendered(WORLDS["room"], cameras_of(WORLDS["room"], 1)[0], {what: value, "light": (0, 0, 0)})
