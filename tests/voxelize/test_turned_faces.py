"""What a surface encloses is solid, however its faces are turned, doubled or parted by walls within.

The oracle knows no surface: it floods a block of cells from outside, and stops at the walls between them.
"""

import random

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from oracles.meshes import box_mesh, icosphere, joined, one_object, scene_of, without
from oracles.voxels import dense

from voxrt.voxelize import Grid, Mesh, SceneObject, voxelize

CELL = 3  # voxels
GRID = Grid(4, (0.0, 0.0, 0.0), 1.0)
AXES = np.eye(3, dtype=int)


def kinds_of(result):
    return {warning.kind: warning.count for warning in result.warnings}


def walls_of(labels):
    """Yield (cell, axis) for each wall: between the cell and its upper neighbour, where their labels differ."""
    for axis in range(3):
        lower = np.take(labels, range(labels.shape[axis] - 1), axis)
        upper = np.take(labels, range(1, labels.shape[axis]), axis)
        for cell in np.argwhere(lower != upper):
            yield tuple(map(int, cell)), axis


def outside_of(labels):
    """Flood from a corner through equal neighbours: True where nothing encloses a cell."""
    outside = np.zeros(labels.shape, bool)
    stack = [(0, 0, 0)]
    while stack:
        cell = stack.pop()
        if outside[cell]:
            continue
        outside[cell] = True
        for step in (*AXES, *-AXES):
            beside = tuple(int(i) for i in np.array(cell) + step)
            if all(0 <= i < n for i, n in zip(beside, labels.shape, strict=True)) and labels[beside] == labels[cell]:
                stack.append(beside)
    return outside


def quad_of(cell, axis):
    corner = np.array(cell) + AXES[axis]
    u, v = AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]
    return [tuple(map(int, corner + way)) for way in (0 * u, u, u + v, v)]


def surface_of(labels, choices):
    """Return quads, each turned at random, some of them twice, and whether they are one component wound badly."""
    quads = []
    for cell, axis in walls_of(labels):
        for _ in range(choices.choice([1, 1, 1, 2])):
            quad = quad_of(cell, axis)
            start = choices.randrange(4)
            quad = quad[start:] + quad[:start]
            quads.append(quad[::-1] if choices.random() < 0.4 else quad)
    sums, sets = {}, {}

    def root(edge):
        while sets.setdefault(edge, edge) != edge:
            edge = sets[edge]
        return edge

    for quad in quads:
        edges = list(zip(quad, quad[1:] + quad[:1], strict=True))
        for edge in edges:
            key = tuple(sorted(edge))
            sums[key] = sums.get(key, 0) + (1 if edge == key else -1)
            sets[root(key)] = root(tuple(sorted(edges[0])))
    return quads, len({root(edge) for edge in list(sets)}) == 1 and any(sums.values())


def mesh_of(quads):
    positions = np.array([np.array(corner) * CELL + 1 for quad in quads for corner in quad], float)
    first = 4 * np.arange(len(quads))[:, None, None]
    triangles = (first + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3).astype(np.int32)
    return Mesh(positions, triangles, np.ones(len(triangles), np.uint8))


@settings(max_examples=150, deadline=None)
@given(
    st.lists(st.integers(0, 3), min_size=27, max_size=27).map(lambda cells: np.pad(np.reshape(cells, (3, 3, 3)), 1)),
    st.randoms(use_true_random=False),
    st.booleans(),
)
@example(np.pad(np.ones((1, 1, 1), int), 2), random.Random(2), False)
def test_what_walls_enclose_is_solid_however_they_are_turned(labels, choices, welded):
    quads, wound_badly = surface_of(labels, choices)
    assume(wound_badly)
    mesh = mesh_of(quads)
    if welded:
        positions, index = np.unique(mesh.positions, axis=0, return_inverse=True)
        mesh = Mesh(positions, index.reshape(-1)[mesh.triangles].astype(np.int32), mesh.materials)
    result = voxelize(one_object(mesh), GRID)
    expected = np.zeros((16, 16, 16), bool)
    expected[1:, 1:, 1:] = np.kron(~outside_of(labels), np.ones((CELL, CELL, CELL), bool))
    np.testing.assert_array_equal(dense(result.voxels) != 0, expected)
    again = voxelize(one_object(mesh), GRID, threads=1)
    np.testing.assert_array_equal(result.voxels.brick_masks, again.voxels.brick_masks)


