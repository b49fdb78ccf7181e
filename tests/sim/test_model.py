"""The exact model against walks from voxel to voxel."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import ray
from oracles.adversary import adversarial_cameras, adversarial_rays
from oracles.cuts import memory_of
from oracles.planes import assert_planes
from oracles.ray_batch import trace_batch
from oracles.worlds import WORLDS

from voxrt.sim import Camera, _model, pixel_directions

RAYS_A_WORLD = 13_000


def trace(voxels, origins, directions, **cut):
    return _model.Memory(memory_of(voxels, **cut), len(voxels).bit_length() - 1).trace(origins, directions)


@pytest.fixture(scope="module", params=WORLDS, ids=lambda name: name.replace(" ", "-"))
def world(request):
    return WORLDS[request.param]


def test_every_ray_meets_what_the_walk_meets(world):
    origins, directions = adversarial_rays(len(world), RAYS_A_WORLD, seed=len(world))
    material, face, cell = trace_batch(world, origins, directions)
    traced = trace(world, origins, directions)
    wrong = (traced.material != material) | (traced.face != face) | np.any(traced.cell != cell, axis=1)
    rays = [(origins[i].tolist(), directions[i].tolist()) for i in np.flatnonzero(wrong)[:3]]
    assert not np.any(wrong), f"{np.count_nonzero(wrong)} rays are wrong, such as {rays}"


def test_the_walk_of_many_rays_is_the_rational_one(world):
    origins, directions = adversarial_rays(len(world), 250, seed=99)
    material, face, _ = trace_batch(world, origins, directions)
    for i in range(len(origins)):
        assert (material[i], face[i]) == ray.trace(world, origins[i], directions[i])


def test_the_hit_does_not_depend_on_how_the_octree_is_cut(world):
    origins, directions = adversarial_rays(len(world), 5_000, seed=5)
    whole = trace(world, origins, directions)
    for cut in ({"share": False}, {"split": True}, {"share": False, "split": True}):
        other = trace(world, origins, directions, **cut)
        for what in ("material", "face", "cell"):
            np.testing.assert_array_equal(getattr(whole, what), getattr(other, what))


def test_rays_from_far_away_meet_what_they_meet_from_near(world):
    # The wide keys: origins moved back along their own rays, as far as 32 bits go.
    side = len(world)
    origins, directions = adversarial_rays(side, 5_000, seed=6)
    first = np.where(directions > 0, origins < 0, (directions < 0) & (origins > 16 * side))
    outside = np.any(first, axis=1)
    origins, directions = origins[outside].astype(np.int64), directions[outside].astype(np.int64)
    room = (2**31 - 1 - np.abs(origins)) // np.maximum(np.abs(directions), 1)
    back = np.min(np.where(directions != 0, room, 2**31), axis=1, keepdims=True)
    far = origins - directions * back
    assert np.mean(np.any(np.abs(far) > 2**30, axis=1)) > 0.9
    near = trace(world, origins.astype(np.int32), directions.astype(np.int32))
    away = trace(world, far.astype(np.int32), directions.astype(np.int32))
    for what in ("material", "face", "cell"):
        np.testing.assert_array_equal(getattr(near, what), getattr(away, what))


def test_a_world_of_depth_16_is_walked_to_its_voxels():
    # A dust: the lowest and the highest voxel of the lowest and the highest octant, and so on down 16 levels.
    depth, words = 16, [1]
    for level in range(depth):
        block = [0xFFFFFF00] * 8
        for octant in (0, 7):
            block[octant] = len(words) + 8 if level < depth - 1 else 0xFFFFFF05 + octant
        words += block
    words = np.array(words, np.uint32)
    end = 16 << depth
    origins = np.array([[8, 8, -8], [end - 8, end - 8, end + 8], [8, 8, end + 8], [-8, -8, -8]], np.int32)
    directions = np.array([[0, 0, 1], [0, 0, -(2**20) + 1], [0, 0, -1], [2**20 - 1, 2**20 - 1, 2**20 - 1]], np.int32)
    traced = _model.Memory(words, depth).trace(origins, directions)
    last = (1 << depth) - 1
    assert traced.cell.tolist() == [[0, 0, 0], [last, last, last], [0, 0, 0], [0, 0, 0]]
    assert traced.material.tolist() == [5, 12, 5, 5]
    assert traced.face.tolist() == [2, 2, 2, 2]


CAMERAS = {
    "outside": ([-200, 150, 900], [60, -20, -100], [3, 0, 2], [-1, 3, 1]),
    "inside": ([250, 250, 250], [7, 7, 40], [2, 0, 0], [0, 2, 0]),
    "on a plane, along an axis": ([256, 256, 0], [0, 0, 30], [1, 0, 0], [0, 1, 0]),
    "no direction at all": ([256, 256, 256], [0, 0, 0], [1, 0, 0], [0, 1, 0]),
    "all directions zero, in a solid": ([0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]),
}


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("size", [(24, 17), (1, 1), (2, 31)])
def test_a_frame_is_the_oracles_pixel_by_pixel(camera, size):
    voxels = WORLDS["sparse noise"].copy()
    voxels[0, 0, 0] = 77
    palette = np.random.default_rng(7).integers(0, 256, (256, 3), dtype=np.uint8)
    registers = np.array(camera, np.int32)
    frame = _model.Memory(memory_of(voxels), 5).render(palette, registers, *size)
    assert_planes(frame, ray.render(voxels, registers, *size, palette))


@pytest.mark.parametrize("instructions", _model.INSTRUCTION_SETS)
@pytest.mark.parametrize("name", WORLDS)
def test_frames_are_what_the_walk_meets_with_every_instruction_set(name, instructions):
    voxels = WORLDS[name]
    depth = len(voxels).bit_length() - 1
    words = memory_of(voxels)
    palette = np.random.default_rng(12).integers(0, 256, (256, 3), dtype=np.uint8)
    for registers in adversarial_cameras(len(voxels), 12, seed=depth):
        size = (45, 29)
        frame = _model.Memory(words, depth).render(palette, registers, *size, 1, instructions)
        camera = Camera(*(tuple(triple) for triple in registers.tolist()))
        directions = pixel_directions(camera, size).reshape(-1, 3)
        material, face, _ = trace_batch(voxels, np.broadcast_to(registers[0], directions.shape), directions)
        np.testing.assert_array_equal(frame.material.reshape(-1), material)
        np.testing.assert_array_equal(frame.face.reshape(-1), face)
        np.testing.assert_array_equal(frame.colour.reshape(-1, 3), shades(palette[material], directions, face))


def shades(colours, directions, face):
    """Round c d_a² / |d|² half up, in whole numbers; without a face, c."""
    square = directions**2
    across = np.take_along_axis(square, np.minimum(face, 2)[:, None].astype(np.int64), axis=1)
    length = np.maximum(square.sum(axis=1, keepdims=True), 1)
    lit = (2 * colours.astype(np.int64) * across + length) // (2 * length)
    return np.where(face[:, None] == 3, colours, lit)


def test_an_instruction_set_that_is_not_there_is_refused():
    memory = _model.Memory(np.array([0xFFFFFF00], np.uint32), 1)
    with pytest.raises(ValueError, match="no instruction set 'mmx'"):
        memory.render(np.zeros((256, 3), np.uint8), np.ones((4, 3), np.int32), 4, 4, 1, "mmx")


@settings(max_examples=300, deadline=None)
@given(colour=st.integers(0, 255), direction=st.tuples(*[st.integers(-(2**20) + 1, 2**20 - 1)] * 3).filter(any))
def test_the_shade_is_rounded_half_up(colour, direction):
    # One solid world seen from outside, along `direction`.
    words = np.array([0xFFFFFF01], np.uint32)
    palette = np.full((256, 3), colour, np.uint8)
    palette[0] = 0
    middle = [16 - 40 * d // max(map(abs, direction)) for d in direction]
    registers = np.array([middle, direction, [0, 0, 0], [0, 0, 0]], np.int32)
    frame = _model.Memory(words, 1).render(palette, registers, 1, 1)
    if frame.material[0, 0]:
        expected = ray.shade([colour] * 3, direction, int(frame.face[0, 0]))
        assert tuple(frame.colour[0, 0]) == expected


@pytest.mark.parametrize("threads", [1, 2, 7])
def test_the_frame_does_not_depend_on_the_threads(threads):
    words = memory_of(WORLDS["boxes"])
    palette = np.arange(768, dtype=np.uint64).astype(np.uint8).reshape(256, 3)
    registers = np.array(([-300, 900, 1500], [40, -20, -60], [2, 0, 1], [0, 2, 0]), np.int32)
    frames = [_model.Memory(words, 6).render(palette, registers, 75, 50, count) for count in (1, threads)]
    for what in ("colour", "material", "face", "words_read"):
        np.testing.assert_array_equal(getattr(frames[0], what), getattr(frames[1], what))
    assert len(np.unique(frames[0].material)) > 3


@pytest.mark.parametrize(
    ("words", "depth", "message"),
    [
        ([0xFFFFFF00], 0, "depth 0"),
        ([0xFFFFFF00], 17, "depth 17"),
        ([], 4, "not 0"),
        ([1] + [0xFFFFFF00] * 7, 4, "not 8"),
        ([9] + [0xFFFFFF00] * 8, 4, "word 0 .* outside"),
        ([0x7FFFFFF9] + [0xFFFFFF00] * 8, 4, "word 0 .* outside"),
        ([2] + [0xFFFFFF00] * 8, 4, "word 0 .* no block"),
        ([1] + [0xFFFFFF00] * 7 + [1], 4, "word 8 .* cyclic"),
        ([1] + [0xFFFFFF00] * 7 + [9] + [0xFFFFFF00] * 8, 1, "word 8 .* deeper"),
        ([0x80000001], 4, "word 0 .* neither"),
    ],
)
def test_a_memory_that_is_not_one_is_refused(words, depth, message):
    with pytest.raises(ValueError, match=message):
        _model.Memory(np.array(words, np.uint32), depth)


@settings(max_examples=200, deadline=None)
@given(st.lists(st.sampled_from([1, 9, 17, 25, 0xFFFFFF00, 0xFFFFFF00, 0xFFFFFF03, 33, 0]), min_size=25, max_size=25))
def test_any_memory_is_traced_or_refused(words):
    origins, directions = adversarial_rays(64, 64, seed=8)
    try:
        memory = _model.Memory(np.array(words, np.uint32), 6)
    except ValueError:
        return
    traced = memory.trace(origins, directions)
    assert set(np.unique(traced.material)) <= {0, 3}


def test_directions_out_of_range_are_refused():
    words = np.array([0xFFFFFF00], np.uint32)
    with pytest.raises(ValueError, match=r"direction 0 reaches 1048576 on axis y"):
        _model.Memory(words, 1).trace(np.zeros((1, 3), np.int32), np.array([[0, 1 << 20, 0]], np.int32))
    registers = np.array([[0, 0, 0], [0, 0, 1 << 19], [1 << 14, 0, 0], [0, 0, 0]], np.int32)
    with pytest.raises(ValueError, match=r"pixel \(0, 0\) reaches -1048576 on axis x"):
        _model.Memory(words, 1).render(np.zeros((256, 3), np.uint8), registers, 128, 4)
