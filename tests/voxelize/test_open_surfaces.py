"""Surfaces with holes are filled where the generalized winding number says so; what stands open is not."""

import os
import signal
import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.meshes import box_mesh, icosphere, joined, one_object, scene_of, without
from oracles.voxels import dense, snap, winding_at

from voxrt.voxelize import Grid, Mesh, SceneObject, voxelize

UNIT = 4096


def samples_of(cells):
    """Where voxels are asked: 1/8192 voxel beside their centres, in 1/4096 voxel."""
    return cells * float(UNIT) + UNIT / 2 + 0.5


def disagreements(mesh, depth, cells=None):
    """Voxels without surface that are not as the sum over all triangles has them, ties apart."""
    side = 2**depth
    scene, grid = one_object(mesh), Grid(depth, (0.0, 0.0, 0.0), 1.0)
    filled = dense(voxelize(scene, grid).voxels) != 0
    covered = dense(voxelize(scene, grid, fill="surface").voxels) != 0
    if cells is None:
        cells = np.argwhere(~covered)
    cells = cells[~covered[tuple(cells.T)]]
    vertices = snap(mesh.positions, np.eye(4), (0, 0, 0), 1)
    low, high = vertices.min(axis=0) // UNIT, -(-vertices.max(axis=0) // UNIT)
    cells = cells[((cells >= low) & (cells < np.minimum(high, side))).all(axis=1)]
    number = np.abs(winding_at(samples_of(cells), vertices, mesh.triangles))
    clear = np.abs(number - 0.5) > 2e-6
    return int((filled[tuple(cells.T)] != (number > 0.5))[clear].sum()), len(cells)


@settings(max_examples=12)
@given(st.integers(0, 10**6), st.sampled_from([(0, 1), (1, 5), (2, 40)]))
def test_every_voxel_is_as_the_sum_over_all_triangles_has_it(seed, removed):
    rng = np.random.default_rng(seed)
    level, count = removed
    ball = icosphere(level, rng.uniform(6, 10, 3), rng.uniform(3, 7))
    mesh = without(ball, rng.choice(len(ball.triangles), count, replace=False))
    if rng.random() < 0.5:  # a hole that is not flat
        mesh.positions[mesh.triangles[0, 0]] *= 0.8
    wrong, _ = disagreements(mesh, 4)
    assert wrong == 0


