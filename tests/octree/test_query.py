import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.octree import unshared_words, walk
from oracles.random_worlds import dense_cubes

from voxrt import octree
from voxrt.voxelize import DoesNotFitError

corners = st.tuples(*[st.integers(-3, 40)] * 3)


def doubled(depth):
    """A world of 8**depth voxels in as many blocks as levels: octant 7 solid, the seven others alike."""
    words = np.full(1 + 8 * depth, 0xFFFFFF01, np.uint32)
    for level in range(depth):
        words[1 + 8 * level : 8 + 8 * level] = 1 + 8 * (level + 1) if level < depth - 1 else 0xFFFFFF00
    words[0] = 1
    return octree.decode(words, "report", depth)


def outside_is_empty(cube, low, high):
    padded = np.pad(cube, 64)
    return padded[tuple(slice(a + 64, max(a, b) + 64) for a, b in zip(low, high, strict=True))]


@given(dense_cubes())
def test_whole_world_round_trip(cube):
    for words in (octree.from_dense(cube).words, unshared_words(cube)):
        tree = octree.decode(words, "report", len(cube).bit_length() - 1)
        np.testing.assert_array_equal(tree.words, words)
        np.testing.assert_array_equal(octree.to_dense(tree), cube)


@given(dense_cubes(), st.lists(corners, max_size=40))
def test_points(cube, points):
    tree = octree.from_dense(cube)
    found = octree.material_at(tree, np.array(points, int).reshape(-1, 3))
    assert found.tolist() == [walk(tree.words, tree.depth, point) for point in points]
    everywhere = np.moveaxis(np.indices(cube.shape), 0, -1)
    np.testing.assert_array_equal(octree.material_at(tree, everywhere), cube)


def ordered(one, other):
    """The box between two corners."""
    return tuple(map(min, one, other)), tuple(map(max, one, other))


@given(dense_cubes(), corners, corners)
def test_boxes(cube, one, other):
    low, high = ordered(one, other)
    tree = octree.from_dense(cube)
    inside = cube[tuple(slice(max(a, 0), max(a, b, 0)) for a, b in zip(low, high, strict=True))]
    materials, counts = np.unique(inside, return_counts=True)
    assert octree.count_in_box(tree, low, high) == dict(zip(materials.tolist(), counts.tolist(), strict=True))
    np.testing.assert_array_equal(octree.to_dense(tree, low, high), outside_is_empty(cube, low, high))


@given(dense_cubes())
def test_census_and_bounds(cube):
    for words in (octree.from_dense(cube).words, unshared_words(cube)):
        tree = octree.decode(words, "report", len(cube).bit_length() - 1)
        materials, counts = np.unique(cube, return_counts=True)
        census = octree.census(tree)
        assert census.voxels == dict(zip(materials.tolist(), counts.tolist(), strict=True))
        assert census.solid_voxels == np.count_nonzero(cube)
        solid = np.argwhere(cube)
        expected = (tuple(solid.min(0)), tuple(solid.max(0) + 1)) if len(solid) else None
        assert octree.solid_bounds(tree) == expected


@given(dense_cubes(), corners, corners, st.booleans(), st.integers(1, 50))
def test_leaves_tile_the_box(cube, one, other, solid_only, chunk):
    low, high = ordered(one, other)
    tree = octree.from_dense(cube)
    painted = np.full(cube.shape, 99)
    before = -1
    for part in octree.leaves(tree, low, high, solid_only=solid_only, chunk=chunk):
        assert 1 <= len(part.levels) <= chunk
        for corner, level, material in zip(part.corners, part.levels, part.materials, strict=True):
            x, y, z = corner.tolist()
            side = 1 << level
            assert (painted[x : x + side, y : y + side, z : z + side] == 99).all()
            painted[x : x + side, y : y + side, z : z + side] = material
            assert x % side == y % side == z % side == 0
            assert all(c < h and c + side > lo for c, lo, h in zip((x, y, z), low, high, strict=True))
            code = int("".join(f"{z >> k & 1}{y >> k & 1}{x >> k & 1}" for k in reversed(range(5))), 2)
            assert code > before
            before = code
    inside = tuple(slice(max(a, 0), max(a, b, 0)) for a, b in zip(low, high, strict=True))
    expected = np.where((cube == 0) & solid_only, 99, cube)[inside]
    np.testing.assert_array_equal(painted[inside], expected)


def test_leaves_and_census_agree_by_level():
    cube = np.random.default_rng(4).integers(0, 2, (4, 4, 4)).repeat(4, 0).repeat(4, 1).repeat(4, 2)
    tree = octree.from_dense(cube)
    counts = np.zeros((5, 256), np.uint64)
    for part in octree.leaves(tree):
        np.add.at(counts, (part.levels, part.materials), 1)
    np.testing.assert_array_equal(octree.census(tree).leaves, counts)


@given(st.data())
def test_diff(data):
    a, b = data.draw(dense_cubes(4)), data.draw(dense_cubes(4))
    side = max(len(a), len(b))
    a, b = (np.pad(c, (0, side - len(c))) for c in (a, b))
    found = octree.diff(octree.from_dense(a), octree.from_dense(b))
    assert found.appeared == np.count_nonzero((a == 0) & (b != 0))
    assert found.vanished == np.count_nonzero((a != 0) & (b == 0))
    assert found.recoloured == np.count_nonzero((a != 0) & (b != 0) & (a != b))
    where = np.argwhere(a != b)
    assert found.bounds == ((tuple(where.min(0)), tuple(where.max(0) + 1)) if len(where) else None)
    assert found.voxels == len(where)


