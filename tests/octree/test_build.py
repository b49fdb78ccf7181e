import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.octree import reference_words, voxels_from_dense
from oracles.random_worlds import dense_cubes

from voxrt import octree
from voxrt.voxelize import DoesNotFitError, Voxels

GOLDEN = Path(__file__).parent / "golden"


@given(dense_cubes())
def test_from_dense_is_the_reference_recursion(cube):
    tree = octree.from_dense(cube)
    assert tree.depth == len(cube).bit_length() - 1
    np.testing.assert_array_equal(tree.words, reference_words(cube))


@given(dense_cubes(), st.integers(0, 99))
def test_build_is_the_reference_recursion_however_the_voxels_are_cut(cube, seed):
    rng = random.Random(seed)
    voxels = voxels_from_dense(cube, lambda: rng.random() < 0.3)
    tree = octree.build(voxels)
    assert tree.depth == voxels.depth
    np.testing.assert_array_equal(tree.words, reference_words(cube))


@given(st.data())
@settings(max_examples=30)
def test_from_dense_pads_to_a_cube(data):
    shape = data.draw(st.tuples(*[st.integers(1, 20)] * 3))
    rng = np.random.default_rng(data.draw(st.integers(0, 99)))
    block = rng.integers(0, 3, shape).astype(data.draw(st.sampled_from(["uint8", "int8", "int64", "uint16"])))
    side = max(2, 1 << (max(shape) - 1).bit_length())
    cube = np.zeros((side,) * 3, int)
    cube[tuple(map(slice, shape))] = block
    for order in (block, np.asfortranarray(block), block[::-1][::-1]):
        np.testing.assert_array_equal(octree.from_dense(order).words, reference_words(cube))


@pytest.mark.parametrize("path", sorted(GOLDEN.glob("*.mem.ref")), ids=lambda p: p.name)
def test_golden_words(path):
    head, *text = path.read_text().splitlines()
    side, *boxes = head.removeprefix("// ").split(" ; ")
    cube = np.zeros((int(side),) * 3, int)
    for box in boxes:
        x0, y0, z0, x1, y1, z1, material = map(int, box.split())
        cube[x0:x1, y0:y1, z0:z1] = material
    assert [f"{word:08X}" for word in octree.from_dense(cube).words] == [line[:8] for line in text]


@pytest.mark.parametrize("depth", [1, 2, 3, 7, 16])
def test_nothing_is_one_word(depth):
    empty = voxels_from_dense(np.zeros((2, 2, 2)))
    tree = octree.build(Voxels(depth, *[getattr(empty, n) for n in Voxels.__struct_fields__ if n != "depth"]))
    assert tree.words.tolist() == [0xFFFFFF00]
    assert tree.blocks == 0


def test_a_solid_world_of_the_largest_depth_is_one_word():
    empty = voxels_from_dense(np.zeros((8, 8, 8)))
    tree = octree.build(
        Voxels(16, empty.brick_codes, empty.brick_masks, empty.brick_materials, empty.brick_rows, empty.cells,
               np.array([0], np.uint64), np.array([16], np.uint8), np.array([9], np.uint8))
    )  # fmt: skip
    assert tree.words.tolist() == [0xFFFFFF09]


def test_the_far_corner_of_the_largest_world():
    last = np.uint64(8**13 - 1)
    tree = octree.build(
        Voxels(16, np.array([last]), np.array([[0] * 7 + [1 << 63]], np.uint64), np.array([5], np.uint8),
               np.array([-1], np.int32), np.zeros((0, 512), np.uint8), np.zeros(0, np.uint64), np.zeros(0, np.uint8),
               np.zeros(0, np.uint8))
    )  # fmt: skip
    assert tree.blocks == 16
    assert octree.census(tree).voxels == {0: 2**48 - 1, 5: 1}
    assert octree.solid_bounds(tree) == ((65535,) * 3, (65536,) * 3)
    assert octree.material_at(tree, [(65535, 65535, 65535), (65534, 65535, 65535)]).tolist() == [5, 0]


def test_words_are_read_only():
    with pytest.raises(ValueError, match="read-only"):
        octree.from_dense(np.ones((2, 2, 2), int)).words[0] = 0


def test_blocks_are_shared_across_levels():
    small = np.zeros((2, 2, 2), int)
    small[0, 0, 0] = 1
    # A corner octant of ones and a corner octant whose own corner is one: the lower level repeats nothing but leaves.
    cube = np.zeros((4, 4, 4), int)
    cube[0:2, 0:2, 0:2] = small
    cube[2:4, 2:4, 2:4] = small
    assert octree.from_dense(cube).blocks == 2


