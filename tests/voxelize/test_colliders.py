"""Colliders: rounding to powers of two, analytic solids against exact overlap, hulls, what the warnings say."""

import itertools
from fractions import Fraction

import hypothesis
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.meshes import MATERIALS, box_mesh, icosphere, scene_of
from oracles.voxels import UNIT, dense

from voxrt.voxelize import (
    BoxCollider,
    Grid,
    HullCollider,
    Mesh,
    MeshCollider,
    Scene,
    SceneObject,
    SphereCollider,
    voxelize,
)

GRID = Grid(4, (0.0, 0.0, 0.0), 1.0)
NOTHING = Mesh(np.empty((0, 3)), np.empty((0, 3), np.int32), np.empty(0, np.uint8))


def collider_scene(*colliders, transform=None, mesh=NOTHING):
    return Scene(
        "test", (SceneObject("o", mesh, np.eye(4) if transform is None else transform, colliders, 3),), MATERIALS
    )


def box(low, high, **how):
    return BoxCollider(np.array(low, float), np.array(high, float), **how)


def test_side_of_three_and_a_half_becomes_four():
    result = voxelize(collider_scene(box([4, 4, 4], [7.5, 7.5, 7.5])), GRID)
    filled = dense(result.voxels)
    assert filled.sum() == 3 * 64
    assert (filled[4:8, 4:8, 4:8] == 3).all()
    report = result.objects[0]
    assert (report.source, report.mode, report.voxels) == ("box", "exact", 64)
    assert report.grown == (0.5, 0.5, 0.5)
    assert report.moved == (0.0, 0.0, 0.0)


def test_corner_goes_to_the_largest_octant_near():
    result = voxelize(collider_scene(box([8.75, 3.25, 0.9], [12, 7.25, 4.9])), GRID)
    assert result.objects[0].moved == (-0.75, 0.75, -0.89990234375)
    assert dense(result.voxels)[8:12, 4:8, 0:4].all()


def test_snap_is_at_most_a_voxel():
    result = voxelize(collider_scene(box([5.5, 2.0, 9.0], [9.5, 6.0, 13.0])), GRID)
    assert dense(result.voxels)[6:10, 2:6, 8:12].all()


def test_rounded_box_stays_inside_the_grid():
    result = voxelize(collider_scene(box([11, 11, 0], [16, 16, 16])), GRID)
    assert dense(result.voxels)[8:, 8:, :].all()
    assert result.objects[0].voxels == 8 * 8 * 16


@pytest.mark.parametrize(("pow2", "wanted"), [("none", True), ("box", False)])
def test_box_is_not_rounded_where_not_asked(pow2, wanted):
    result = voxelize(collider_scene(box([1, 1, 1], [4.5, 4.5, 4.5], pow2=wanted)), GRID, pow2=pow2)
    assert dense(result.voxels)[1:5, 1:5, 1:5].all()
    assert result.objects[0].voxels == 64


def test_flat_box_is_a_layer():
    result = voxelize(collider_scene(box([1, 1, 4], [5, 5, 4])), GRID, pow2="none")
    assert result.objects[0].voxels == 16


def turned(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0, 8], [s, c, 0, 8], [0, 0, 1, 8], [0, 0, 0, 1]])


def test_turned_box_is_exact_and_says_so():
    result = voxelize(collider_scene(box([-3, -3, -3], [3, 3, 3]), transform=turned(45)), GRID)
    assert [w.kind for w in result.warnings] == ["oriented-box"]
    same = voxelize(scene_of(SceneObject("o", box_mesh([-3] * 3, [3] * 3, 3), turned(45))), GRID)
    np.testing.assert_array_equal(dense(result.voxels), dense(same.voxels))
    quarter = voxelize(collider_scene(box([-4, -4, -4], [4, 4, 4]), transform=turned(90)), GRID)
    assert quarter.warnings == ()
    assert quarter.voxels.octant_levels.tolist() == []
    assert quarter.objects[0].voxels == 512


def ball_oracle(centre, radius, side):
    """Exact: the nearest point of the voxel is nearer than the radius."""
    low = np.arange(side, dtype=object) * UNIT
    away = [np.maximum(np.maximum(low - c, c - low - UNIT), 0) ** 2 for c in centre]
    square = away[0][:, None, None] + away[1][None, :, None] + away[2][None, None, :]
    return square < radius * radius


length = st.integers(0, 16 * UNIT)


@given(length, length, length, st.integers(1, 10 * UNIT))
def test_ball_is_exact(x, y, z, radius):
    ball = SphereCollider(np.array([x, y, z]) / UNIT, radius / UNIT)
    filled = dense(voxelize(collider_scene(ball), GRID).voxels)
    np.testing.assert_array_equal(filled == 3, ball_oracle((x, y, z), radius, 16))