def pieces(differs):
    """The voxels of each piece, flooded one voxel at a time over its 26 neighbours."""
    left = {tuple(place) for place in np.argwhere(differs).tolist()}
    while left:
        piece, front = [], [left.pop()]
        while front:
            piece.append(front.pop())
            beside = {
                tuple(p + o - 1 for p, o in zip(piece[-1], offset, strict=True)) for offset in np.ndindex(3, 3, 3)
            }
            front += beside & left
            left -= beside
        yield np.array(piece)


@given(st.data())
def test_regions_are_what_hangs_together(data):
    a, b = data.draw(dense_cubes(4)), data.draw(dense_cubes(4))
    side = max(len(a), len(b))
    a, b = (np.pad(c, (0, side - len(c))) for c in (a, b))
    expected = []
    for piece in pieces(a != b):
        before, after = a[tuple(piece.T)], b[tuple(piece.T)]
        counts = [(before == 0).sum(), (after == 0).sum(), ((before != 0) & (after != 0)).sum()]
        expected.append((-len(piece), tuple(piece.min(0)), tuple(piece.max(0) + 1), *counts))
    shared = [octree.from_dense(cube) for cube in (a, b)]
    unshared = [octree.decode(unshared_words(cube), "report", side.bit_length() - 1) for cube in (a, b)]
    for first, second in (shared, unshared):
        found = [
            (-part.voxels, *part.bounds, part.appeared, part.vanished, part.recoloured)
            for part in octree.differing_regions(first, second)
        ]
        assert sorted(found) == sorted(expected)
        assert [row[:2] for row in found] == sorted(row[:2] for row in found)


def test_more_pieces_than_are_told_apart():
    """A chequered world of 2**23 voxels against an empty one: one region."""
    words = np.array([1, *[0xFFFFFF00, 0xFFFFFF01] * 4], np.uint32)
    deep = [word for level in range(8) for word in [9 + 8 * level] * 8]
    tree = octree.decode(np.array([1, *deep, *words[1:]], np.uint32), "report", 9)
    empty = octree.decode(np.array([0xFFFFFF00], np.uint32), "report", 9)
    (region,) = octree.differing_regions(empty, tree)
    assert region == octree.Region(((1, 0, 0), (512, 512, 512)), 2**26, 0, 0)


def test_a_world_far_larger_than_memory():
    """A world of 2**48 voxels in 129 words: counts come from the words, never from the voxels."""
    tree = doubled(16)
    solid = sum(7**k * 8 ** (15 - k) for k in range(16))
    assert octree.census(tree).voxels == {0: 2**48 - solid, 1: solid}
    half = octree.count_in_box(tree, (0, 0, 0), (65535, 65536, 65536))
    column = octree.count_in_box(tree, (65535, 0, 0), (65536, 65536, 65536))
    assert half[1] + column[1] == solid
    assert octree.solid_bounds(tree) == ((1, 1, 1), (65536,) * 3)
    assert octree.diff(tree, tree).voxels == 0
    assert octree.differing_regions(tree, tree) == ()
    first = next(octree.leaves(tree, solid_only=True, chunk=3))
    assert first.corners.tolist() == [[1, 1, 1], [3, 1, 1], [1, 3, 1]]
    corner = octree.to_dense(tree, (65530,) * 3, (65540,) * 3)
    assert corner[:6, :6, :6].all()
    assert not corner[6:].any()


def test_refusals():
    tree = octree.from_dense(np.ones((2, 2, 2), int))
    with pytest.raises(ValueError, match=r"points\[0, 0\] must be an integer"):
        octree.material_at(tree, [[0.5, 0, 0]])
    with pytest.raises(ValueError, match=r"points must have shape \(\.\.\., 3\)"):
        octree.material_at(tree, [[0, 0]])
    with pytest.raises(ValueError, match="below its start"):
        octree.to_dense(tree, (1, 1, 1), (0, 2, 2))
    with pytest.raises(DoesNotFitError, match="281,474,976,710,656 bytes"):
        octree.to_dense(doubled(16))
    with pytest.raises(ValueError, match=r"high\[0\] must be an integer -1048576 … 1048576, not 2097152"):
        octree.count_in_box(tree, (0, 0, 0), (2**21, 1, 1))
    with pytest.raises(ValueError, match="chunk must be an integer 1"):
        next(octree.leaves(tree, chunk=0))
    with pytest.raises(ValueError, match="depth 1 and 2"):
        octree.diff(tree, octree.from_dense(np.ones((4, 4, 4), int)))
    with pytest.raises(ValueError, match="depth 1 and 2"):
        octree.differing_regions(tree, octree.from_dense(np.ones((4, 4, 4), int)))


@pytest.mark.parametrize("words", [[], [1], [1, *[1] * 8], [9, *[0xFFFFFF00] * 8], [7], [0x7FFFFFF9] * 9])
def test_words_that_are_no_octree_never_crash_a_query(words):
    tree = octree.Octree(3, np.array(words, np.uint32))
    questions = [
        lambda: octree.material_at(tree, [[0, 0, 0], [7, 7, 7]]),
        lambda: octree.census(tree),
        lambda: octree.count_in_box(tree, (0, 0, 0), (5, 5, 5)),
        lambda: octree.solid_bounds(tree),
        lambda: octree.shared_words(tree),
        lambda: octree.to_dense(tree),
        lambda: list(octree.leaves(tree)),
        lambda: octree.diff(tree, octree.Octree(3, np.array([0xFFFFFF00], np.uint32))),
    ]
    for question in questions:
        with pytest.raises(ValueError, match="octree"):
            question()
