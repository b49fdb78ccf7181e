"""Closed pieces of one object that are inside out: turned where they stand, kept where they are a cavity's wall."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.meshes import box_mesh, icosphere, joined, one_object, scene_of
from oracles.voxels import dense, shell, snap, volume6, winding

from voxrt.voxelize import Grid, Mesh, SceneObject, voxelize

DEPTH = 4
GRID = Grid(DEPTH, (0.0, 0.0, 0.0), 1.0)


def flipped(mesh):
    return Mesh(mesh.positions, mesh.triangles[:, ::-1].copy(), mesh.materials)


def split(mesh):
    """Give each triangle its own vertices."""
    return Mesh(
        mesh.positions[mesh.triangles].reshape(-1, 3),
        np.arange(3 * len(mesh.triangles), dtype=np.int32).reshape(-1, 3),
        mesh.materials,
    )


def solid_of(solids, cavities=(), transform=None):
    """Fill by the sum of winding numbers of pieces that all face outwards; a cavity takes away what it holds."""
    vertices = {}
    covered = np.zeros((2**DEPTH,) * 3, bool)
    inside = np.zeros(covered.shape)
    for sign, pieces in ((1, solids), (-1, cavities)):
        for piece in pieces:
            vertices = snap(piece.positions, np.eye(4) if transform is None else transform, (0, 0, 0), 1)
            facing = np.sign(volume6(vertices, piece.triangles))
            covered |= shell(vertices, piece.triangles, 2**DEPTH, inverted=facing != sign) >= 0
            inside += sign * np.abs(winding(vertices, piece.triangles, 2**DEPTH))
    return covered | (inside > 0.5)


def check(mesh, solids, cavities=(), *, turned, transform=None):
    scene = scene_of(SceneObject("o", mesh, np.eye(4) if transform is None else transform))
    result = voxelize(scene, GRID)
    np.testing.assert_array_equal(dense(result.voxels) != 0, solid_of(solids, cavities, transform))
    assert [(warning.kind, warning.count) for warning in result.warnings] == (
        [("turned-pieces", turned)] if turned else []
    )
    assert (result.objects[0].mode == "turned") == bool(turned)
    again = voxelize(scene, GRID, threads=1)
    np.testing.assert_array_equal(result.voxels.brick_masks, again.voxels.brick_masks)


LEFT, RIGHT, OVER = ([1, 1, 1], [6, 7, 8]), ([9, 2, 3], [14, 9, 8]), ([4, 2, 3], [12, 9, 13])
MIRRORS = [None, np.diag([-1.0, 1, 1, 1]) + np.eye(4)[:, [1, 2, 3, 0]] * np.array([16, 0, 0, 0])[:, None]]


@pytest.mark.parametrize("mirror", MIRRORS, ids=["as it is", "mirrored"])
@pytest.mark.parametrize("parted", [False, True], ids=["welded", "split"])
@pytest.mark.parametrize("other", [RIGHT, OVER], ids=["beside", "overlapping"])
@pytest.mark.parametrize("first", [False, True])
def test_one_of_two_boxes_inside_out(other, first, parted, mirror):
    boxes = box_mesh(*LEFT, inverted=first), box_mesh(*other, inverted=not first)
    mesh = joined(*boxes)
    check(split(mesh) if parted else mesh, boxes, turned=1, transform=mirror)


@pytest.mark.parametrize("mirror", MIRRORS, ids=["as it is", "mirrored"])
@pytest.mark.parametrize("inverted", [False, True])
def test_a_hollow_ball_stays_hollow(inverted, mirror):
    outer, inner = icosphere(2, (8, 8, 8), 7.0), flipped(icosphere(1, (8, 8, 8), 4.0))
    mesh = joined(outer, inner)
    check(flipped(mesh) if inverted else mesh, [outer], [inner], turned=0, transform=mirror)


def test_instances_with_and_without_a_mirror():
    boxes = box_mesh([1, 1, 1], [5, 5, 5]), box_mesh([3, 3, 3], [7, 7, 7], inverted=True)
    mesh = joined(*boxes)
    result = voxelize(scene_of(*(SceneObject("o", mesh, m) for m in (np.eye(4), MIRRORS[1]))), GRID)
    want = solid_of(boxes) | solid_of(boxes, transform=MIRRORS[1])
    np.testing.assert_array_equal(dense(result.voxels) != 0, want)
    assert [report.mode for report in result.objects] == ["turned", "turned"]
    assert [(warning.kind, warning.count) for warning in result.warnings] == [("turned-pieces", 2)]


def test_a_hollow_ball_inside_out_beside_a_box():
    outer, inner = icosphere(1, (5, 5, 5), 4.5), flipped(icosphere(1, (5, 5, 5), 2.5))
    box = box_mesh([9, 9, 9], [14, 14, 14])
    check(joined(flipped(joined(outer, inner)), box), [outer, box], [inner], turned=2)


def test_a_block_in_a_cavity_is_solid_either_way():
    outer, inner = box_mesh([1, 1, 1], [15, 15, 15]), box_mesh([3, 3, 3], [13, 13, 13], inverted=True)
    for inverted in (False, True):
        block = box_mesh([6, 6, 6], [10, 10, 10], inverted=inverted)
        check(joined(outer, inner, block), [outer, block], [inner], turned=int(inverted))


@pytest.mark.parametrize("x", [2.0, 5.0])
def test_what_touches_the_surface_around_it_is_no_cavity(x):
    outer, recess = box_mesh([1, 1, 1], [11, 11, 9]), box_mesh([x, 2, 5], [x + 2, 4, 9], inverted=True)
    check(joined(outer, recess), [outer, recess], turned=1)


def test_a_bar_between_two_arms_is_no_cavity():
    """All its corners are inside the U, its middle is not."""
    profile = np.array([[1, 1], [13, 1], [13, 11], [10, 11], [10, 4], [4, 4], [4, 11], [1, 11]], float)
    cap = np.array([[0, 1, 5], [1, 4, 5], [1, 2, 4], [2, 3, 4], [0, 5, 7], [5, 6, 7]])
    sides = [[i, (i + 1) % 8, (i + 1) % 8 + 8] for i in range(8)] + [[i, (i + 1) % 8 + 8, i + 8] for i in range(8)]
    positions = np.concatenate([np.column_stack([profile, np.full(8, z)]) for z in (2.0, 9.0)])
    triangles = np.concatenate([cap[:, ::-1], cap + 8, sides]).astype(np.int32)
    arms = Mesh(positions, triangles, np.ones(len(triangles), np.uint8))
    bar = box_mesh([2, 7, 4], [12, 9, 7], inverted=True)
    check(joined(arms, bar), [arms, bar], turned=1)


def test_all_inside_out_is_one_surface_inside_out():
    boxes = box_mesh(*LEFT, inverted=True), box_mesh(*OVER, inverted=True)
    result = voxelize(one_object(joined(*boxes)), GRID)
    np.testing.assert_array_equal(dense(result.voxels) != 0, solid_of(boxes))
    assert result.warnings == ()


def test_a_closed_piece_inside_out_beside_one_with_a_hole():
    ball = icosphere(2, (6, 6, 6), 5.0)
    holed = Mesh(ball.positions, ball.triangles[1:], ball.materials[1:])
    block = box_mesh([5, 5, 5], [14, 14, 14])
    inside = box_mesh([5, 5, 5], [7, 7, 7])
    plain = voxelize(one_object(joined(holed, block)), GRID)
    turned = voxelize(one_object(joined(holed, flipped(block))), GRID)
    np.testing.assert_array_equal(dense(turned.voxels), dense(plain.voxels))
    assert [(warning.kind, warning.count) for warning in turned.warnings] == [("turned-pieces", 1)]
    assert turned.objects[0].mode == "winding"
    hollow = voxelize(one_object(joined(holed, flipped(inside))), GRID)
    assert hollow.warnings == ()


coordinate = st.integers(0, 15 * 4).map(lambda i: i / 4)
corner = st.tuples(coordinate, coordinate, coordinate)


@settings(max_examples=40)
@given(st.lists(st.tuples(corner, corner, st.booleans()), min_size=2, max_size=4), st.booleans())
def test_boxes_of_any_facing_are_their_union(boxes, parted):
    """But for those that lie inside another that faces the other way, and those that share corners."""
    pieces = []
    for p, q, inverted in boxes:
        low, high = np.minimum(p, q), np.maximum(p, q) + 0.5
        if any(((low > a) & (high < b)).all() or ((low < a) & (high > b)).all() for a, b, _ in pieces):
            continue
        pieces.append((low, high, inverted))
    meshes = [box_mesh(low, high, inverted=inverted) for low, high, inverted in pieces]
    corners = np.concatenate([mesh.positions for mesh in meshes])
    if len(np.unique(corners, axis=0)) < len(corners):
        return
    mesh = joined(*meshes)
    got = dense(voxelize(one_object(split(mesh) if parted else mesh), GRID).voxels) != 0
    np.testing.assert_array_equal(got, solid_of(meshes))
