"""Point clouds: which voxels are solid, their colours, and what is filled, against plain loops over dense arrays."""

from collections import defaultdict, deque

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

import voxrt
from voxrt.octree import material_at, to_dense
from voxrt.voxelize import (
    EMPTY,
    BoxCollider,
    DoesNotFitError,
    Grid,
    Material,
    PointCloud,
    Scene,
    SceneObject,
    fit_grid,
    place_points,
    voxelize,
)
from voxrt.voxelize.enclosed_runs import AXIS_BITS, filled_runs
from voxrt.voxelize.scene_frames import join_scenes

SIDES = [(a, b) for a in range(3) for b in (-1, 1)]


def scene_of(cloud, **fields):
    return Scene("scan", [SceneObject("scan", points=cloud, **fields)], [EMPTY])


def random_cloud(seed, number=3000, **fields):
    rng = np.random.default_rng(seed)
    places = rng.integers(0, 8, (number, 3)) + rng.random((number, 3))
    return PointCloud(places[rng.random(number) < 0.3], None, **fields)


def neighbours(cell, size):
    for axis, step in SIDES:
        one = list(cell)
        one[axis] += step
        if 0 <= one[axis] < size:
            yield tuple(one)


def enclosed(solid):
    """The empty cells from which no path leads out, by a search from all cells of the border."""
    size = len(solid)
    border = [tuple(c) for c in np.argwhere(~solid) if 0 in c or size - 1 in c]
    reached, queue = set(border), deque(border)
    while queue:
        for one in neighbours(queue.popleft(), size):
            if not solid[one] and one not in reached:
                reached.add(one)
                queue.append(one)
    inside = ~solid
    inside[tuple(np.array(sorted(reached), int).reshape(-1, 3).T)] = False
    return inside


def grown(solid):
    found = solid.copy()
    for cell in np.argwhere(solid):
        for one in neighbours(tuple(cell), len(solid)):
            found[one] = True
    return found


def filled(solid):
    closed = solid | grown(enclosed(grown(solid)))
    return closed | enclosed(closed)


def dense(result, size):
    return to_dense(voxrt.octree.build(result.voxels))[:size, :size, :size]


