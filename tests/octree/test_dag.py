"""Sparse voxel DAGs: voxels read word by word, and counts against a search of all cubes of dense arrays."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voxrt import octree
from voxrt.octree import RomError
from voxrt.voxelize import DoesNotFitError


def solid_voxels(words, depth):
    """Expand a graph by its definition in the manual."""
    solid = np.zeros((1 << depth,) * 3, np.bool_)

    def visit(address, level, corner):
        if level == 2:
            bits = int(words[address]) | int(words[address + 1]) << 32
            for x, y, z in np.ndindex(4, 4, 4):
                solid[corner[0] + x, corner[1] + y, corner[2] + z] = bits >> (x + 4 * y + 16 * z) & 1
            return
        child = address
        for octant in range(8):
            if int(words[address]) >> octant & 1:
                child += 1
                half = 1 << (level - 1)
                offset = [half * (octant >> axis & 1) for axis in range(3)]
                visit(int(words[child]), level - 1, [a + b for a, b in zip(corner, offset, strict=True)])

    if len(words):
        visit(0, depth, [0, 0, 0])
    return solid


def cubes_of(cells, level):
    """All aligned cubes of a level that are not empty, as arrays."""
    side = 1 << level
    corners = np.ndindex(*(size // side for size in cells.shape))
    cubes = [cells[tuple(slice(side * c, side * c + side) for c in corner)] for corner in corners]
    return [cube for cube in cubes if cube.any()]


def canonical(cube):
    """The least of the bytes of a cube's eight mirror images."""
    mirrors = [[axis for axis in range(3) if mirror >> axis & 1] for mirror in range(8)]
    return min(np.flip(cube, axes).tobytes() for axes in mirrors)


def words_of(level, cube):
    if level == 2:
        return 2
    return 1 + len(cubes_of(cube, level - 1))


@st.composite
def dense_cells(draw, materials=3):
    """Cells of a world of 16 voxels per side: random cubes of small random patterns, some of them mirrored."""
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    density = draw(st.sampled_from([0.02, 0.3, 1.0]))
    patterns = []
    for _ in range(3):
        pattern = random.integers(1, materials + 1, (4, 4, 4)) * (random.random((4, 4, 4)) < density)
        if random.random() < 0.5:
            pattern = np.maximum(pattern, np.flip(pattern, int(random.integers(3))))
        patterns.append(pattern)
    cells = np.zeros((16, 16, 16), np.uint8)
    filled = draw(st.sampled_from([0.1, 0.6, 1.0]))
    for corner in np.ndindex(4, 4, 4):
        if random.random() < filled:
            axes = [axis for axis in range(3) if random.random() < 0.5]
            cells[tuple(slice(4 * c, 4 * c + 4) for c in corner)] = np.flip(patterns[random.integers(3)], axes)
    if draw(st.booleans()):
        cells = np.maximum(cells, np.flip(cells, draw(st.integers(0, 2))))
    return cells


@settings(max_examples=20, deadline=None)
@given(cells=dense_cells())
def test_a_graph_has_the_voxels_of_the_memory(cells):
    graph = octree.occupancy_dag(octree.from_dense(cells))
    np.testing.assert_array_equal(solid_voxels(graph.words, 4), cells != 0)
    np.testing.assert_array_equal(octree.to_dense(graph.octree()), cells != 0)
    again = octree.from_dense((cells != 0).astype(np.uint8))
    assert bytes(graph.octree().words) == bytes(again.words)
    assert bytes(octree.occupancy_dag(again).words) == bytes(graph.words)