def brick(**change):
    fields = {
        "depth": 4,
        "brick_codes": np.array([1, 2], np.uint64),
        "brick_masks": np.array([[1] * 8] * 2, np.uint64),
        "brick_materials": np.array([1, 2], np.uint8),
        "brick_rows": np.array([-1, -1], np.int32),
        "cells": np.zeros((0, 512), np.uint8),
        "octant_codes": np.array([0], np.uint64),
        "octant_levels": np.array([3], np.uint8),
        "octant_materials": np.array([1], np.uint8),
    }
    return Voxels(**fields | change)


def test_the_sound_brick_builds():
    assert octree.census(octree.build(brick())).solid_voxels == 512 + 16


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"depth": 0}, "depth must be 1 ... 16"),
        ({"depth": 17}, "depth must be 1 ... 16"),
        ({"depth": 3}, "brick 0: lies outside the grid"),
        ({"brick_codes": np.array([2, 1], np.uint64)}, "brick 1: is out of Morton order"),
        ({"brick_codes": np.array([1, 1], np.uint64)}, "brick 1: is out of Morton order or overlaps"),
        ({"brick_codes": np.array([1, 8], np.uint64)}, "brick 1: lies outside the grid"),
        ({"brick_codes": np.array([1, 2**64 - 1], np.uint64)}, "brick 1: lies outside the grid"),
        ({"brick_codes": np.array([1], np.uint64)}, "the brick arrays differ in length"),
        ({"brick_masks": np.zeros((2, 8), np.uint64)}, "brick 0: is empty"),
        ({"brick_materials": np.array([0, 2], np.uint8)}, "brick 0: has neither a material nor a row"),
        ({"brick_rows": np.array([0, -1], np.int32)}, "brick 0: refers to a row of cells that is not there"),
        (
            {"brick_rows": np.array([0, -1], np.int32), "cells": np.ones((1, 512), np.uint8)},
            "brick 0: has cells that contradict its mask",
        ),
        ({"octant_levels": np.array([2], np.uint8)}, "octant 0: has a level outside 3 ... depth"),
        ({"octant_levels": np.array([5], np.uint8)}, "octant 0: has a level outside 3 ... depth"),
        ({"octant_levels": np.array([4], np.uint8)}, "brick 0: is out of Morton order or overlaps"),
        ({"octant_codes": np.array([8], np.uint64)}, "octant 0: lies outside the grid"),
        ({"octant_codes": np.array([1], np.uint64)}, "octant 0|brick 0"),
        ({"octant_materials": np.array([0], np.uint8)}, "octant 0: has no material"),
        ({"octant_materials": np.zeros(2, np.uint8)}, "the octant arrays differ in length"),
    ],
)
def test_broken_voxels_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        octree.build(brick(**change))


def test_voxels_of_another_type_are_refused():
    with pytest.raises(TypeError):
        octree.build(brick(brick_masks=np.zeros((2, 8), np.float64)))
    with pytest.raises(TypeError):
        octree.build(brick(cells=np.zeros((2, 511), np.uint8)))


def test_voxels_beyond_a_small_grid_are_refused():
    nothing = {"octant_codes": np.zeros(0, np.uint64), "octant_levels": np.zeros(0, np.uint8),
               "octant_materials": np.zeros(0, np.uint8)}  # fmt: skip
    one = {"brick_codes": np.array([0], np.uint64), "brick_materials": np.array([1], np.uint8),
           "brick_rows": np.array([-1], np.int32)}  # fmt: skip
    for depth, masks in ((1, [256] + [0] * 7), (1, [1, 1] + [0] * 6), (2, [1] + [0] * 6 + [1])):
        with pytest.raises(ValueError, match="brick 0: has voxels outside the grid"):
            octree.build(brick(depth=depth, brick_masks=np.array([masks], np.uint64), **one, **nothing))


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros((2, 2)), r"must have shape \(X, Y, Z\)"),
        (np.full((2, 2, 2), 0.5), r"materials\[0, 0, 0\] must be an integer 0 … 255, not 0.5"),
        (np.zeros((2, 0, 2), int), "must hold a voxel"),
        (np.full((2, 2, 2), -1), r"materials\[0, 0, 0\] must be an integer 0 … 255, not -1"),
        (np.full((2, 2, 2), 256), r"materials\[0, 0, 0\] must be an integer 0 … 255, not 256"),
    ],
)
def test_arrays_that_are_no_materials_are_refused(array, message):
    with pytest.raises(ValueError, match=message):
        octree.from_dense(array)


def test_an_array_beyond_the_largest_depth_is_refused():
    with pytest.raises(DoesNotFitError, match="65537 voxels per side do not fit depth 16"):
        octree.from_dense(np.zeros((65537, 1, 1), np.uint8))