@pytest.mark.parametrize("least", [1, 3])
@pytest.mark.parametrize("seed", range(3))
def test_voxels_with_enough_points_are_solid_and_have_the_median_of_their_colours(seed, least):
    rng = np.random.default_rng(seed)
    places = rng.uniform(-1, 9, (900, 3)).round(2)
    palette = rng.integers(0, 256, (5, 3))
    colours = palette[rng.integers(0, 5, 900)].astype(np.uint8)
    grid = Grid(3, (0, 0, 0), 1.0)
    held = defaultdict(list)
    for place, colour in zip(places, colours, strict=True):
        if (place >= 0).all() and (place <= 8).all():
            held[tuple(np.minimum(place, 7).astype(int).tolist())].append(colour)
    placed = place_points(
        scene_of(PointCloud(places, colours, least)), grid, colours=254, fill="surface", geometry="auto"
    )
    ids = dense(voxelize(placed, grid, fill="surface"), 8)
    expected = np.zeros((8, 8, 8, 3), int)
    for cell, seen in held.items():
        if len(seen) >= least:
            expected[cell] = np.sort(np.array(seen), axis=0)[(len(seen) - 1) // 2]
    table = np.array([(0, 0, 0), *(one.colour for one in placed.materials[1:])])
    np.testing.assert_array_equal(table[ids], expected)
    counts = np.reshape([len(held[cell]) for cell in np.ndindex(8, 8, 8)], (8, 8, 8))
    np.testing.assert_array_equal(ids != 0, counts >= least)


@pytest.mark.parametrize("share", [0.05, 0.25, 0.6, 0.9])
@pytest.mark.parametrize("seed", range(4))
def test_what_is_enclosed_is_filled(seed, share):
    rng = np.random.default_rng(seed)
    solid = rng.random((8, 8, 8)) < share
    cloud = PointCloud(np.argwhere(solid) + 0.5, rng.integers(0, 9, (solid.sum(), 3)).astype(np.uint8))
    grid = Grid(3, (0, 0, 0), 1.0)
    for fill, expected in (("surface", solid), ("auto", filled(solid)), ("solid", filled(solid))):
        placed = place_points(scene_of(cloud), grid, colours=200, fill=fill)
        result = voxelize(placed, grid, fill=fill)
        np.testing.assert_array_equal(dense(result, 8) != 0, expected)
        assert not result.warnings


def test_a_ball_with_holes_of_two_voxels_is_filled_and_a_bowl_is_not():
    x, y, z = np.meshgrid(*3 * [np.arange(32) - 15.5], indexing="ij")
    distance = np.sqrt(x * x + y * y + z * z)
    ball, shell = distance < 12, (distance < 12) & (distance > 10.5)
    shell[15:17, 15:17, :] = False  # holes of two by two voxels, from top to bottom
    grid = Grid(5, (0, 0, 0), 1.0)

    def built(solid):
        scene = place_points(scene_of(PointCloud(np.argwhere(solid) + 0.5)), grid, colours=9, fill="auto")
        return dense(voxelize(scene, grid, fill="auto"), 32) != 0

    missing = ball & ~built(shell)
    assert not (missing & (distance < 10.5)).any()
    bowl = shell & (y < 0)
    np.testing.assert_array_equal(built(bowl), bowl)


@given(st.randoms(use_true_random=False))
def test_the_order_of_points_does_not_matter(random):
    rng = np.random.default_rng(random.randrange(1 << 30))
    cloud = PointCloud(rng.normal(size=(400, 3)), rng.integers(0, 256, (400, 3)).astype(np.uint8), 2)
    order = rng.permutation(400)
    shuffled = PointCloud(cloud.positions[order], cloud.colours[order], 2)
    one, other = (voxrt.build(scene_of(each), depth=3).rom for each in (cloud, shuffled))
    assert np.array_equal(one.octree.words, other.octree.words)
    assert one.materials == other.materials
    assert one.grid == other.grid


def test_deep_grids_and_places_far_away():
    places = np.array([[0, 0, 0], [65535.5, 65535.5, 65535.5], [65535.5, 0, 65535.5]]) + 4e6
    scene = scene_of(PointCloud(places))
    grid = Grid(16, (4e6, 4e6, 4e6), 1.0)
    result = voxelize(place_points(scene, grid, colours=1, fill="auto"), grid)
    cells = [[0, 0, 0], [65535, 65535, 65535], [65535, 0, 65535]]
    assert material_at(voxrt.octree.build(result.voxels), cells).tolist() == [1, 1, 1]
    assert result.objects[0].voxels == 3


def test_runs_at_the_borders_of_the_grid_are_outside():
    column = np.array([0, 2]) | (5 << AXIS_BITS | 5 << 2 * AXIS_BITS)
    assert not len(filled_runs(np.sort(column), 8)[0])
    # Columns that end at the last z and begin at the first one do not touch.
    last = np.sort(np.array([65535, 1 << AXIS_BITS]) + (3 << 2 * AXIS_BITS))
    assert not len(filled_runs(last, 65536)[0])


def test_transforms_and_bounds():
    turned = np.array([[0, -2.0, 0, 1], [2, 0, 0, 2], [0, 0, 2, 3], [0, 0, 0, 1]])
    cloud = PointCloud(np.array([[0, 0, 0], [1, 2, 3]], np.float32))
    scene = scene_of(cloud, transform=turned)
    grid = fit_grid(scene, depth=3)
    assert grid.origin == pytest.approx((-3, 2, 3), abs=1e-6)
    assert grid.voxel_size == pytest.approx(6 / 8)
    cut = voxrt.build(scene, voxel_size=1, bounds=(0, 0, 0, 2, 4, 4))
    assert len(cut.coordinates) == 1


def test_points_stay_points_among_colliders_and_give_way_to_their_own():
    cloud = random_cloud(1)
    alone = voxrt.build(scene_of(cloud), depth=4, geometry="collider")
    assert np.array_equal(alone.octree.words, voxrt.build(scene_of(cloud), depth=4).octree.words)
    box = BoxCollider((0, 0, 0), (8, 8, 8), pow2=False)
    item = SceneObject("scan", points=cloud, colliders=(box,))
    boxed = Scene("scan", [item], [EMPTY, Material("stone", (9, 9, 9))])
    assert len(voxrt.build(boxed, depth=4).coordinates) == 16**3
    assert len(voxrt.build(boxed, depth=4, geometry="render").coordinates) == len(alone.coordinates)


def test_frames_share_a_palette():
    near, far = (PointCloud([[0, 0, 0], [at, 0, 0]], [[200, 0, 0], [0, 0, at * 20]]) for at in (3, 7))
    frames = join_scenes([scene_of(near), scene_of(far)])
    assert frames.moves
    grid = Grid(3, (0, 0, 0), 1.0)
    frames = replace(frames, union=place_points(frames.union, grid, colours=32, fill="auto"))
    assert [one.colour for one in frames.union.materials[1:]] == [(0, 0, 60), (0, 0, 140), (200, 0, 0)]
    assert [voxelize(frames.scene(i), grid).objects[0].voxels for i in range(2)] == [2, 2]
    assert not join_scenes([scene_of(near), scene_of(near)]).moves


def test_tiles_have_the_same_bytes():
    scene = scene_of(PointCloud(np.random.default_rng(3).normal(size=(200000, 3))))
    whole, tiled = (voxrt.build(scene, depth=11, memory=memory) for memory in (None, 1 << 26))
    assert np.array_equal(whole.octree.words, tiled.octree.words)


def test_a_full_table_of_materials_is_said():
    table = (EMPTY, *(Material(f"m{i}", (i, i, i)) for i in range(255)))
    with pytest.raises(DoesNotFitError, match="leave none for its points"):
        place_points(
            replace(scene_of(random_cloud(1)), materials=table), Grid(3, (0, 0, 0), 1.0), colours=3, fill="auto"
        )


def test_names_of_materials_stay_unique():
    scene = replace(scene_of(PointCloud([[0, 0, 0]])), materials=(EMPTY, Material("points #c8c8c8", (1, 2, 3))))
    placed = place_points(scene, Grid(1, (0, 0, 0), 1.0), colours=3, fill="auto")
    assert [one.name for one in placed.materials[1:]] == ["points #c8c8c8", "points #c8c8c8'"]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PointCloud([[0, 0]]), "PointCloud.positions"),
        (lambda: PointCloud([[0, 0, np.nan]]), "PointCloud.positions"),
        (lambda: PointCloud([[0, 0, 0]], [[0, 0, 256]]), "PointCloud.colours"),
        (lambda: PointCloud([[0, 0, 0]], None, 0), "PointCloud.least"),
    ],
)
def test_wrong_clouds_are_refused(make, message):
    with pytest.raises((TypeError, ValueError), match=message):
        make()


