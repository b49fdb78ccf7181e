"""The verilated ray tracer with its octree in an external memory, behind caches: exact, whatever that memory's pace."""

from __future__ import annotations

import numpy as np
import pytest
from assets import asset
from oracles.memory import words_of
from oracles.planes import assert_planes
from oracles.random_cameras import random_camera, random_voxels
from oracles.ray import render

import voxrt
from voxrt.octree import Rom, from_points
from voxrt.rtl.configurations import read_configurations
from voxrt.sim import CacheCost, Dram, SimulatorError
from voxrt.voxelize import EMPTY, Material

rtl = pytest.importorskip("voxrt.sim._rtl", reason="this build has no verilated ray tracer")

CONFIGURATIONS = read_configurations()
CACHED = [name for name in rtl.CONFIGS if CONFIGURATIONS[name].parameters["MemoryForm"] == 2]
MATERIALS = np.random.default_rng(8).integers(0, 256, (256, 3), dtype=np.uint8)
CAMERA = np.array([[-100, 300, -80], [100, -60, 100], [4, 0, -4], [0, 4, 1]], np.int32)


def scattered(depth=9, count=20000):
    """A memory that no cache holds: single voxels everywhere."""
    places = np.random.default_rng(depth).integers(0, 1 << depth, (count, 3))
    return Rom("scattered", from_points(places, [1] * count, depth=depth), (EMPTY, Material("red", (255, 0, 0))))


@pytest.mark.parametrize("config", CACHED)
@pytest.mark.parametrize("seed", range(12))
def test_random_worlds_at_any_pace(config, seed):
    rng = np.random.default_rng([seed, 7])
    design = rtl.Tracer(config)
    for _ in range(3):
        depth = int(rng.integers(1, 5))
        voxels = random_voxels(rng, depth, rng.choice([0, 0.01, 0.1, 0.5]))
        design.load(words_of(voxels))
        camera = np.asarray(random_camera(rng, len(voxels)), np.int32)
        width, height = (int(n) for n in rng.integers(1, 41, 2))
        limits = {"stall_seed": (0, 2**32), "latency": (1, 201), "interval": (1, 9), "jitter": (0, 100)}
        pace = {name: int(rng.integers(*limit)) for name, limit in (limits | {"dram_seed": (0, 2**32)}).items()}
        got = design.render(camera, width, height, depth, MATERIALS, **pace)
        assert_planes(got, render(voxels, camera, width, height, MATERIALS))
        assert got["errors"] == []
        assert got["words_read"] <= got["word_requests"]


@pytest.mark.parametrize("config", CACHED)
@pytest.mark.parametrize("latency", [1, 50, 200])
def test_a_scene_larger_than_the_caches(config, latency):
    rom = scattered()
    size = (96, 70)
    checked = voxrt.check(
        rom, voxrt.aim_camera(rom, size), size, config=config, dram=Dram(latency=latency, jitter=40, seed=latency)
    )
    assert checked.wrong_pixels == 0
    cost = checked.rtl.cost.cache
    assert cost.lines_read > 2048, "the shared cache holds all of it"
    assert cost.lines_read < cost.line_requests < cost.words_read < cost.word_requests


@pytest.mark.parametrize(
    ("config", "width"), [("cached1", 2049), ("cached4", 1025), ("cached8", 1024), ("cached16", 2049)]
)
def test_wide_pictures_come_in_lower_strips(config, width):
    voxels = random_voxels(np.random.default_rng(4), 3, 0.1)
    design = rtl.Tracer(config)
    design.load(words_of(voxels))
    camera = np.array([[-100, 100, -80], [10000, -6000, 10000], [9, 0, -9], [0, 400, 100]], np.int32)
    got = design.render(camera, width, 19, 3, MATERIALS)
    assert_planes(got, render(voxels, camera, width, 19, MATERIALS))