@given(length, length, length, st.integers(UNIT // 2, 10 * UNIT))
def test_surface_of_a_ball_is_its_shell(x, y, z, radius):
    ball = SphereCollider(np.array([x, y, z]) / UNIT, radius / UNIT)
    filled = dense(voxelize(collider_scene(ball), GRID, fill="surface").voxels)
    low = np.arange(16, dtype=object) * UNIT
    far = [np.maximum(abs(low - c), abs(low + UNIT - c)) ** 2 for c in (x, y, z)]
    within = far[0][:, None, None] + far[1][None, :, None] + far[2][None, None, :] <= radius * radius
    np.testing.assert_array_equal(filled == 3, ball_oracle((x, y, z), radius, 16) & ~within.astype(bool))


@settings(max_examples=30)
@given(st.integers(0, 10**6))
def test_ellipsoid_lies_between_finer_and_finer_meshes(seed):
    rng = np.random.default_rng(seed)
    transform = np.eye(4)
    transform[:3, :3] = rng.normal(size=(3, 3)) * 3
    transform[:3, 3] = rng.uniform(4, 12, 3)
    filled = dense(voxelize(collider_scene(SphereCollider(np.zeros(3), 1.0), transform=transform), GRID).voxels) != 0
    within = icosphere(3)
    inscribed = dense(voxelize(scene_of(SceneObject("o", within, transform)), GRID).voxels) != 0
    around = Mesh(within.positions * 1.02, within.triangles, within.materials)
    circumscribed = dense(voxelize(scene_of(SceneObject("o", around, transform)), GRID).voxels) != 0
    assert not (inscribed & ~filled).any()
    assert not (filled & ~circumscribed).any()


def least_over_box(matrix, low, high):
    """The least d^T matrix d over a box, exactly: the least of the planes, lines and points of its faces that has its
    place within them (Fraction)."""
    best = None
    for fixed in itertools.product((None, 0, 1), repeat=3):
        held = {i: Fraction((low, high)[end][i]) for i, end in enumerate(fixed) if end is not None}
        free = [i for i in range(3) if i not in held]
        known = [-sum(matrix[i][k] * value for k, value in held.items()) for i in free]
        place = dict(held) | dict(zip(free, solved([[matrix[i][j] for j in free] for i in free], known), strict=True))
        if all(low[i] <= place[i] <= high[i] for i in range(3)):
            value = sum(matrix[i][j] * place[i] * place[j] for i in range(3) for j in range(3))
            best = value if best is None else min(best, value)
    return best


def solved(matrix, right):
    """Gauss' elimination in fractions."""
    rows = [[*map(Fraction, row), Fraction(value)] for row, value in zip(matrix, right, strict=True)]
    for k in range(len(rows)):
        pivot = next(i for i in range(k, len(rows)) if rows[i][k])
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [value / rows[k][k] for value in rows[k]]
        for i in range(len(rows)):
            if i != k:
                rows[i] = [a - rows[i][k] * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [row[-1] for row in rows]


def inverse_of_shape(linear):
    shape = [[sum(Fraction(int(a) * int(b)) for a, b in zip(p, q, strict=True)) for q in linear] for p in linear]
    columns = [solved(shape, [int(i == j) for i in range(3)]) for j in range(3)]
    return [[columns[j][i] for j in range(3)] for i in range(3)]


entry = st.integers(-6, 6) | st.integers(-6 * UNIT, 6 * UNIT).map(lambda units: Fraction(units, UNIT))


@settings(max_examples=25)
@hypothesis.example([[0.25, 0, 0], [0, 0.25, 0], [0, 0, 200000]], (1, 2, 2))  # far longer than the grid
@hypothesis.example([[0.25, 0, 3], [0, 0.5, 1], [0, 0, 200000]], (2, 2, 0))
@given(st.lists(st.lists(entry, min_size=3, max_size=3), min_size=3, max_size=3), st.tuples(*[st.integers(0, 4)] * 3))
def test_ellipsoid_is_exact(linear, centre):
    """Voxels around the surface, by rational arithmetic: touching does not count."""
    in_units = [[int(value * UNIT) for value in row] for row in linear]
    hypothesis.assume(abs(np.linalg.det(np.array(linear, float))) > 1e-6)
    transform = np.eye(4)
    transform[:3, :3], transform[:3, 3] = np.array(linear, float), centre
    grid = Grid(2, (0, 0, 0), 1.0)
    solid = SphereCollider(np.zeros(3), 1.0)
    filled = dense(voxelize(collider_scene(solid, transform=transform), grid).voxels) == 3
    shell = dense(voxelize(collider_scene(solid, transform=transform), grid, fill="surface").voxels) == 3
    inverse = inverse_of_shape(in_units)
    for cell in np.ndindex(filled.shape):
        low = [(cell[i] - centre[i]) * UNIT for i in range(3)]
        high = [value + UNIT for value in low]
        assert filled[cell] == (least_over_box(inverse, low, high) < 1), cell
        corners = itertools.product(*zip(low, high, strict=True))
        within = all(sum(inverse[i][j] * d[i] * d[j] for i in range(3) for j in range(3)) <= 1 for d in corners)
        assert shell[cell] == (filled[cell] and not within), cell


@pytest.mark.parametrize("radii", [(10, 5, 5), (3, 4, 5), (1, 7, 2), (6, 6, 1)])
def test_ellipsoid_that_touches_planes_between_voxels(radii):
    transform = np.diag([*map(float, radii), 1.0])
    transform[:3, 3] = 12
    grid = Grid(5, (0, 0, 0), 1.0)
    filled = dense(voxelize(collider_scene(SphereCollider(np.zeros(3), 1.0), transform=transform), grid).voxels) == 3
    near = np.array([max(0, v - 12, 12 - v - 1) for v in range(32)], dtype=object)
    square = [near**2 * (np.prod(radii, dtype=object) // r) ** 2 for r in radii]
    sums = square[0][:, None, None] + square[1][None, :, None] + square[2][None, None, :]
    np.testing.assert_array_equal(filled, sums < np.prod(radii, dtype=object) ** 2)


@pytest.mark.parametrize("thin", [0.0, 1e-9, 1e-4, 1e-2])
def test_needles_and_discs(thin):
    """Thinner than a fraction of a voxel, in any direction: the voxels along them, each connected to the next."""
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    for scale, least, most in (([20, thin, thin], 30, 150), ([20, 20, thin], 700, 4000)):
        transform = np.eye(4)
        transform[:3, :3], transform[:3, 3] = turn @ np.diag(scale), 32
        grid = Grid(6, (0, 0, 0), 1.0)
        result = voxelize(collider_scene(SphereCollider(np.zeros(3), 1.0), transform=transform), grid)
        assert least < result.objects[0].voxels < most


@settings(max_examples=40)
@given(st.lists(st.tuples(*[st.integers(0, 16)] * 3), min_size=1, max_size=40))
def test_hull_of_lattice_points(points):
    """A voxel is in the hull when its points and the voxel's corners cannot be parted: here by all planes of points."""
    cloud = np.array(points, float)
    result = voxelize(collider_scene(HullCollider(cloud)), GRID)
    filled = dense(result.voxels) != 0
    centre_of_mass = cloud.mean(axis=0)
    if np.linalg.matrix_rank(cloud - cloud[0]) == 3:
        assert filled[tuple(np.clip(np.floor(centre_of_mass).astype(int), 0, 15))]
        assert result.objects[0].mode == "exact"
    low, high = cloud.min(axis=0).astype(int), cloud.max(axis=0).astype(int)
    outside = np.ones((16,) * 3, bool)
    outside[tuple(slice(a, max(b, a + 1)) for a, b in zip(low, high, strict=True))] = False
    if np.linalg.matrix_rank(cloud - cloud[0]) == 3:
        assert not (filled & outside).any()


def test_hull_of_a_box_is_the_box():
    cloud = np.concatenate([box_mesh([2, 3, 4], [6, 9, 12]).positions, np.random.default_rng(0).uniform(4, 6, (50, 3))])
    result = voxelize(collider_scene(HullCollider(cloud)), GRID)
    assert dense(result.voxels)[2:6, 3:9, 4:12].all()
    assert result.objects[0].voxels == 4 * 6 * 8


def test_mesh_collider_takes_the_colliders_material():
    mesh = box_mesh([1, 1, 1], [3, 3, 3])
    result = voxelize(collider_scene(MeshCollider(mesh.positions, mesh.triangles)), GRID)
    assert (dense(result.voxels)[1:3, 1:3, 1:3] == 3).all()


def test_geometry_chooses():
    mesh = box_mesh([0, 0, 0], [2, 2, 2], material=5)
    ball = SphereCollider(np.full(3, 8.0), 3.0)
    scene = collider_scene(ball, mesh=mesh)
    assert voxelize(scene, GRID).objects[0].source == "sphere"
    rendered = voxelize(scene, GRID, geometry="render")
    assert rendered.objects[0].source == "mesh"
    assert (dense(rendered.voxels)[:2, :2, :2] == 5).all()
    plain = scene_of(SceneObject("o", mesh))
    boxed = voxelize(plain, GRID, geometry="collider")
    assert boxed.objects[0].source == "box"
    assert [(w.kind, w.count) for w in boxed.warnings] == [("no-collider", 1)]
    assert (dense(boxed.voxels)[:2, :2, :2] == 5).all()