@settings(max_examples=20, deadline=None)
@given(cells=dense_cells())
def test_counts_are_those_of_all_cubes(cells):
    counts = octree.dag_census(octree.from_dense(cells))
    solid = cells != 0
    assert counts.tree_nodes[:2].tolist() == [solid.sum(), len(cubes_of(solid, 1))]
    assert not any(np.any(part[:2]) for part in (counts.nodes, counts.words, counts.mirrored_nodes))
    for level in (2, 3, 4):
        cubes = cubes_of(solid, level)
        distinct = {cube.tobytes(): words_of(level, cube) for cube in cubes}
        mirrored = {canonical(cube): words_of(level, cube) for cube in cubes}
        assert counts.tree_nodes[level] == len(cubes)
        assert counts.tree_words[level] == sum(words_of(level, cube) for cube in cubes)
        assert (counts.nodes[level], counts.words[level]) == (len(distinct), sum(distinct.values()))
        assert counts.mirrored_nodes[level] == len(mirrored)
        assert counts.mirrored_words[level] == sum(mirrored.values())
    assert len(octree.occupancy_dag(octree.from_dense(cells)).words) == counts.words.sum()


def octants_of(cube):
    half = len(cube) // 2
    return [cube[x : x + half, y : y + half, z : z + half] for z in (0, half) for y in (0, half) for x in (0, half)]


def pattern(cube):
    """A cube as nested octants, each uniform one as its material: what a block is whatever its size."""
    if (cube == cube[0, 0, 0]).all():
        return int(cube[0, 0, 0])
    return tuple(pattern(octant) for octant in octants_of(cube))


@settings(max_examples=20, deadline=None)
@given(cells=dense_cells())
def test_mirrored_blocks_are_those_of_all_patterns(cells):
    blocks = set()

    def visit(cube):
        if isinstance(pattern(cube), tuple):
            mirrors = [[axis for axis in range(3) if mirror >> axis & 1] for mirror in range(8)]
            blocks.add(min(repr(pattern(np.flip(cube, axes))) for axes in mirrors))
            for octant in octants_of(cube):
                visit(octant)

    visit(cells)
    assert octree.mirrored_blocks(octree.from_dense(cells)) == len(blocks)


def test_worlds_without_and_with_all_voxels():
    empty = octree.from_dense(np.zeros((8, 8, 8), np.uint8))
    graph = octree.occupancy_dag(empty)
    assert len(graph.words) == 0
    assert not octree.to_dense(graph.octree()).any()
    assert not octree.dag_census(empty).tree_nodes.any()
    full = octree.from_dense(np.full((8, 8, 8), 9, np.uint8))
    graph = octree.occupancy_dag(full)
    assert graph.words.tolist() == [0xFF, *[9] * 8, 0xFFFFFFFF, 0xFFFFFFFF]
    assert graph.octree().words.tolist() == [0xFFFFFF01]
    counts = octree.dag_census(full)
    assert counts.tree_nodes.tolist() == [512, 64, 8, 1]
    assert counts.mirrored_nodes.tolist() == [0, 0, 1, 1]


def test_a_world_of_depth_1_has_no_graph():
    tree = octree.from_dense(np.ones((2, 2, 2), np.uint8))
    for count in (octree.occupancy_dag, octree.dag_census):
        with pytest.raises(DoesNotFitError, match="2 levels or more, and the octree 1"):
            count(tree)


@pytest.mark.parametrize(
    ("words", "depth", "message"),
    [
        ([0], 3, r"word 0 is no child mask of 1 \.\.\. 255"),
        ([0x101, 1], 3, r"word 0 is no child mask of 1 \.\.\. 255"),
        ([3, 2], 3, "word 0 begins a node that ends behind the last word"),
        ([1, 2], 3, "word 1 leads behind the last word"),
        ([1, 1], 3, "word 1 begins a node that ends behind the last word"),
        ([1, 2, 0, 0], 3, "word 2 begins a node without solid voxels"),
        ([1], 2, "word 0 begins a node that ends behind the last word"),
        ([1, 0], 1, r"depth 1 is outside 2 \.\.\. 16"),
        ([1, 0], 17, r"depth 17 is outside 2 \.\.\. 16"),
    ],
)
def test_words_that_are_no_graph_are_refused(words, depth, message):
    with pytest.raises(RomError, match=message):
        octree.OccupancyDag(depth, np.array(words, np.uint32)).octree()


def test_a_pointer_to_its_own_node_ends():
    # Its levels end after 14 steps, whatever the words say.
    graph = octree.OccupancyDag(16, np.array([1, 0], np.uint32))
    assert octree.census(graph.octree()).solid_voxels == 1
