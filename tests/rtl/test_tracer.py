"""The verilated ray tracer against the oracle that walks unit voxels with fractions."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from oracles.memory import words_of
from oracles.planes import assert_planes
from oracles.random_cameras import random_camera, random_voxels
from oracles.ray import render

from voxrt.rtl.configurations import read_configurations

rtl = pytest.importorskip("voxrt.sim._rtl", reason="this build has no verilated ray tracer")

MATERIALS = np.random.default_rng(7).integers(0, 256, (256, 3), dtype=np.uint8)

CONFIGURATIONS = read_configurations()
# An external memory has no access port of the core's.
WITH_PORT = [name for name in rtl.CONFIGS if CONFIGURATIONS[name].parameters["MemoryForm"] != 2]

# One per configuration: its memory is large, and loading replaces what was there.
tracer = functools.cache(rtl.Tracer)


def assert_exact(voxels, camera, width, height, *, stall_seed=0):
    """Every configuration renders what the oracle does; gives what the last one gave."""
    depth = len(voxels).bit_length() - 1
    camera = np.asarray(camera, np.int32)
    expected = render(voxels, camera, width, height, MATERIALS)
    for config in rtl.CONFIGS:
        design = tracer(config)
        design.load(words_of(voxels))
        got = design.render(camera, width, height, depth, MATERIALS, stall_seed=stall_seed)
        assert_planes(got, expected, config)
        assert got["errors"] == []
    return got


@pytest.mark.parametrize("seed", range(40))
def test_random_worlds_and_troublesome_cameras(seed):
    rng = np.random.default_rng([seed, 1])
    depth = int(rng.integers(1, 5))
    voxels = random_voxels(rng, depth, rng.choice([0, 0.01, 0.1, 0.5]))
    for _ in range(6):
        camera = random_camera(rng, len(voxels))
        width, height = (int(n) for n in rng.integers(1, 41, 2))
        assert_exact(voxels, camera, width, height, stall_seed=int(rng.integers(0, 2) * rng.integers(2**32)))


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    world=st.tuples(st.integers(1, 3), st.integers(0, 2**64 - 1)),
    position=st.tuples(*[st.integers(-200, 300)] * 3),
    frame=st.lists(st.tuples(*[st.integers(-9, 9)] * 3), min_size=3, max_size=3),
    stall_seed=st.integers(0, 2**32 - 1),
)
def test_any_world_any_camera(world, position, frame, stall_seed):
    depth, bits = world
    side = 1 << depth
    voxels = np.random.default_rng(bits).choice([0, 0, 0, 1, 2, 255], (side,) * 3).astype(np.uint8)
    assert_exact(voxels, [position, *frame], 7, 5, stall_seed=stall_seed)


@pytest.mark.parametrize("material", [0, 1, 255])
def test_a_world_of_one_leaf(material):
    voxels = np.full((4, 4, 4), material, np.uint8)
    assert len(words_of(voxels)) == 1
    for position in ([32, 32, 32], [-32, 32, 32], [-32, 70, 100], [64, 32, 32], [0, 0, 0]):
        assert_exact(voxels, [position, [40, 0, 0], [0, 0, 16], [0, 16, 0]], 9, 9)


def test_a_camera_without_direction_sees_its_own_voxel():
    voxels = np.zeros((4, 4, 4), np.uint8)
    voxels[1, 2, 3] = 9
    still = [[0, 0, 0]] * 3
    inside = assert_exact(voxels, [[16, 47, 50], *still], 2, 2)
    assert (inside["material"] == 9).all()
    assert (inside["face"] == 3).all()
    assert_exact(voxels, [[15, 47, 50], *still], 2, 2)
    assert_exact(voxels, [[16, 47, 64], *still], 2, 2)
    assert_exact(voxels, [[16, 47, -1], *still], 2, 2)


def test_extreme_directions_and_positions():
    voxels = random_voxels(np.random.default_rng(3), 3, 0.2)
    for position in ([64, 64, -65536], [65535, 65535, 65535], [-65536, 64, 64]):
        look = [int(np.sign(64 - p)) * min(abs(64 - p), 32767) // 2 for p in position]
        assert_exact(voxels, [position, look, [200, 3, 0], [0, 100, 77]], 3, 3)


@pytest.mark.parametrize("step", [32767, -32768])  # The second reaches 2**20 and 2**21, either sign, exactly.
@pytest.mark.parametrize("config", rtl.CONFIGS)
def test_a_direction_too_large_is_flagged_and_not_traced(config, step):
    design = tracer(config)
    design.load(words_of(np.full((2, 2, 2), 5, np.uint8)))
    camera = np.array([[16, 16, 16], [0, 0, 1], [step, 0, 0], [0, 0, 0]], np.int32)
    got = design.render(camera, 140, 1, 1, MATERIALS)
    offset = np.arange(140) - 70
    fits = np.abs(offset * step) < 2**20
    np.testing.assert_array_equal(got["material"][0], np.where(fits, 5, 0))
    np.testing.assert_array_equal(got["colour"][0][~fits], np.broadcast_to(MATERIALS[0], ((~fits).sum(), 3)))
    assert got["errors"] == ["direction overflow"]


@pytest.mark.parametrize("config", WITH_PORT)
def test_the_access_port_equals_the_fast_path(config):
    rng = np.random.default_rng(5)
    words = words_of(random_voxels(rng, 4, 0.2))
    garbage = rng.integers(0, 2**32, len(words), dtype=np.uint32)
    camera = np.array([[-100, 300, -80], [100, -60, 100], [16, 0, -16], [0, 16, 3]], np.int32)
    for memory in (words, garbage, words & 0xFFFF):
        design = tracer(config)
        design.load(memory)
        fast = design.render(camera, 16, 16, 4, MATERIALS)
        design.load(np.zeros_like(memory))
        design.load(memory, through_port=True)
        slow = design.render(camera, 16, 16, 4, MATERIALS)
        for key in fast:
            np.testing.assert_array_equal(fast[key], slow[key])


@pytest.mark.parametrize("config", WITH_PORT)
def test_the_memory_reads_back(config):
    words = words_of(random_voxels(np.random.default_rng(6), 4, 0.2))
    design = tracer(config)
    design.load(words)
    np.testing.assert_array_equal(design.read_back(len(words)), words)
    design.load(np.array([0xFFFFFF07], np.uint32))
    assert design.read_back(1) == [0xFFFFFF07]
    design.load(np.array([2, 0x80000003], np.uint32), through_port=True)
    np.testing.assert_array_equal(design.read_back(2), [0x7FFFFFFF, 0xFFFFFF03])


@pytest.mark.parametrize("config", rtl.CONFIGS)
@pytest.mark.parametrize(
    ("words", "errors"),
    [
        ([1, 1, 1, 1, 1, 1, 1, 1, 1], ["step limit"]),
        ([1, 9, 9, 9, 9, 9, 9, 9, 9, *[1] * 8], ["step limit"]),
        ([2, *[0xFFFFFF01] * 16], ["bad pointer"]),
        ([0x7FFFFFF9, *[0xFFFFFF01] * 8], ["bad pointer"]),
        ([1, *[0x40000001] * 8], ["bad pointer"]),
        ([1, *[4] * 8], ["bad pointer"]),
    ],
)
def test_a_corrupt_memory_ends_the_ray_with_an_error(config, words, errors):
    design = tracer(config)
    design.load(np.array(words, np.uint32))
    got = design.render(np.array([[-160, 60, 70], [100, 1, 2], [0, 0, 9], [0, 9, 0]], np.int32), 16, 16, 5, MATERIALS)
    assert got["errors"] == errors
    assert (got["material"] == 0).all()


@pytest.mark.parametrize("config", rtl.CONFIGS)
def test_the_output_is_the_same_under_any_back_pressure(config):
    rng = np.random.default_rng(11)
    voxels = random_voxels(rng, 4, 0.05)
    design = tracer(config)
    design.load(words_of(voxels))
    camera = np.array([[-100, 300, -80], [100, -60, 100], [4, 0, -4], [0, 4, 1]], np.int32)
    free = design.render(camera, 61, 47, 4, MATERIALS)
    for seed in range(1, 9):
        stalled = design.render(camera, 61, 47, 4, MATERIALS, stall_seed=seed)
        for key in ("colour", "material", "face", "words_read"):
            np.testing.assert_array_equal(free[key], stalled[key])


def test_one_lane_reads_a_word_every_clock():
    voxels = random_voxels(np.random.default_rng(2), 4, 0.1)
    voxels[0] = voxels[:, :, 0] = 0
    design = tracer("tiny")
    design.load(words_of(voxels))
    camera = np.array([[40, 130, 10], [90, 0, 160], [1, 0, 0], [0, 1, 0]], np.int32)
    got = design.render(camera, 200, 200, 4, MATERIALS)
    assert got["words_read"] / got["cycles"] >= 0.999


@pytest.mark.parametrize("config", rtl.CONFIGS)
def test_arguments_out_of_range_are_refused(config):
    design = rtl.Tracer(config)
    camera = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0]], np.int32)
    design.load(np.array([0xFFFFFF01], np.uint32))
    for width, height, depth in ((0, 1, 1), (1, 0, 1), (4096, 1, 1), (1, 1, 0), (1, 1, design.max_depth + 1)):
        with pytest.raises(ValueError, match="is not in"):
            design.render(camera, width, height, depth, MATERIALS)
    far = camera.copy()
    far[0, 1] = design.position_limit
    with pytest.raises(ValueError, match="camera position"):
        design.render(far, 1, 1, 1, MATERIALS)
    steep = camera.copy()
    steep[2, 2] = 32768
    with pytest.raises(ValueError, match="direction component 32768"):
        design.render(steep, 1, 1, 1, MATERIALS)
    with pytest.raises(ValueError, match="do not fit"):
        design.load(np.zeros(0, np.uint32))
    with pytest.raises(ValueError, match="no configuration"):
        rtl.Tracer("imaginary")


@pytest.mark.parametrize("config", rtl.CONFIGS)
def test_the_root_may_stand_anywhere(config):
    rng = np.random.default_rng(12)
    design = tracer(config)
    scenes = [words_of(random_voxels(rng, depth, 0.2)) for depth in (4, 3)] + [np.array([0xFFFFFF05], np.uint32)]
    base, memory, roots = 0, np.zeros(0, np.uint32), []
    for words in scenes:
        moved = np.where(words >> 31 == 0, words + base, words).astype(np.uint32)
        memory = np.concatenate([memory, moved, np.full(-len(moved) % 8, 0xFFFFFF00, np.uint32)])
        roots.append(base)
        base = len(memory)
    camera = np.array([[-100, 300, -80], [100, -60, 100], [4, 0, -4], [0, 4, 1]], np.int32)
    for words, root, depth in zip(scenes, roots, (4, 3, 3), strict=True):
        design.load(words)
        alone = design.render(camera, 30, 20, depth, MATERIALS)
        design.load(memory)
        got = design.render(camera, 30, 20, depth, MATERIALS, root=root)
        for key in ("colour", "material", "face", "words_read", "errors"):
            np.testing.assert_array_equal(alone[key], got[key])
    for root in (design.memory_words, 2**32 - 1):
        got = design.render(camera, 3, 2, 3, MATERIALS, root=root)
        assert got["errors"] == ["bad pointer"]
        assert (got["material"] == 0).all()
