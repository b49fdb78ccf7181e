"""The verilated ray tracer against the exact model and against walks from voxel to voxel, pixel by pixel."""

import numpy as np
import pytest
from assets import over_assets
from oracles.adversary import adversarial_cameras
from oracles.cuts import memory_of
from oracles.ray_batch import trace_batch
from oracles.seeds import HOUSE_CAMERA, SEED_DEPTH, seed_words
from oracles.worlds import WORLDS

from voxrt.octree import Octree, Rom
from voxrt.sim import Camera, _model, check, frame_scene, look_at, pixel_directions, render
from voxrt.voxelize import Material

try:
    from voxrt.sim._rtl import CONFIGS
except ImportError:
    CONFIGS = ["tiny"]
    pytestmark = pytest.mark.skip(reason="this build has no verilated ray tracer")

PALETTE = np.random.default_rng(11).integers(0, 256, (256, 3))
SIZE = (48, 36)
CAMERAS_A_WORLD = {"tiny": 7}  # more than 100 000 rays in all; the other configurations differ around the lane alone


def rom_of(words, depth):
    materials = tuple(Material(f"m{i}", tuple(colour)) for i, colour in enumerate(PALETTE.tolist()))
    return Rom("scene", Octree(depth, words), materials)


def agreed(rom, camera, size=SIZE, config="tiny"):
    found = check(rom, camera, size, config=config)
    where = np.argwhere(found.wrong)[:3].tolist()
    assert found.wrong_pixels == 0, f"{found.wrong_pixels} pixels differ from {camera}, such as (row, column) {where}"
    return found.rtl


@pytest.mark.parametrize("config", CONFIGS)
@pytest.mark.parametrize("name", WORLDS)
def test_every_ray_meets_what_the_walk_meets(name, config):
    voxels = WORLDS[name]
    rom = rom_of(memory_of(voxels), len(voxels).bit_length() - 1)
    for registers in adversarial_cameras(len(voxels), CAMERAS_A_WORLD.get(config, 1), seed=len(voxels)):
        camera = Camera(*(tuple(triple) for triple in registers.tolist()))
        frame = agreed(rom, camera, config=config)
        directions = pixel_directions(camera, SIZE).reshape(-1, 3)
        origins = np.broadcast_to(registers[0], directions.shape)
        material, face, _ = trace_batch(voxels, origins, directions)
        np.testing.assert_array_equal(frame.material.reshape(-1), material)
        np.testing.assert_array_equal(frame.face.reshape(-1), face)


@pytest.mark.parametrize("name", WORLDS)
def test_the_ray_tracer_reads_no_word_in_vain(name):
    # One by one, the model's rays read what the traversal needs, and nothing else.
    voxels = WORLDS[name]
    rom = rom_of(memory_of(voxels), len(voxels).bit_length() - 1)
    for registers in adversarial_cameras(len(voxels), 3, seed=99):
        camera = Camera(*(tuple(triple) for triple in registers.tolist()))
        directions = pixel_directions(camera, SIZE).reshape(-1, 3).astype(np.int32)
        origins = np.ascontiguousarray(np.broadcast_to(registers[0], directions.shape))
        traced = _model.Memory(rom.octree.words, rom.octree.depth).trace(origins, directions)
        assert render(rom, camera, SIZE, engine="rtl").cost.words_read == traced.words_read


@over_assets("name", ["cubes", "dog", "house"])
def test_the_published_memories_have_no_wrong_pixel(name):
    rom = rom_of(seed_words(name), SEED_DEPTH)
    agreed(rom, Camera(*HOUSE_CAMERA), (128, 128))
    agreed(rom, frame_scene(rom, (97, 61)), (97, 61))


EYES = {
    "outside": (-40.0, 30.0, 90.0),
    "far outside": (3000.0, 2500.0, -3500.0),
    "on a plane": (16.0, 70.0, 16.03),
    "on an edge": (32.0, 32.0, 70.0),
    "inside": (16.5, 20.0, 20.0),
    "below": (20.0, -50.0, 21.0),
}


@pytest.mark.parametrize("eye", EYES.values(), ids=EYES)
@pytest.mark.parametrize("name", ["boxes", "ball", "sponge"])
def test_cameras_for_people_have_no_wrong_pixel(name, eye):
    voxels = WORLDS[name]
    rom = rom_of(memory_of(voxels), len(voxels).bit_length() - 1)
    agreed(rom, look_at(eye, (len(voxels) / 2,) * 3, size=SIZE, field_of_view=60))
