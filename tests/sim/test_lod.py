"""Level of detail in the exact model: against the rule in rational arithmetic, and off as without it."""

from fractions import Fraction

import numpy as np
import pytest
from oracles import lod, ray
from oracles.cuts import memory_of
from oracles.planes import assert_planes
from oracles.random_cameras import random_camera, random_voxels

import voxrt
from voxrt.octree import Rom, from_dense, with_means
from voxrt.octree.camera import Camera, lod_scale
from voxrt.sim import SimulatorError, _model
from voxrt.voxelize import EMPTY, Material

PALETTE = np.random.default_rng(3).integers(0, 256, (256, 3), dtype=np.uint8)
SIZE = (13, 9)


def some_world(rng):
    """A random world, its words, and a random mean material for each block."""
    depth = int(rng.integers(2, 6))
    voxels = random_voxels(rng, depth, rng.choice([0.01, 0.1, 0.4]))
    words = memory_of(voxels, share=bool(rng.integers(2)), split=bool(rng.integers(2)))
    means = rng.choice([0, *rng.integers(1, 256, 3)], (len(words) - 1) // 8).astype(np.uint8)
    return depth, words, means


@pytest.mark.parametrize("seed", range(40))
def test_frames_are_the_oracles(seed):
    rng = np.random.default_rng([seed, 16])
    depth, words, means = some_world(rng)
    camera = random_camera(rng, 1 << depth)
    scale = int(rng.choice([1, *rng.integers(1, 1 << rng.integers(2, 21), 5)]))
    frame, *others = (
        _model.Memory(words, depth).render(PALETTE, camera, *SIZE, 1, instructions, means=means, lod_scale=scale)
        for instructions in _model.INSTRUCTION_SETS
    )
    for other in others:
        assert_planes(other, (frame.colour, frame.material, frame.face))
    for (row, column), direction in zip(
        np.ndindex(SIZE[1], SIZE[0]), ray.directions(camera, *SIZE).reshape(-1, 3), strict=True
    ):
        material, face = lod.trace((words, means, depth), camera[0], direction, scale)
        got = int(frame.material[row, column]), int(frame.face[row, column])
        assert got == (material, face), f"pixel ({column}, {row}) of seed {seed}"
        assert tuple(frame.colour[row, column]) == ray.shade(PALETTE[material], direction, face)


@pytest.mark.parametrize("seed", range(10))
def test_far_cameras_have_exact_pixels_too(seed):
    # Wide keys: no packet of rays is exact there, and each ray is traced alone.
    rng = np.random.default_rng([seed, 17])
    depth, words, means = some_world(rng)
    away = rng.integers(-(1 << 26), 1 << 26, 3)
    look = -(away / np.abs(away).max() * 30000).astype(int)
    camera = np.array([away, look, [1, 0, 0], [0, 1, 0]], np.int32)
    scale = int(rng.integers(1, 1 << 20))
    frame = _model.Memory(words, depth).render(PALETTE, camera, 5, 5, means=means, lod_scale=scale)
    for (row, column), direction in zip(np.ndindex(5, 5), ray.directions(camera, 5, 5).reshape(-1, 3), strict=True):
        got = int(frame.material[row, column]), int(frame.face[row, column])
        assert got == lod.trace((words, means, depth), camera[0], direction, scale)


def test_scale_0_and_blocks_without_mean_change_nothing():
    rng = np.random.default_rng(5)
    depth, words, means = some_world(rng)
    memory, camera = _model.Memory(words, depth), random_camera(rng, 1 << depth)
    plain = memory.render(PALETTE, camera, *SIZE)
    for same in ({"means": means, "lod_scale": 0}, {"means": np.zeros_like(means), "lod_scale": 1}):
        other = memory.render(PALETTE, camera, *SIZE, **same)
        np.testing.assert_array_equal(other.colour, plain.colour)
        np.testing.assert_array_equal(other.face, plain.face)


def test_what_does_not_go_is_refused():
    rng = np.random.default_rng(6)
    depth, words, means = some_world(rng)
    memory, camera = _model.Memory(words, depth), random_camera(rng, 1 << depth)
    with pytest.raises(ValueError, match="a material for each of the"):
        memory.render(PALETTE, camera, 4, 4, means=means[:-1], lod_scale=1)
    with pytest.raises(ValueError, match="lod_scale is 1048576, not 0"):
        memory.render(PALETTE, camera, 4, 4, means=means, lod_scale=1 << 20)
    with pytest.raises(ValueError, match="does not go with a light or reflections"):
        memory.render(PALETTE, camera, 4, 4, means=means, lod_scale=1, bounces=1)
    rom = Rom("dots", from_dense(np.ones((4, 4, 3), int)), (EMPTY, Material("red", (255, 0, 0))))
    with pytest.raises(SimulatorError, match=r"dots has no mean materials; build it with --lod"):
        voxrt.render(rom, size=(8, 8), engine="model", lod=True)
    lit = voxrt.Lighting(position=(0, 0, 0), on=True)
    with pytest.raises(SimulatorError, match="does not go with a light or mirrors"):
        voxrt.render(with_means(rom), size=(8, 8), engine="model", lod=True, lighting=lit)


def test_the_scale_is_the_width_of_a_pixel():
    right = (3, -4, 12)
    camera = Camera(position=(0, 0, 0), look=(0, 0, 900), right=right, up=(0, 13, 0))
    assert lod_scale(camera) == (1 << 20) // 13
    assert lod_scale(Camera(position=(0, 0, 0), look=(0, 0, 9), right=(0, 0, 0), up=(0, 1, 0))) == 0
    assert lod_scale(Camera(position=(0, 0, 0), look=(0, 0, 9), right=(1, 0, 0), up=(0, 1, 0))) == (1 << 20) - 1


@pytest.mark.parametrize("cell", [0.25, 0.5, 1 / 3, 1.5, 2, 7])
def test_the_scale_of_narrower_and_wider_cells(cell):
    right = (3, -4, 12)
    scale = lod_scale(Camera(position=(0, 0, 0), look=(0, 0, 900), right=right, up=(0, 13, 0)), cell)
    assert scale <= (1 << 20) / (13 * Fraction(cell)) < scale + 1


def test_a_picture_has_the_cells_that_are_asked_for():
    rom = lod.noise(12, 32, 0.4)
    size = (24, 18)
    camera = voxrt.aim_camera(rom, size)
    registers = np.array([camera.position, camera.look, camera.right, camera.up], np.int32)
    frames = []
    for cell in (True, 1, 0.5, 4):
        shown = voxrt.render(rom, camera, size=size, engine="model", lod=cell)
        scale = lod_scale(camera, float(cell))
        wanted = _model.Memory(rom.octree.words, rom.octree.depth).render(
            PALETTE, registers, *size, means=rom.octree.means, lod_scale=scale
        )
        np.testing.assert_array_equal(shown.material, wanted.material)
        frames.append(shown.material)
    np.testing.assert_array_equal(frames[0], frames[1])
    assert (frames[1] != frames[2]).any()
    assert (frames[1] != frames[3]).any()


@pytest.mark.parametrize("cell", [-1, float("nan"), 1024, "wide"])
def test_cells_that_are_none_are_refused(cell):
    rom = with_means(Rom("dots", from_dense(np.ones((4, 4, 3), int)), (EMPTY, Material("red", (255, 0, 0)))))
    with pytest.raises((TypeError, ValueError), match="lod must be a finite number above 0 and below 1024"):
        voxrt.render(rom, size=(8, 8), engine="model", lod=cell)


def test_a_far_view_reads_fewer_words():
    rom = lod.noise(9, 64, 0.3)
    camera = voxrt.aim_camera(rom, (8, 8))
    assert rom.octree.means is not None
    registers = np.array([camera.position, camera.look, camera.right, camera.up], np.int32)
    memory = _model.Memory(rom.octree.words, rom.octree.depth)
    plain = memory.render(PALETTE, registers, 8, 8)
    coarse = memory.render(PALETTE, registers, 8, 8, means=rom.octree.means, lod_scale=lod_scale(camera))
    assert coarse.words_read < plain.words_read / 3