def test_voxels_of_a_scan_with_very_many_holes():
    rng = np.random.default_rng(5)
    ball = icosphere(4, (63.3, 64.1, 64.7), 61)
    mesh = without(ball, rng.choice(len(ball.triangles), len(ball.triangles) // 10, replace=False))
    at = rng.choice(len(mesh.triangles), 1500)
    near = mesh.positions[mesh.triangles[at]].mean(axis=1) + rng.normal(size=(1500, 3)) * 2
    cells = np.unique(np.concatenate([near.astype(int), rng.integers(0, 128, (300, 3))]), axis=0)
    wrong, looked_at = disagreements(mesh, 7, cells[((cells >= 0) & (cells < 128)).all(axis=1)])
    assert looked_at > 700
    assert wrong == 0


def patches(rng, side, gap):
    """Give the sides of a box as squares that do not meet, their corners a little off its planes."""
    box = box_mesh([side * 0.1] * 3, [side * 0.85, side * 0.9, side * 0.8])
    corners = box.positions[box.triangles.reshape(6, 6)]  # two triangles per side
    middles = (corners.min(axis=1, keepdims=True) + corners.max(axis=1, keepdims=True)) / 2
    corners = middles + (corners - middles) * (1 - gap)
    positions, welded = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    positions += rng.uniform(-0.1, 0.1, positions.shape)
    return Mesh(positions, welded.reshape(-1, 3).astype(np.int32), np.ones(12, np.uint8))


@settings(max_examples=5)
@given(st.integers(0, 10**6), st.booleans())
def test_caps_that_lie_on_the_surface(seed, with_ball):
    """Each loose side is closed by a cap that lies on it: caps and surface pass the same voxels."""
    rng = np.random.default_rng(seed)
    mesh = patches(rng, 32, rng.uniform(0.002, 0.01))
    if with_ball:
        ball = icosphere(2, rng.uniform(12, 20, 3), rng.uniform(7, 11))
        mesh = joined(mesh, without(ball, rng.choice(320, 9, replace=False)))
    wrong, looked_at = disagreements(mesh, 5, rng.integers(0, 32, (4000, 3)))
    assert wrong == 0
    assert looked_at > 1000


@settings(max_examples=5)
@given(st.integers(0, 10**6), st.sampled_from([0.02, 0.06, 0.12]))
def test_one_hole_of_any_size_is_cut_where_the_sum_says(seed, share):
    """The number passes 1/2 across the hole, smoothly: expansions decide there, and sums at its edge."""
    rng = np.random.default_rng(seed)
    ball = icosphere(2, rng.uniform(29, 35, 3), rng.uniform(22, 28))
    towards = rng.normal(size=3)
    heights = ball.positions[ball.triangles].mean(axis=1) @ towards
    mesh = without(ball, np.argsort(heights)[-round(share * len(heights)) :])
    wrong, looked_at = disagreements(mesh, 6, rng.integers(0, 64, (10_000, 3)))
    assert wrong == 0
    assert looked_at > 2000


def test_a_scan_with_very_many_holes_keeps_its_volume():
    grid = Grid(7, (-64.0, -64.0, -64.0), 1.0)
    ball = icosphere(5, radius=60)
    rng = np.random.default_rng(3)
    holed = without(ball, rng.choice(len(ball.triangles), len(ball.triangles) // 10, replace=False))
    whole, left = (voxelize(one_object(mesh), grid).objects[0].voxels for mesh in (ball, holed))
    assert abs(left / whole - 1) < 0.001


def room(*, inverted=False):
    """A box from 2 to 14 without its side at x = 2."""
    box = box_mesh([2, 2, 2], [14, 14, 14], inverted=inverted)
    front = (box.positions[box.triangles][:, :, 0] == 2).all(axis=1)
    assert front.sum() == 2
    return without(box, front), Mesh(box.positions, box.triangles[front], box.materials[front])


GRID = Grid(4, (0.0, 0.0, 0.0), 1.0)


@pytest.mark.parametrize("inverted", [False, True])
def test_a_room_without_a_front_stays_a_room(inverted):
    mesh, _ = room(inverted=inverted)
    result = voxelize(one_object(mesh), GRID)
    assert result.objects[0].mode == "open"
    assert [(warning.kind, warning.count) for warning in result.warnings] == [("open-surface", 1)]
    np.testing.assert_array_equal(dense(result.voxels), dense(voxelize(one_object(mesh), GRID, fill="surface").voxels))


def test_a_room_of_loose_walls_stays_a_room():
    mesh, _ = room()
    loose = Mesh(
        mesh.positions[mesh.triangles].reshape(-1, 3),
        np.arange(3 * len(mesh.triangles), dtype=np.int32).reshape(-1, 3),
        mesh.materials,
    )
    assert not dense(voxelize(one_object(loose), GRID).voxels)[4:12, 4:12, 4:12].any()


def test_a_side_wound_against_the_others_is_no_opening():
    mesh, side = room()
    turned = Mesh(side.positions, side.triangles[:, ::-1].copy(), side.materials)
    result = voxelize(one_object(joined(mesh, turned)), GRID)
    assert result.objects[0].mode == "turned"
    assert dense(result.voxels)[2:14, 2:14, 2:14].all()


def test_a_lid_closes_a_box():
    mesh, lid = room()
    lid = Mesh(lid.positions - [0.1, 0, 0], lid.triangles, lid.materials)
    result = voxelize(one_object(joined(mesh, lid)), GRID)
    assert result.objects[0].mode == "winding"
    assert result.warnings == ()
    assert dense(result.voxels)[2:14, 2:14, 2:14].all()


def test_a_closed_piece_is_filled_beside_an_open_one():
    mesh, _ = room()
    block = box_mesh([6, 6, 6], [11, 11, 11])
    result = voxelize(one_object(joined(mesh, block)), GRID)
    assert result.objects[0].mode == "open"
    filled = dense(result.voxels) != 0
    assert filled[6:11, 6:11, 6:11].all()
    assert filled[4:12, 4:12, 4:12].sum() == 125


def test_sheets_and_bowls_have_a_shell_alone():
    flat = Mesh(
        np.array([[1, 1, 5.5], [9, 1, 5.5], [9, 9, 5.5], [1, 9, 5.5]]),
        np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        np.ones(2, np.uint8),
    )
    ball = icosphere(2, (8, 8, 8), 6.0)
    bowl = without(ball, ball.positions[ball.triangles].mean(axis=1)[:, 2] > 8)
    result = voxelize(scene_of(SceneObject("flat", flat), SceneObject("bowl", bowl)), GRID)
    assert not dense(result.voxels)[8, 8, 7]
    assert result.objects[0].voxels == 64


def test_open_surfaces_are_the_same_for_every_thread_count():
    rng = np.random.default_rng(9)
    ball = icosphere(3, (64, 64, 64), 60)
    mesh = without(ball, rng.choice(len(ball.triangles), 100, replace=False))
    grid = Grid(7, (0.0, 0.0, 0.0), 1.0)
    first, second = (voxelize(one_object(mesh), grid, threads=threads).voxels for threads in (1, 3))
    np.testing.assert_array_equal(first.brick_masks, second.brick_masks)
    np.testing.assert_array_equal(first.octant_codes, second.octant_codes)


def test_a_thin_hull_has_no_gaps():
    plate = box_mesh([1, 1, 4.25], [15, 15, 4.25 + 1e-3])
    tilted = Mesh(plate.positions + plate.positions[:, :1] * [0, 0, 0.37], plate.triangles, plate.materials)
    assert (dense(voxelize(one_object(tilted), GRID).voxels)[1:15, 1:15] != 0).any(axis=2).all()


@pytest.mark.skipif(os.name == "nt", reason="no signals between threads")
@pytest.mark.parametrize("exponent", [-60, 30, 48, 52, 60, 100, 300])
@pytest.mark.parametrize("chamber", [room()[0], without(icosphere(2, (8, 8, 8), 5), [0, 1, 2])])
def test_a_shared_mesh_has_coordinates_of_any_size_in_its_own_frame(chamber, exponent):
    """Whether it encloses anything is decided there, by exact signs of solid angles: they once overflowed."""
    scale = 2.0**exponent  # so that the vertices in voxels are the same numbers
    large = Mesh(chamber.positions * scale, chamber.triangles, chamber.materials)

    def twice(mesh, factor):
        first, second = np.diag([factor, factor, factor, 1.0]), np.diag([factor, factor, factor, 1.0])
        second[:3, 3] = (0.5, 0.25, 0.125)
        return scene_of(SceneObject("a", mesh, first), SceneObject("b", mesh, second))

    expected = dense(voxelize(twice(chamber, 1.0), GRID).voxels)
    np.testing.assert_array_equal(dense(voxelize(twice(large, 1 / scale), GRID).voxels), expected)
    assert 0 < (expected != 0).mean() < 1


def test_ctrl_c_ends_a_long_run():
    mesh = icosphere(6, radius=1.0)
    grid = Grid(13, (-1.0, -1.0, -1.0), 2 / 2**13)  # takes seconds
    main = threading.main_thread().ident
    timer = threading.Timer(0.2, lambda: signal.pthread_kill(main, signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        voxelize(one_object(mesh), grid)


def tube(openings):
    """Give a box of 18 x 27 x 18 voxels with a window in each of four sides: together this share of its area."""
    side = (openings * 8 / 4) ** 0.5  # of a square window, where the box is 1 x 1.5 x 1
    columns, rows = [0, 0.5 - side / 2, 0.5 + side / 2, 1], [0, 0.75 - side / 2, 0.75 + side / 2, 1.5]
    cells = [(x, y) for x in range(3) for y in range(3)]
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    wall = [[(columns[x + i], rows[y + k], 1) for i, k in ring] for x, y in cells if (x, y) != (1, 1)]
    floor = [[(columns[x + i], 0, columns[z + k]) for i, k in ring] for x, z in cells]
    roof = [[(x, 1.5, z) for x, _, z in reversed(quad)] for quad in floor]
    quads = [*floor, *roof, *wall]
    for _ in range(3):
        wall = [[(z, y, 1 - x) for x, y, z in quad] for quad in wall]
        quads += wall
    corners = 2 + 18 * np.array(quads, float).reshape(-1, 3)
    triangles = [(4 * n + a, 4 * n + b, 4 * n + c) for n in range(len(quads)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    return Mesh(corners, np.array(triangles, np.int32), np.ones(len(triangles), np.uint8))


@pytest.mark.parametrize(
    ("openings", "sheet", "noted"), [(0.005, False, False), (0.03, False, True), (0.08, True, True)]
)
def test_auto_keeps_a_sheet_whose_openings_are_large_together(openings, sheet, noted):
    scene = one_object(tube(openings))
    surface, solid, auto = (voxelize(scene, GRID, fill=fill) for fill in ("surface", "solid", "auto"))
    voxels = [result.objects[0].voxels for result in (surface, solid, auto)]
    assert voxels[0] < voxels[1]
    assert voxels[2] == voxels[0 if sheet else 1]
    assert [warning.kind for warning in solid.warnings] == ["mostly-filled"] * noted
    assert [warning.kind for warning in auto.warnings] == (["open-surface"] if sheet else ["mostly-filled"] * noted)