@pytest.mark.parametrize("share", [0.1, 0.3])
@pytest.mark.parametrize("seed", range(4))
def test_faces_turned_at_random_change_nothing(share, seed):
    rng = np.random.default_rng(seed)
    outer, cavity = icosphere(3, (8, 8, 8), 7.3), icosphere(2, (8, 8, 8), 4.1)
    mesh = joined(outer, Mesh(cavity.positions, cavity.triangles[:, ::-1].copy(), cavity.materials))
    right = voxelize(one_object(mesh), GRID)
    turned = rng.random(len(mesh.triangles)) < share
    triangles = np.where(turned[:, None], mesh.triangles[:, ::-1], mesh.triangles)
    result = voxelize(one_object(Mesh(mesh.positions, triangles, mesh.materials)), GRID)
    np.testing.assert_array_equal(result.voxels.brick_masks, right.voxels.brick_masks)
    assert kinds_of(result) == {"turned-faces": turned.sum()}
    assert (right.objects[0].mode, result.objects[0].mode) == ("exact", "turned")


def test_a_wall_that_ends_within_a_solid_opens_nothing():
    wall = Mesh(np.array([[8, 2, 2], [8, 14, 2], [8, 8, 9.0]]), np.array([[0, 1, 2]], np.int32), np.ones(1, np.uint8))
    box = box_mesh([2, 2, 2], [14, 14, 14])
    corners = np.array([[8, 2, 2], [8, 14, 2]], float)
    below = Mesh(  # the floor, split along the foot of the wall
        np.array([[2, 2, 2], [8, 2, 2], [14, 2, 2], [14, 14, 2], [8, 14, 2], [2, 14, 2.0]]),
        np.array([[0, 5, 4], [0, 4, 1], [1, 4, 3], [1, 3, 2]], np.int32),
        np.ones(4, np.uint8),
    )
    floor = (box.positions[box.triangles][:, :, 2] == 2).all(axis=1)
    rest = Mesh(box.positions, box.triangles[~floor], box.materials[~floor])
    for seam, foot in ((2, corners[0]), (14, corners[1])):  # the walls that the split floor meets
        side = (rest.positions[rest.triangles][:, :, 1] == seam).all(axis=1)
        positions = np.array([[2, seam, 2], foot, [14, seam, 2], [14, seam, 14], [2, seam, 14.0]])
        fan = np.array([[1, 2, 3], [1, 3, 4], [1, 4, 0]], np.int32)
        fan = fan if seam == 2 else fan[:, ::-1].copy()
        rest = joined(
            Mesh(rest.positions, rest.triangles[~side], rest.materials[~side]),
            Mesh(positions, fan, np.ones(3, np.uint8)),
        )
    result = voxelize(one_object(joined(rest, below, wall)), GRID)
    assert dense(result.voxels)[2:14, 2:14, 2:14].all()
    assert (dense(result.voxels) != 0).sum() == 12**3


def test_every_face_stored_twice_counts_once():
    box = box_mesh([2, 3, 4], [13, 12, 11])
    for back in (box.triangles[:, ::-1], box.triangles):
        mesh = Mesh(box.positions, np.concatenate([box.triangles, back]).astype(np.int32), np.ones(24, np.uint8))
        result = voxelize(one_object(mesh), GRID)
        assert (dense(result.voxels) != 0).sum() == 11 * 9 * 7


def cut_apart(quad, choices):
    """Cut a quad into one, two or four: its neighbours keep their long edges, and T-junctions come about."""
    corners = [np.array(corner, float) for corner in quad]
    middles = [(corners[i] + corners[(i + 1) % 4]) / 2 for i in range(4)]
    centre = sum(corners) / 4
    return choices.choice(
        [
            [corners],
            [[corners[0], middles[0], middles[2], corners[3]], [middles[0], corners[1], corners[2], middles[2]]],
            [[corners[0], corners[1], middles[1], middles[3]], [middles[3], middles[1], corners[2], corners[3]]],
            [[corners[i], middles[i], centre, middles[i - 1]] for i in range(4)],
        ]
    )