def test_points_that_are_on_no_grid_are_refused():
    with pytest.raises(ValueError, match="object 'scan' has points that are on no grid: call place_points first"):
        voxelize(scene_of(random_cloud(1)), Grid(3, (0, 0, 0), 1.0))
    few = place_points(scene_of(random_cloud(1, least=99)), Grid(3, (0, 0, 0), 1.0), colours=3, fill="auto")
    assert voxelize(few, Grid(3, (0, 0, 0), 1.0)).objects[0].voxels == 0


def test_an_empty_memory_says_how_many_points_were_asked_for():
    with pytest.raises(DoesNotFitError, match=r"no voxel holds 99 points; ask for fewer \(--points\)"):
        voxrt.build(scene_of(random_cloud(1, least=99)), depth=3, points=99)


def test_a_notebook_shows_points():
    from voxrt.view import cards

    shown = cards._scene_png(scene_of(random_cloud(1)))
    assert shown != cards._scene_png(scene_of(PointCloud(np.zeros((1, 3)))))


def test_points_are_not_compared_with_triangles():
    built = voxrt.build(scene_of(random_cloud(1)), depth=3)
    with pytest.raises(voxrt.SimulatorError, match="has points, and memories are compared with triangles"):
        voxrt.compare(built.scene, built.rom, voxrt.aim_camera(built.rom, (8, 8)), (8, 8))