@given(dense_cubes(), st.randoms())
def test_from_points_is_the_reference_recursion_in_any_order(cube, rng):
    points = np.argwhere(cube)
    order = list(range(len(points)))
    rng.shuffle(order)
    materials = cube[tuple(points.T)][order]
    twice = np.concatenate([points[order], points[order]])
    tree = octree.from_points(twice, np.concatenate([materials, 255 - materials // 2]), len(cube).bit_length() - 1)
    np.testing.assert_array_equal(tree.words, reference_words(cube))


@pytest.mark.parametrize(
    ("points", "materials", "message"),
    [
        ([[0, 0]], [1], r"points must have shape \(N, 3\)"),
        ([[0, 0, 0]], [1, 2], r"must be \(N, 3\) and \(N,\)"),
        ([[0, 0, 8]], [1], r"points\[0, 2\] must be an integer 0 … 7, not 8"),
        ([[0, -1, 0]], [1], r"points\[0, 1\] must be an integer 0 … 7, not -1"),
        ([[0, 0, 0]], [0], r"materials\[0\] must be an integer 1 … 255, not 0"),
        ([[0, 0, 0]], [256], r"materials\[0\] must be an integer 1 … 255, not 256"),
    ],
)
def test_points_that_are_none_are_refused(points, materials, message):
    with pytest.raises(ValueError, match=message):
        octree.from_points(np.array(points), np.array(materials), 3)


def shuffled_bricks(depth, count, seed):
    """Voxels of many random bricks, some alike, one and several materials, with a solid octant of half the side."""
    rng = np.random.default_rng(seed)
    bricks = 8 ** (depth - 3)
    codes = np.sort(rng.choice(bricks - bricks // 8, count, replace=False).astype(np.uint64))
    kinds = rng.integers(0, 2**64, (count // 4, 8), dtype=np.uint64, endpoint=False)
    masks = kinds[rng.integers(0, len(kinds), count)]
    rows = np.where(rng.random(count) < 0.3, 0, -1).astype(np.int32)
    rows[rows == 0] = np.arange(np.count_nonzero(rows == 0))
    solid = np.unpackbits(masks.view(np.uint8).reshape(count, 64), axis=1, bitorder="little")
    cells = (solid * rng.integers(1, 4, (count, 512)))[rows >= 0].astype(np.uint8)
    materials = np.where(rows < 0, rng.integers(1, 4, count), 0).astype(np.uint8)
    return Voxels(depth, codes, masks, materials, rows, cells, np.array([7], np.uint64),
                  np.array([depth - 1], np.uint8), np.array([9], np.uint8))  # fmt: skip


def dense_of(voxels):
    """Every voxel of `voxels`, by their definition."""
    side = 1 << voxels.depth
    dense = np.zeros((side,) * 3, np.uint8)

    def corner(codes):
        return np.stack([sum((codes >> 3 * k + axis & 1) << k for k in range(voxels.depth)) for axis in range(3)], -1)

    within = corner(np.arange(512))
    solid = np.unpackbits(voxels.brick_masks.view(np.uint8).reshape(-1, 64), axis=1, bitorder="little")
    one = solid * voxels.brick_materials[:, None]
    rows = voxels.brick_rows >= 0
    one[rows] = voxels.cells[voxels.brick_rows[rows]]
    places = (corner(voxels.brick_codes.astype(np.int64)) * 8)[:, None] + within
    dense[tuple(np.moveaxis(places, -1, 0))] = one
    for code, level, material in zip(voxels.octant_codes, voxels.octant_levels, voxels.octant_materials, strict=True):
        low = corner(np.int64(code)) << int(level)
        dense[tuple(slice(c, c + (1 << int(level))) for c in low)] = material
    return dense


@pytest.mark.parametrize("threads", [0, 1, 2, 5])
def test_many_bricks_give_the_same_bytes_on_any_number_of_threads(threads):
    voxels = shuffled_bricks(8, 12_000, 1)
    tree = octree.build(voxels, threads=threads)
    np.testing.assert_array_equal(tree.words, octree.from_dense(dense_of(voxels)).words)


def test_broken_bricks_are_refused_on_any_thread():
    voxels = shuffled_bricks(8, 12_000, 2)
    voxels.brick_masks[11_000] = 0
    with pytest.raises(ValueError, match="brick 11000: is empty"):
        octree.build(voxels, threads=3)
    for wrong in (5_000, 11_999):
        codes = voxels.brick_codes.copy()
        codes[wrong] = codes[wrong - 1]
        with pytest.raises(ValueError, match=r"is empty|Morton order"):
            octree.build(Voxels(8, codes, *(getattr(voxels, n) for n in Voxels.__struct_fields__[2:])))