@pytest.mark.parametrize("turned", [0.03, 0.3])
@pytest.mark.parametrize("seed", range(6))
def test_faces_are_wound_alike_across_t_junctions(turned, seed):
    choices = random.Random(seed)
    block = np.pad(np.ones((2, 3, 1), int), 1)
    quads = []
    for cell, axis in walls_of(block):
        outwards = quad_of(cell, axis) if block[cell] else quad_of(cell, axis)[::-1]
        for quad in cut_apart(outwards, choices):
            times = choices.choice([1, 1, 1, 1, 2])
            quads += [quad[::-1] if choices.random() < turned else quad for _ in range(times)]
    result = voxelize(one_object(mesh_of(quads)), GRID)
    expected = np.zeros((16, 16, 16), bool)
    expected[4:10, 4:13, 4:7] = True
    np.testing.assert_array_equal(dense(result.voxels) != 0, expected)


@pytest.mark.parametrize("share", [0, 0.1, 0.5])
@pytest.mark.parametrize("gone", [3, 20, 600])
def test_a_surface_with_holes_stored_once_for_each_side_counts_once(share, gone):
    """As the same surface stored once does: a ball with small holes, one with larger ones, and what is left of it."""
    rng = np.random.default_rng(gone)
    ball = icosphere(3, (8, 8, 8), 6.6)
    once = without(ball, rng.permutation(len(ball.triangles))[:gone])
    twice = np.concatenate([once.triangles, np.roll(once.triangles[:, ::-1], 1, axis=1)])
    twice = np.where(rng.random((len(twice), 1)) < share, twice[:, ::-1], twice)[rng.permutation(len(twice))]
    mesh = Mesh(once.positions, twice.astype(np.int32), np.ones(len(twice), np.uint8))
    for fill in ("solid", "auto", "surface"):
        made, single = (voxelize(one_object(one), GRID, fill=fill) for one in (mesh, once))
        np.testing.assert_array_equal(made.voxels.brick_masks, single.voxels.brick_masks)
        if gone < 600:  # pieces that hang together by corners face either way
            assert made.objects[0].mode == single.objects[0].mode
    assert not share or kinds_of(voxelize(one_object(mesh), GRID))
    if gone == 3:
        whole = voxelize(one_object(ball), GRID)
        np.testing.assert_array_equal(voxelize(one_object(mesh), GRID).voxels.brick_masks, whole.voxels.brick_masks)


def test_two_sided_sheets_stay_as_they_are():
    """A sheet between voxels covers both layers beside it, and none is turned."""
    sheet = np.array([[1.0, 1, 8], [15, 1, 8], [15, 15, 8], [1, 15, 8]])
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]], np.int32)
    result = voxelize(one_object(Mesh(sheet, faces, np.ones(4, np.uint8))), GRID)
    filled = dense(result.voxels) != 0
    assert filled[1:15, 1:15, 7:9].all()
    assert filled.sum() == 14 * 14 * 2
    assert kinds_of(result) == {}


def klein_bottle(n=24):
    """The figure-eight immersion, closed and one-sided."""
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, (np.arange(n) + 0.5) * 2 * np.pi / n, indexing="ij")
    r = 2 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
    z = np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)
    positions = np.stack([r * np.cos(u), r * np.sin(u), z], -1).reshape(-1, 3) * 2 + 8
    triangles = []
    for i in range(n):
        for j in range(n):
            across = (i + 1) % n
            turn = (lambda k: (n - 1 - k) % n) if i + 1 == n else (lambda k: k % n)
            a, b, c, d = i * n + j, across * n + turn(j), across * n + turn(j + 1), i * n + (j + 1) % n
            triangles += [[a, b, c], [a, c, d]]
    return Mesh(positions, np.array(triangles, np.int32), np.ones(len(triangles), np.uint8))


def test_what_has_one_side_only_is_told():
    assert kinds_of(voxelize(one_object(klein_bottle()), GRID)).get("one-sided") == 1


def test_instances_share_what_was_turned():
    box = box_mesh([1, 1, 1], [4, 4, 4])
    triangles = box.triangles.copy()
    triangles[:2] = triangles[:2, ::-1]
    mesh = Mesh(box.positions, triangles, box.materials)
    placed = np.eye(4)
    placed[:3, 3] = 8
    result = voxelize(scene_of(SceneObject("a", mesh, np.eye(4)), SceneObject("b", mesh, placed)), GRID)
    assert (dense(result.voxels) != 0).sum() == 2 * 27
    assert kinds_of(result) == {"turned-faces": 4}
