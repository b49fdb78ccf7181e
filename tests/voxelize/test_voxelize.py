"""The voxelizer against the brute-force oracle, and by cases whose answer is known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.meshes import box_mesh, icosphere, one_object, scene_of
from oracles.voxels import compete, dense, snap, voxelize_mesh

from voxrt.voxelize import Grid, Mesh, SceneObject, fit_grid, voxelize

UNIT_GRID = {depth: Grid(depth, (0.0, 0.0, 0.0), 1.0) for depth in range(1, 7)}


def expected(scene, grid, *, solid, closed):
    layers = [
        voxelize_mesh(
            snap(item.mesh.positions, item.transform, grid.origin, grid.voxel_size),
            item.mesh.triangles,
            item.mesh.materials,
            grid.size,
            solid=solid,
            closed=closed,
        )
        for item in scene.objects
    ]
    return compete(layers)


def check(scene, grid, *, solid=True, closed=True):
    result = voxelize(scene, grid, fill="solid" if solid else "surface", threads=1)
    got = dense(result.voxels)
    want = expected(scene, grid, solid=solid, closed=closed)
    np.testing.assert_array_equal(got, want)
    assert sum(report.voxels for report in result.objects) == np.count_nonzero(got)


@pytest.mark.parametrize("inverted", [False, True])
def test_box_on_grid_planes_is_exact(inverted):
    mesh = box_mesh([0, 0, 0], [4, 4, 4], inverted=inverted)
    result = voxelize(one_object(mesh), UNIT_GRID[3])
    filled = dense(result.voxels)
    assert filled.sum() == 64
    assert filled[:4, :4, :4].all()
    assert result.objects[0].mode == "exact"


def test_box_on_octant_planes_is_one_octant():
    voxels = voxelize(one_object(box_mesh([8, 0, 16], [16, 8, 24])), UNIT_GRID[5]).voxels
    assert len(voxels.brick_codes) == 0
    assert voxels.octant_levels.tolist() == [3]
    assert voxels.octant_codes.tolist() == [0b100001]
    assert voxelize(one_object(box_mesh([0, 0, 0], [32, 32, 32])), UNIT_GRID[5]).voxels.octant_levels.tolist() == [5]


def test_first_object_keeps_the_overlap():
    scene = scene_of(box_mesh([0, 0, 0], [6, 6, 6], material=1), box_mesh([3, 3, 3], [9, 9, 9], material=2))
    result = voxelize(scene, UNIT_GRID[4])
    filled = dense(result.voxels)
    assert (filled[:6, :6, :6] == 1).all()
    assert (filled[6:9, 6:9, 6:9] == 2).all()
    assert [report.voxels for report in result.objects] == [216, 189]


def test_axes_are_the_scenes():
    filled = dense(voxelize(one_object(box_mesh([1, 2, 4], [2, 4, 8])), UNIT_GRID[3]).voxels)
    assert np.argwhere(filled).min(axis=0).tolist() == [1, 2, 4]
    assert np.argwhere(filled).max(axis=0).tolist() == [1, 3, 7]


QUAD = np.array([[1.0, 1, 0], [5, 1, 0], [5, 5, 0], [1, 5, 0]])


@pytest.mark.parametrize("fill", ["solid", "surface"])
@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(("plane", "up", "layer"), [(3, True, 2), (3, False, 3), (0, True, 0), (8, False, 7)])
def test_sheet_on_a_plane_belongs_to_the_voxels_behind(fill, axis, plane, up, layer):
    corners = np.roll(QUAD + np.array([0, 0, plane]), axis + 1, axis=1)
    triangles = np.array([[0, 1, 2], [0, 2, 3]] if up else [[0, 2, 1], [0, 3, 2]], np.int32)
    sheet = Mesh(corners, triangles, np.full(2, 1, np.uint8))
    filled = dense(voxelize(one_object(sheet), UNIT_GRID[3], fill=fill).voxels)
    assert filled.sum() == 16
    assert (np.unique(np.argwhere(filled)[:, axis]) == [layer]).all()


@pytest.mark.parametrize("fill", ["solid", "surface"])
def test_open_sheet_has_no_inside(fill):
    sheet = Mesh(QUAD + np.array([0, 0, 3.3]), np.array([[0, 1, 2], [0, 2, 3]], np.int32), np.full(2, 1, np.uint8))
    assert dense(voxelize(one_object(sheet), UNIT_GRID[3], fill=fill).voxels).sum() == 16


coordinate = st.one_of(
    st.integers(-2, 10).map(float), st.integers(-2 * 4, 10 * 4).map(lambda i: i / 4), st.floats(-2, 10, width=32)
)
point = st.tuples(coordinate, coordinate, coordinate)


@given(st.lists(st.tuples(point, point, point), min_size=1, max_size=6), st.integers(1, 3))
def test_triangle_soup_surface(soup, depth):
    positions = np.array(soup, float).reshape(-1, 3)
    triangles = np.arange(len(positions), dtype=np.int32).reshape(-1, 3)
    materials = np.arange(1, len(triangles) + 1).astype(np.uint8)
    check(one_object(Mesh(positions, triangles, materials)), UNIT_GRID[depth], solid=False)


@given(point, point, point, point, st.booleans())
def test_tetrahedron_solid(a, b, c, d, flip):
    order = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    triangles = np.array([t[::-1] for t in order] if flip else order, np.int32)
    mesh = Mesh(np.array([a, b, c, d], float), triangles, np.array([1, 2, 3, 4], np.uint8))
    check(one_object(mesh), UNIT_GRID[3])


@given(st.lists(st.tuples(point, point, st.booleans()), min_size=1, max_size=3))
def test_boxes_solid(boxes):
    meshes = [
        box_mesh(np.minimum(p, q), np.maximum(p, q), material=i + 1, inverted=inverted)
        for i, (p, q, inverted) in enumerate(boxes)
    ]
    check(scene_of(*meshes), UNIT_GRID[3])


@settings(max_examples=25)
@given(point, st.floats(0.3, 7), st.floats(0.3, 2), st.integers(0, 1))
def test_spheres_solid(centre, radius, stretch, level):
    mesh = icosphere(level, centre, radius)
    transform = np.diag([1.0, stretch, 1.0, 1.0])
    check(scene_of(SceneObject("ball", mesh, transform)), UNIT_GRID[3])


@settings(max_examples=25)
@given(point, st.floats(1, 5), st.floats(0.2, 0.9))
def test_shell_within_a_shell_is_hollow(centre, radius, inner):
    outer, cavity = icosphere(1, centre, radius), icosphere(1, centre, radius * inner)
    mesh = Mesh(
        np.concatenate([outer.positions, cavity.positions]),
        np.concatenate([outer.triangles, cavity.triangles[:, ::-1] + len(outer.positions)]).astype(np.int32),
        np.full(len(outer.triangles) * 2, 1, np.uint8),
    )
    check(one_object(mesh), UNIT_GRID[3])


@given(st.data())
def test_threads_do_not_matter(data):
    seed = data.draw(st.integers(0, 1000))
    rng = np.random.default_rng(seed)
    meshes = [icosphere(2, rng.uniform(0, 64, 3), rng.uniform(1, 40), material=i + 1) for i in range(3)]
    one, three = (voxelize(scene_of(*meshes), UNIT_GRID[6], threads=n).voxels for n in (1, 3))
    for name in one.__struct_fields__:
        np.testing.assert_array_equal(getattr(one, name), getattr(three, name))


@pytest.mark.parametrize("far", [1e30, np.nan])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_vertices_of_no_triangle_count_for_nothing(far, dtype):
    box = box_mesh((0, 0, 0), (2, 3, 4))
    stray = Mesh(
        np.concatenate([[[far] * 3], box.positions, [[far, 0, 0]]]).astype(dtype), box.triangles + 1, box.materials
    )
    plain, odd = one_object(box), one_object(stray)
    assert fit_grid(odd, depth=3) == fit_grid(plain, depth=3)
    found = [voxelize(scene, fit_grid(plain, depth=3)).voxels for scene in (plain, odd)]
    assert all(
        np.array_equal(getattr(found[0], name), getattr(found[1], name)) for name in ("brick_codes", "brick_masks")
    )
