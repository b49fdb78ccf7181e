"""What no ray from outside reaches, and what may be made of it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.octree import reference_words, unshared_words
from oracles.random_worlds import dense_cubes

from voxrt import octree, sim
from voxrt.sim import Camera, Lighting
from voxrt.voxelize import EMPTY, Material


def hidden(cube):
    """Solid voxels with 26 solid ones around, one shift at a time; outside the world is empty."""
    padded = np.pad(cube, 1) != 0
    enclosed = np.ones(cube.shape, bool)
    for offset in np.ndindex(3, 3, 3):
        enclosed &= padded[tuple(slice(o, o + len(cube)) for o in offset)]
    return enclosed


def lumpy(depth, materials, seed=0):
    """Balls with rough skins and cavities, speckled with materials."""
    rng = np.random.default_rng(seed)
    side = 1 << depth
    grid = np.stack(np.indices((side,) * 3), -1) + 0.5
    cube = np.zeros((side,) * 3, np.uint8)
    for sign in (1, 1, 1, 0):
        centre, radius = rng.uniform(0.3, 0.7, 3) * side, rng.uniform(0.15, 0.35) * side
        skin = 0.1 * radius * np.sin(grid @ rng.normal(size=3) * 20 / side)
        cube[np.linalg.norm(grid - centre, axis=-1) < radius + skin] = sign
    return np.where(cube, rng.integers(1, materials + 1, cube.shape), 0).astype(np.uint8)


def fill_hidden(tree, material):
    return octree.fill_hidden(tree, octree.hidden_voxels(tree), material)


def share_hidden(tree):
    return octree.share_hidden(tree, octree.hidden_voxels(tree))


WORLDS = [lumpy(4, 3, seed) for seed in range(3)] + [lumpy(5, 200, 7), np.full((8, 8, 8), 5, np.uint8)]


@given(dense_cubes())
def test_hidden_voxels_are_those_with_26_solid_ones_around(cube):
    for words in (octree.from_dense(cube).words, unshared_words(cube)):
        tree = octree.decode(words, "report", len(cube).bit_length() - 1)
        np.testing.assert_array_equal(octree.hidden_voxels(tree).words, reference_words(hidden(cube)))


@pytest.mark.parametrize("cube", WORLDS)
def test_hidden_voxels_of_thicker_things(cube):
    tree = octree.from_dense(cube)
    np.testing.assert_array_equal(octree.hidden_voxels(tree).words, reference_words(hidden(cube)))
    assert hidden(cube).any()


@given(dense_cubes(), st.integers(1, 255))
def test_filling_changes_the_hidden_voxels_alone(cube, material):
    for words in (octree.from_dense(cube).words, unshared_words(cube)):
        tree = octree.decode(words, "report", len(cube).bit_length() - 1)
        expected = reference_words(np.where(hidden(cube), material, cube))
        np.testing.assert_array_equal(octree.fill_hidden(tree, octree.hidden_voxels(tree), material).words, expected)


def check_sharing(cube):
    tree = octree.from_dense(cube)
    shared = share_hidden(tree)
    shown = octree.to_dense(shared)
    np.testing.assert_array_equal(shared.words, reference_words(shown))
    np.testing.assert_array_equal(shown == 0, cube == 0)
    np.testing.assert_array_equal(np.where(hidden(cube), 0, shown), np.where(hidden(cube), 0, cube))
    assert set(np.unique(shown)) <= set(np.unique(cube))
    assert len(shared.words) <= len(tree.words)
    again = octree.decode(unshared_words(cube), "report", tree.depth)
    np.testing.assert_array_equal(share_hidden(again).words, shared.words)
    return shared


@given(dense_cubes())
def test_sharing_changes_hidden_voxels_alone(cube):
    check_sharing(cube)


@pytest.mark.parametrize("cube", WORLDS)
def test_sharing_saves(cube):
    shared = check_sharing(cube)
    materials, counts = np.unique(cube[cube > 0], return_counts=True)
    tree = octree.from_dense(cube)
    assert len(shared.words) <= len(fill_hidden(tree, int(materials[counts.argmax()])).words)
    assert len(shared.words) < len(tree.words) or len(materials) == 1


def test_sharing_leaves_alone_what_is_shared_well():
    """A box with one face of another material: 5 blocks, and more where each block is seen by itself."""
    cube = np.ones((64, 64, 64), np.uint8)
    cube[:, :, 0] = 2
    assert len(check_sharing(cube).words) == len(octree.from_dense(cube).words)


def test_blocks_that_contradict_each_other_nowhere_become_one():
    """Two voxels differ inside a solid world: a path of blocks to each, then none."""
    cube = np.full((16, 16, 16), 1, np.uint8)
    cube[4, 4, 4], cube[11, 11, 11] = 2, 3
    assert len(octree.from_dense(cube).words) > 1
    assert share_hidden(octree.from_dense(cube)).words.tolist() == [0xFFFFFF01]


def test_a_world_far_larger_than_memory():
    """2**48 solid voxels but one corner: sharing keeps the search short."""
    words = np.full(1 + 8 * 16, 0xFFFFFF01, np.uint32)
    words[0] = 1
    words[8:-1:8] = 1 + 8 * np.arange(1, 17)[: len(words[8:-1:8])]
    words[-1] = 0xFFFFFF00
    tree = octree.decode(words, "report", 16)
    side = 1 << 16
    expected = (side - 2) ** 3 - 1
    assert octree.census(octree.hidden_voxels(tree)).voxels[1] == expected


def test_refusals():
    tree = octree.from_dense(np.ones((2, 2, 2), int))
    for material in (0, 256):
        with pytest.raises(ValueError, match="material must be an integer 1 … 255"):
            octree.fill_hidden(tree, tree, material)
    other = octree.from_dense(np.ones((4, 4, 4), int))
    broken = octree.Octree(1, np.array([1], np.uint32))
    for use in (octree.share_hidden, lambda *trees: octree.fill_hidden(*trees, 1)):
        with pytest.raises(ValueError, match="of depth 2 and the octree of depth 1"):
            use(tree, other)
        with pytest.raises(ValueError, match="not a valid octree"):
            use(broken, octree.from_dense(np.zeros((2, 2, 2), int)))
    with pytest.raises(ValueError, match="not a valid octree"):
        octree.hidden_voxels(broken)


def cameras(cube, rng, count):
    """Cameras in empty voxels and outside: anywhere, on planes, edges and corners; along axes, diagonals, anywhere."""
    side = len(cube)
    exposed = np.argwhere((cube == 0) & (np.pad(cube, 1)[2:, 1:-1, 1:-1] != 0))
    for number in range(count):
        if number % 3 == 0 or not len(exposed):
            position = rng.integers(-2 * side, 3 * side, 3) * 16 + rng.integers(0, 16, 3)
        else:
            position = exposed[rng.integers(len(exposed))] * 16 + rng.integers(0, 16, 3) * (number % 3 == 1)
        voxel = position // 16
        if ((voxel >= 0) & (voxel < side)).all() and cube[tuple(voxel)]:
            continue
        axes = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1]]) * rng.choice([-1, 1], 3)[:, None] * 16
        turned = rng.integers(-40, 40, (3, 3))
        look, right, up = axes[rng.permutation(3)] if number % 2 else turned
        yield Camera(*(tuple(int(value) for value in values) for values in (position, look, right, up)))


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_pictures_are_those_of_the_whole(seed):
    """Rays with whole-number directions meet edges and corners exactly; cameras stand on them."""
    rng = np.random.default_rng(seed)
    cube = lumpy(4, 5, seed)
    colours = rng.integers(0, 256, (8, 3))
    materials = (EMPTY, *(Material(f"m{i}", tuple(int(c) for c in colours[i]), mirror=i == 3) for i in range(1, 8)))
    kept = octree.from_dense(cube)
    trees = [share_hidden(kept), fill_hidden(kept, 7)]
    roms = [octree.Rom("world", tree, materials) for tree in (kept, *trees)]
    for camera in cameras(cube, rng, 20):
        lighting = Lighting(bounces=int(rng.integers(0, 4)))
        first, *others = (
            sim.render(rom, camera, (33, 25), lighting=lighting, engine="model", threads=1) for rom in roms
        )
        for other in others:
            np.testing.assert_array_equal(other.colour, first.colour)
            np.testing.assert_array_equal(other.material, first.material)
            np.testing.assert_array_equal(other.face, first.face)


def test_a_camera_in_the_corner_of_a_room_looks_into_what_lies_behind_its_edges():
    cube = np.random.default_rng(0).integers(1, 6, (16, 16, 16)).astype(np.uint8)
    cube[6:10, 6:10, 6:10] = 0
    materials = (EMPTY, *(Material(f"m{i}", (40 * i, 0, 0)) for i in range(1, 6)))
    camera = Camera((96, 96, 96), (-16, -16, -16), (1, 0, 0), (0, 1, 0))
    shown = sim.render(octree.Rom("room", octree.from_dense(cube), materials), camera, (9, 9), engine="model")
    assert (shown.material == cube[5, 5, 5]).all()
    tree = fill_hidden(octree.from_dense(cube), 1 + cube[5, 5, 5] % 5)
    after = sim.render(octree.Rom("room", tree, materials), camera, (9, 9), engine="model")
    np.testing.assert_array_equal(after.material, shown.material)
