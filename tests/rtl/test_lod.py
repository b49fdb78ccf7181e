"""Level of detail in the verilated ray tracer: the pixels of the rule in rational arithmetic, and of the model."""

from __future__ import annotations

import numpy as np
import pytest
from oracles import lod
from oracles.memory import words_of
from oracles.random_cameras import random_camera, random_voxels
from oracles.ray import directions, shade

import voxrt
from voxrt.octree import Rom, encode, from_dense, with_means
from voxrt.sim import SimulatorError
from voxrt.voxelize import EMPTY, Material

rtl = pytest.importorskip("voxrt.sim._rtl", reason="this build has no verilated ray tracer")

DETAILED = [name for name in rtl.CONFIGS if "lod" in rtl.FEATURES[name]]
MATERIALS = np.random.default_rng(8).integers(0, 256, (256, 3), dtype=np.uint8)


def test_the_configurations_with_caches_have_it():
    assert {"cached1", "cached16"} & set(rtl.CONFIGS) <= set(DETAILED)
    assert "tiny" not in DETAILED


@pytest.mark.parametrize("config", DETAILED)
@pytest.mark.parametrize("seed", range(12))
def test_random_worlds_and_cameras(config, seed):
    rng = np.random.default_rng([seed, 16])
    design = rtl.Tracer(config)
    for _ in range(4):
        depth = int(rng.integers(2, 6))
        words = words_of(random_voxels(rng, depth, rng.choice([0.01, 0.1, 0.5])))
        means = rng.choice([0, *rng.integers(1, 256, 3)], (len(words) - 1) // 8).astype(np.uint8)
        design.load(encode(words, "lod", means), lod_words=True)
        camera = np.asarray(random_camera(rng, 1 << depth), np.int32)
        width, height = (int(n) for n in rng.integers(1, 21, 2))
        scale = int(rng.choice([0, 1, *rng.integers(1, 1 << rng.integers(2, 21), 6)]))
        limits = {"stall_seed": (0, 2**32), "latency": (1, 120), "jitter": (0, 100), "dram_seed": (0, 2**32)}
        pace = {name: int(rng.integers(*limit)) for name, limit in limits.items()}
        got = design.render(camera, width, height, depth, MATERIALS, lod_scale=scale, **pace)
        assert got["errors"] == []
        for (row, column), direction in zip(
            np.ndindex(height, width), directions(camera, width, height).reshape(-1, 3), strict=True
        ):
            material, face = lod.trace((words, means, depth), camera[0], direction, scale)
            assert (got["material"][row, column], got["face"][row, column]) == (material, face)
            assert tuple(got["colour"][row, column]) == shade(MATERIALS[material], direction, face)


@pytest.mark.parametrize("config", DETAILED)
def test_a_far_view_is_the_models_and_costs_less(config):
    rom = lod.noise(3, 128, 0.2)
    camera = voxrt.aim_camera(rom, (24, 24))
    checked = voxrt.check(rom, camera, (24, 24), config=config, lod=1)
    assert checked.wrong_pixels == 0
    plain = voxrt.render(rom, camera, size=(24, 24), config=config)
    assert checked.rtl.cost.words_read is not None
    assert plain.cost.words_read is not None
    assert checked.rtl.cost.words_read < plain.cost.words_read / 2


def test_a_configuration_without_it_says_so():
    rom = with_means(Rom("dots", from_dense(np.ones((4, 4, 3), int)), (EMPTY, Material("red", (255, 0, 0)))))
    if "tiny" not in rtl.CONFIGS:
        pytest.skip("this build has no configuration tiny")
    with pytest.raises(SimulatorError, match="'tiny' is built without level of detail; take one with caches"):
        voxrt.render(rom, size=(8, 8), config="tiny", lod=True)