@pytest.mark.parametrize("config", CACHED)
def test_a_bus_that_fails_ends_the_frame_and_the_next_is_whole(config):
    voxels = random_voxels(np.random.default_rng(3), 4, 0.2)
    words = words_of(voxels)
    design = rtl.Tracer(config)
    design.load(words[:9])  # the blocks below are beyond the memory: DECERR
    assert design.render(CAMERA, 16, 16, 4, MATERIALS)["errors"] == ["bus error"]
    design.load(words)
    silent = design.render(CAMERA, 16, 16, 4, MATERIALS, latency=100_000)
    assert silent["errors"] == ["bus timeout"]
    assert (silent["material"] == 0).all()
    got = design.render(CAMERA, 16, 16, 4, MATERIALS)
    assert got["errors"] == []
    np.testing.assert_array_equal(got["material"], render(voxels, CAMERA, 16, 16, MATERIALS)[1])


@pytest.mark.parametrize("config", CACHED)
def test_the_memory_is_mapped_and_has_no_port(config):
    voxels = random_voxels(np.random.default_rng(5), 4, 0.2)
    words = words_of(voxels)
    design = rtl.Tracer(config)
    with pytest.raises(ValueError, match="load words first"):
        design.render(CAMERA, 8, 8, 4, MATERIALS)
    design.load(words)
    words[:] = 0xFFFFFF05
    assert (design.render(CAMERA, 8, 8, 4, MATERIALS)["material"] % 5 == 0).all()
    with pytest.raises(ValueError, match="no access port"):
        design.load(words, through_port=True)
    with pytest.raises(ValueError, match="no access port"):
        design.read_back(1)


@pytest.mark.skipif("cached1" not in rtl.CORES, reason="this build has no core cached1")
def test_the_whole_core_has_its_memory_at_an_address():
    core = rtl.Core("cached1")
    words = np.zeros(16, np.uint32)
    assert core.cached
    core.map_external(0x2000_001C, words)
    for address, wrong in ((2, words), (0xFFFF_FFE0, words)):
        with pytest.raises(ValueError, match="words from byte"):
            core.map_external(address, wrong)
    with pytest.raises(ValueError, match="no memory port"):
        core.read_memory(0, 1)
    with pytest.raises(ValueError, match="no memory port"):
        core.write_memory(0, words)
    on_chip = rtl.Core("tiny")
    assert not on_chip.cached
    with pytest.raises(ValueError, match="not external"):
        on_chip.map_external(0, words)


def test_what_is_no_external_memory_is_refused():
    for wrong in ({"latency": -1}, {"interval": 0}, {"jitter": 1_000_001}, {"seed": 1 << 32}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            Dram(**wrong)
    rom = scattered(4, 9)
    camera = voxrt.aim_camera(rom, (8, 8))
    with pytest.raises(SimulatorError, match="the model has no external memory"):
        voxrt.render(rom, camera, size=(8, 8), engine="model", dram=Dram())
    on_chip = [name for name in rtl.CONFIGS if name not in CACHED]
    if on_chip:
        with pytest.raises(SimulatorError, match="has its memory on the chip"):
            voxrt.render(rom, camera, size=(8, 8), config=on_chip[0], dram=Dram())


def test_costs_add_up():
    one, other = CacheCost(100, 120, 20, 4), CacheCost(300, 300, 20, 6)
    both = one + other
    assert (both.words_read, both.l1_hits, both.l2_hits, both.bytes_read) == (400, 0.9, 0.75, 320)
    assert CacheCost(0, 0, 0, 0).l1_hits == 1


@pytest.mark.skipif("cached4" not in CACHED, reason="this build has no cached4")
def test_a_scan_is_exact():
    rom = voxrt.build(asset("obj/odedstein-meshes/skull/skull.obj"), depth=9).rom
    checked = voxrt.check(rom, voxrt.aim_camera(rom, (160, 120)), (160, 120), config="cached4", dram=Dram())
    assert checked.wrong_pixels == 0
