"""Brightness of faces, light, shadows and mirrors of the verilated ray tracer: against the oracle that works with
fractions, and, where there are more rays than that can follow, against the exact model, which is held against it
elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from oracles import ray
from oracles.memory import words_of
from oracles.planes import assert_planes
from oracles.random_cameras import random_camera, random_voxels
from oracles.shading import Shader, shaded_pixel

from voxrt.sim import _model

rtl = pytest.importorskip("voxrt.sim._rtl", reason="this build has no verilated ray tracer")

MATERIALS = np.random.default_rng(8).integers(0, 256, (256, 3), dtype=np.uint8)
PLAIN = {"flat": False, "brightness": None, "light": None, "ambient": 0, "bounces": 0}
PLAIN["mirrors"] = np.zeros(256, np.uint8)
ALL = {"light", "mirrors"}
TRACERS = {name: rtl.Tracer(name) for name in rtl.CONFIGS}
SHADING = [name for name in TRACERS if set(rtl.FEATURES[name]) == ALL]
needs_shading = pytest.mark.parametrize("config", SHADING)


def flags(*materials):
    mirrors = np.zeros(256, np.uint8)
    mirrors[list(materials)] = 1
    return mirrors


def at(*position):
    return np.array(position, np.int32)


def configurations_with(shading):
    """Name the configurations that have what a picture needs."""
    wanted = {"light": shading["light"] is not None, "mirrors": shading["bounces"] > 0}
    needed = {name for name, is_wanted in wanted.items() if is_wanted}
    return [name for name in TRACERS if needed <= set(rtl.FEATURES[name])]


def assert_equal(got, expected, note):
    assert_planes(got, expected, note)
    assert got["errors"] == [], note


def assert_as_the_oracle(voxels, camera, width, height, *, stall_seed=0, **shading):
    """Every configuration that can renders what the oracle does; gives what the last one gave."""
    shading = PLAIN | shading
    configurations = configurations_with(shading)
    depth = len(voxels).bit_length() - 1
    camera = np.asarray(camera, np.int32)
    light = shading["light"]
    shader = Shader(
        MATERIALS,
        shading["bounces"],
        frozenset(np.flatnonzero(shading["mirrors"]).tolist()),
        shading["flat"],
        None if light is None else tuple(light.tolist()),
        shading["ambient"],
        None if shading["brightness"] is None else tuple(shading["brightness"].tolist()),
    )
    colour = np.zeros((height, width, 3), np.uint8)
    material, face = np.zeros((2, height, width), np.uint8)
    directions = ray.directions(camera, width, height)
    for row, column in np.ndindex(height, width):
        found = shaded_pixel(voxels, shader, camera[0], directions[row, column])
        colour[row, column], material[row, column], face[row, column] = found
    for config in configurations:
        TRACERS[config].load(words_of(voxels))
        got = TRACERS[config].render(camera, width, height, depth, MATERIALS, stall_seed=stall_seed, **shading)
        assert_equal(got, (colour, material, face), config)
    return got


def random_shading(rng, side, camera):
    """Lights that like trouble: on planes, in voxels, in the camera, far away; few and many mirrors."""
    world = 16 * side
    places = (
        lambda: rng.integers(-world, 2 * world),
        lambda: rng.integers(0, side + 1) * 16,
        lambda: rng.integers(0, world),
        lambda: rng.choice([-(2**18), 2**18]),
    )
    light = at(*(rng.choice(places)() for _ in range(3))) if rng.integers(8) else camera[0].copy()
    return {
        "flat": bool(rng.integers(4) == 0),
        "brightness": some_brightness(rng) if rng.integers(2) else None,
        "light": light if rng.integers(4) else None,
        "ambient": int(rng.choice([0, 32, 255, rng.integers(256)])),
        "bounces": int(rng.choice([0, 1, 2, 7, 15])),
        "mirrors": (rng.random(256) < rng.choice([0, 0.3, 0.7, 1])).astype(np.uint8),
    }


def some_brightness(rng):
    return rng.choice([0, 255, *rng.integers(256, size=4)], 6).astype(np.uint8)


@pytest.mark.parametrize("seed", range(25))
def test_random_worlds_and_troublesome_lights(seed):
    rng = np.random.default_rng([seed, 2])
    voxels = random_voxels(rng, int(rng.integers(1, 5)), rng.choice([0, 0.01, 0.1, 0.4]))
    for _ in range(3):
        camera = random_camera(rng, len(voxels))
        width, height = (int(n) for n in rng.integers(1, 16, 2))
        stall_seed = int(rng.integers(2) * rng.integers(2**32))
        shading = random_shading(rng, len(voxels), camera)
        assert_as_the_oracle(voxels, camera, width, height, stall_seed=stall_seed, **shading)


@pytest.mark.parametrize("seed", range(8))
def test_faces_have_their_brightness_in_every_configuration(seed):
    rng = np.random.default_rng([seed, 4])
    voxels = random_voxels(rng, int(rng.integers(1, 5)), rng.choice([0.01, 0.1, 0.4]))
    for flat in (False, True):
        width, height = (int(n) for n in rng.integers(1, 16, 2))
        stall_seed = int(rng.integers(2) * rng.integers(2**32))
        camera = random_camera(rng, len(voxels))
        assert_as_the_oracle(
            voxels, camera, width, height, stall_seed=stall_seed, brightness=some_brightness(rng), flat=flat
        )


def test_the_default_brightness_of_each_side_of_a_block():
    """By hand: white, seen along each axis from both sides; 1/255, rounded half up, leaves the register itself."""
    voxels = np.zeros((4, 4, 4), np.uint8)
    voxels[1, 1, 1] = 9
    white = np.full((256, 3), 255, np.uint8)
    faces = np.array([189, 188, 140, 255, 219, 218], np.uint8)
    seen = {}
    for axis in range(3):
        for upper in (0, 1):
            position, look = [24, 24, 24], [0, 0, 0]
            position[axis], look[axis] = (200, -9) if upper else (-100, 9)
            camera = np.array([position, look, [0, 0, 0], [0, 0, 0]], np.int32)
            for config, design in TRACERS.items():
                design.load(words_of(voxels))
                got = design.render(camera, 1, 1, 2, white, brightness=faces)
                seen[config, 2 * axis + upper] = got["colour"][0, 0].tolist()
    assert seen == {(config, face): [value] * 3 for config in TRACERS for face, value in enumerate(faces.tolist())}


@pytest.mark.parametrize("config", SHADING)
@pytest.mark.parametrize("seed", range(30))
def test_as_the_model(config, seed):
    rng = np.random.default_rng([seed, 3])
    depth = int(rng.integers(1, 6))
    voxels = random_voxels(rng, depth, rng.choice([0, 0.01, 0.1, 0.4]))
    words = words_of(voxels)
    design = TRACERS[config]
    design.load(words)
    model = _model.Memory(words, depth)
    for _ in range(8):
        camera = random_camera(rng, len(voxels))
        width, height = (int(n) for n in rng.integers(1, 50, 2))
        shading = random_shading(rng, len(voxels), camera)
        expected = model.render(MATERIALS, camera, width, height, **shading)
        got = design.render(
            camera, width, height, depth, MATERIALS, stall_seed=int(rng.integers(2) * rng.integers(2**32)), **shading
        )
        assert_equal(got, (expected.colour, expected.material, expected.face), (camera, shading))


def room():
    """A closed room of mirrors, with two blocks in it."""
    voxels = np.ones((8, 8, 8), np.uint8)
    voxels[1:7, 1:7, 1:7] = 0
    voxels[2, 1, 4] = 2
    voxels[5, 3:5, 5] = 7
    return voxels


INTO_THE_ROOM = [[61, 70, 40], [3, -2, 20], [2, 0, 0], [0, 2, 0]]


@pytest.mark.parametrize("bounces", [1, 14, 15])
def test_mirrors_that_face_each_other(bounces):
    got = assert_as_the_oracle(room(), INTO_THE_ROOM, 12, 12, bounces=bounces, mirrors=flags(1), light=at(40, 90, 40))
    assert set(np.unique(got["material"])) == {1, 2, 7}


def test_a_corridor_of_two_mirrors_along_an_axis():
    voxels = np.zeros((8, 8, 8), np.uint8)
    voxels[1], voxels[6] = 3, 4
    still = [[0, 0, 0], [0, 0, 0]]
    for position, look in (([50, 40, 40], [5, 0, 0]), ([32, 48, 48], [-7, 0, 0]), ([50, 40, 40], [1000, 1, 2])):
        assert_as_the_oracle(voxels, [position, look, *still], 1, 1, bounces=15, mirrors=flags(3, 4))


@pytest.mark.parametrize("look", [[9, 1, 2], [-9, 4, 0], [0, 0, 5], [0, 0, 0]])
def test_a_camera_in_a_mirror_sees_its_colour(look):
    frame = [[24, 56, 56], look, [0, 0, 1], [0, 1, 0]]
    voxels = room()
    voxels[1, 3, 3] = 2
    got = assert_as_the_oracle(voxels, frame, 3, 3, bounces=4, mirrors=flags(2), light=at(60, 60, 60))
    assert (got["face"] == 3).all()
    np.testing.assert_array_equal(got["colour"], np.broadcast_to(MATERIALS[2], (3, 3, 3)))


def test_mirrors_on_the_worlds_own_sides_show_the_background():
    for voxels in (np.ones((4, 4, 4), np.uint8), np.ones((2, 2, 2), np.uint8)):
        for position in ([-20, 12, 13], [200, 13, 12], [12, -30, 13], [13, 12, 300]):
            look = [24 - p for p in position]
            got = assert_as_the_oracle(
                voxels, [position, look, [1, 0, 1], [0, 1, 0]], 5, 5, bounces=3, mirrors=flags(1)
            )
            assert (got["material"] == 0).all()


@pytest.mark.parametrize(
    "light",
    [
        (24, 24, 72),  # in a solid
        (40, 18, 68),  # in the voxel that is seen, on its face
        (32, 16, 64),  # on a corner of voxels
        (61, 70, 40),  # in the camera
        (61, 16, 40),  # in the floor's plane
        (61, 17, 40),
        (0, 0, 0),
        (128, 128, 128),
        (64, 16, 2**18),
        (-(2**18), 2**18, 2**18),
    ],
)
@pytest.mark.parametrize("material", [1, 0])
def test_a_light_anywhere(light, material):
    voxels = room()
    voxels[voxels == 1] = material
    voxels[:, 0] = 9
    assert_as_the_oracle(voxels, INTO_THE_ROOM, 12, 12, light=at(*light), ambient=20)
    assert_as_the_oracle(
        voxels, INTO_THE_ROOM, 6, 6, light=at(*light), ambient=20, flat=True, bounces=2, mirrors=flags(9)
    )


def test_a_world_of_one_lit_leaf():
    voxels = np.full((4, 4, 4), 6, np.uint8)
    for position in ([32, 32, 32], [-32, 30, 35], [-32, 70, 100], [64, 32, 32]):
        frame = [position, [32 - p for p in position], [0, 0, 16], [0, 16, 0]]
        assert_as_the_oracle(voxels, frame, 7, 7, light=at(-90, 80, 20), ambient=3)


def test_far_cameras_and_steep_directions():
    voxels = random_voxels(np.random.default_rng(3), 3, 0.2)
    for position in ([64, 64, -65536], [65535, 65535, 65535], [-65536, 64, 64]):
        look = [int(np.sign(64 - p)) * min(abs(64 - p), 32767) // 2 for p in position]
        frame = [position, look, [200, 3, 0], [0, 100, 77]]
        assert_as_the_oracle(voxels, frame, 3, 3, bounces=15, mirrors=flags(*range(0, 256, 2)), light=at(100, 200, -90))


@needs_shading
def test_the_deepest_world_and_the_farthest_mirrors(config):
    """Two mirrors, one voxel thick, at opposite sides of the largest world: origins move as far as they can."""
    design = TRACERS[config]
    depth = design.max_depth
    words = [1, *[9, 17] * 4]
    for level in range(1, depth):
        low, high = 9 + 16 * level, 17 + 16 * level
        if level + 1 == depth:
            low, high = 0xFFFFFF02, 0xFFFFFF03
        words += [low, 0xFFFFFF00] * 4 + [0xFFFFFF00, high] * 4
    words = np.array(words, np.uint32)
    model = _model.Memory(words, depth)
    design.load(words)
    side = 16 << depth
    steps = [[0, 40, -70], [0, 80, 10]]
    for position, look in (
        ([side // 2 - 40, side // 2 - 24, side // 2 - 8], [30000, 10, -15]),
        ([17, side // 2, side // 2 + 1], [32767, 0, 5]),
        ([side - 17, 5, side - 3], [-32767, 1000, -900]),
    ):
        camera = np.array([position, look, *steps], np.int32)
        shading = PLAIN | {"bounces": 15, "mirrors": flags(2, 3)}
        expected = model.render(MATERIALS, camera, 24, 16, **shading)
        got = design.render(camera, 24, 16, depth, MATERIALS, **shading)
        assert_equal(got, (expected.colour, expected.material, expected.face), config)
        assert (got["material"] > 0).mean() > 0.3


def some_leaves(rng, depth, blocks):
    """Make a memory with leaves of every size, at most so many blocks and those of a level more."""
    words, pending = [0], [0]
    for _ in range(depth):
        following = []
        for address in pending:
            words[address] = len(words)
            following += [len(words) + octant for octant in np.flatnonzero(rng.random(8) < 0.4)]
            words += [0xFFFFFF00 | int(material) for material in rng.choice([0, 0, 0, 0, 2, 3, 4], 8)]
        if not following or len(words) > 8 * blocks:
            break
        pending = following
    return np.array(words, np.uint32)


@needs_shading
@pytest.mark.parametrize("seed", range(12))
def test_hit_points_in_leaves_of_any_size(config, seed):
    rng = np.random.default_rng([seed, 5])
    design = TRACERS[config]
    depth = int(rng.integers(1, design.max_depth + 1))
    words = some_leaves(rng, depth, 400)
    model = _model.Memory(words, depth)
    design.load(words)
    side, reach = 16 << depth, 2**17
    for _ in range(4):
        near = rng.integers(0, side, 3)
        camera = random_camera(rng, 1 << depth)
        camera[0] = np.where(rng.random(3) < 0.3, near // 16 * 16, near)
        shading = random_shading(rng, 1 << depth, camera)
        shading["light"] = (near + rng.integers(-reach, reach, 3) // rng.integers(1, 100)).astype(np.int32)
        width, height = (int(n) for n in rng.integers(1, 40, 2))
        expected = model.render(MATERIALS, camera, width, height, **shading)
        stall_seed = int(rng.integers(2) * rng.integers(2**32))
        got = design.render(camera, width, height, depth, MATERIALS, stall_seed=stall_seed, **shading)
        got["errors"] = [error for error in got["errors"] if error != "direction overflow"]
        assert_equal(got, (expected.colour, expected.material, expected.face), config)


@needs_shading
def test_a_light_too_far_is_flagged_and_all_is_in_shadow(config):
    design = TRACERS[config]
    voxels = np.zeros((4, 4, 4), np.uint8)
    voxels[:, 0] = 5
    design.load(words_of(voxels))
    camera = np.array([[32, 60, -40], [0, -20, 80], [9, 0, 0], [0, 9, 0]], np.int32)
    got = design.render(camera, 12, 8, 2, MATERIALS, light=at(0, 2**19 + 16, 0), ambient=64)
    assert got["errors"] == ["direction overflow"]
    floor = (got["material"] == 5) & (got["face"] == 1)
    assert floor.any()
    np.testing.assert_array_equal(
        np.unique(got["colour"][floor], axis=0), [(MATERIALS[5].astype(int) * 128 + 256) // 512]
    )
    got = design.render(camera, 12, 8, 2, MATERIALS, light=at(0, 2**19 + 15, 0), ambient=64)
    assert got["errors"] == []


@needs_shading
@pytest.mark.parametrize(
    "words",
    [
        [1, 1, 1, 1, 1, 1, 1, 1, 1],
        [1, 9, 9, 9, 9, 9, 9, 9, 9, *[1, 0xFFFFFF01] * 4],
        [1, *[0xFFFFFF00, 0xFFFFFF01] * 3, 2, 0x40000001],
        [2],
    ],
)
def test_no_memory_makes_it_hang(config, words):
    design = TRACERS[config]
    design.load(np.array(words, np.uint32))
    camera = np.array([[-160, 60, 70], [100, 1, 2], [0, 0, 9], [0, 9, 0]], np.int32)
    for bounces, light in ((15, None), (0, at(-90, 300, 60)), (15, at(-90, 300, 60))):
        got = design.render(camera, 16, 16, 5, MATERIALS, bounces=bounces, light=light, mirrors=np.ones(256, np.uint8))
        assert got["material"].shape == (16, 16)
    design.load(np.random.default_rng(1).integers(0, 2**32, 800, dtype=np.uint32) & np.uint32(0x80000FF9) | 1)
    design.render(camera, 30, 30, 5, MATERIALS, bounces=15, light=at(-90, 300, 60), mirrors=np.ones(256, np.uint8))


@needs_shading
def test_the_picture_is_the_same_under_any_back_pressure(config):
    design = TRACERS[config]
    design.load(words_of(room()))
    camera = np.array(INTO_THE_ROOM, np.int32)
    shading = {"bounces": 6, "mirrors": flags(1), "light": at(40, 90, 40), "ambient": 10}
    free = design.render(camera, 61, 47, 3, MATERIALS, **shading)
    for seed in range(1, 6):
        stalled = design.render(camera, 61, 47, 3, MATERIALS, stall_seed=seed, **shading)
        for key in ("colour", "material", "face", "words_read"):
            np.testing.assert_array_equal(free[key], stalled[key])


@needs_shading
def test_shading_of_one_frame_does_not_show_in_the_next(config):
    design = TRACERS[config]
    design.load(words_of(room()))
    camera = np.array(INTO_THE_ROOM, np.int32)
    plain = design.render(camera, 30, 30, 3, MATERIALS)
    brightness = np.array([189, 189, 140, 255, 219, 219], np.uint8)
    design.render(
        camera, 30, 30, 3, MATERIALS, light=at(40, 90, 40), bounces=3, mirrors=flags(1), brightness=brightness
    )
    again = design.render(camera, 30, 30, 3, MATERIALS, mirrors=flags(1))
    for key in plain:
        np.testing.assert_array_equal(plain[key], again[key])


@pytest.mark.parametrize("config", rtl.CONFIGS)
def test_what_is_not_built_in_is_refused(config):
    design = TRACERS[config]
    design.load(np.array([0xFFFFFF01], np.uint32))
    camera = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0]], np.int32)
    settings = {"light": {"light": at(1, 2, 3)}, "mirrors": {"bounces": 1}}
    for feature in ALL - set(rtl.FEATURES[config]):
        with pytest.raises(ValueError, match="not been built with"):
            design.render(camera, 1, 1, 1, MATERIALS, **settings[feature])
    for wrong in ({"bounces": 16}, {"ambient": 256}, {"light": at(0, 0, design.light_limit)}):
        if set(rtl.FEATURES[config]) == ALL:
            with pytest.raises(ValueError, match="is not in"):
                design.render(camera, 1, 1, 1, MATERIALS, **wrong)
