"""Colours voxel by voxel: against points on triangles found by brute force, and by cases whose answer is known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from oracles.meshes import box_mesh, icosphere, one_object
from oracles.voxels import dense, flat_cover, snap, triangle_cover, voxel_colours

from voxrt.voxelize import (
    EMPTY,
    Appearance,
    BoxCollider,
    DoesNotFitError,
    Grid,
    Material,
    MaterialMap,
    Mesh,
    Scene,
    SceneObject,
    SurfaceAppearance,
    Texture,
    assign_colours,
    voxelize,
)
from voxrt.voxelize.colour.srgb import linear_from_srgb

UNIT_GRID = {depth: Grid(depth, (0.0, 0.0, 0.0), 1.0) for depth in range(1, 17)}
PAINT = Material("appearance", (1, 2, 3))
ARRAYS = (
    *("brick_codes", "brick_masks", "brick_materials", "brick_rows", "cells"),
    *("octant_codes", "octant_levels", "octant_materials"),
)


def soup(random, side, count):
    """Random triangles, some of them beyond the grid, some on planes between voxels."""
    corners = random.uniform(-0.2 * side, 1.2 * side, (count, 1, 3)) + random.uniform(-0.4, 0.4, (count, 3, 3)) * side
    corners[::4] = np.rint(corners[::4])
    return Mesh(corners.reshape(-1, 3), np.arange(3 * count, dtype=np.int32).reshape(-1, 3), np.ones(count, np.uint8))


def coated(mesh, *, uv=None, colours=None, **appearance):
    count = len(mesh.triangles)
    uv = np.zeros((count, 3, 2)) if uv is None else uv
    colours = np.ones((count, 3, 4)) if colours is None else colours
    return replace(
        mesh,
        appearance=SurfaceAppearance(
            (Appearance("p", **appearance),), np.zeros(count, np.int32), uv, colours.astype(np.float32)
        ),
    )


def painted(mesh, **how):
    return Scene("test", (SceneObject("o", coated(mesh, **how)),), (EMPTY, PAINT))


def same(one, other):
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in ARRAYS)


def nearest_shares(corners, point):
    """Barycentric coordinates of a triangle's point nearest to `point`: of all faces, edges and corners the nearest."""
    best, found = np.inf, None
    for chosen in ([0, 1, 2], [0, 1], [1, 2], [2, 0], [0], [1], [2]):
        base = corners[chosen[0]]
        edges = (corners[chosen[1:]] - base).T
        weights = np.linalg.lstsq(edges, point - base, rcond=None)[0] if len(chosen) > 1 else np.zeros(0)
        shares = np.zeros(3)
        shares[chosen] = [1 - weights.sum(), *weights]
        distance = np.linalg.norm(shares @ corners - point)
        if shares.min() >= -1e-12 and distance < best - 1e-12:
            best, found = distance, shares
    return found


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 4), st.sampled_from(["solid", "surface"]), st.booleans())
def test_colours_do_not_change_what_is_covered(seed, depth, fill, closed):
    random = np.random.default_rng(seed)
    side = 2**depth
    mesh = icosphere(1, (side / 2,) * 3, 0.4 * side) if closed else soup(random, side, 12)
    scene = painted(mesh, colours=random.random((len(mesh.triangles), 3, 4)))
    grid = UNIT_GRID[depth]
    plain, tinted = voxelize(scene, grid, fill=fill), voxelize(assign_colours(scene, grid), grid, fill=fill)
    np.testing.assert_array_equal(dense(plain.voxels) != 0, dense(tinted.voxels) != 0)
    assert plain.objects == tinted.objects


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32), st.integers(2, 4))
def test_each_voxel_takes_the_cell_at_the_nearest_point_of_its_first_triangle(seed, depth):
    random = np.random.default_rng(seed)
    side = 2**depth
    mesh = soup(random, side, 5)
    sizes = random.integers(1, 9, (5, 2)).astype(np.int32)
    sizes[3] = 0
    places = (random.random((5, 3, 2)) * sizes[:, None]).astype(np.float32)
    materials = random.integers(2, 256, int(sizes.prod(axis=1).sum())).astype(np.uint8)
    starts = np.cumsum(sizes.prod(axis=1)) - sizes.prod(axis=1)
    scene = one_object(replace(mesh, material_map=MaterialMap(sizes, places, materials)))
    found = dense(voxelize(scene, UNIT_GRID[depth], fill="surface").voxels)

    left = np.ones_like(found, bool)
    vertices = snap(mesh.positions, np.eye(4), (0, 0, 0), 1.0)
    for at, triangle in enumerate(mesh.triangles):
        corners = vertices[triangle]
        cover = (triangle_cover(corners, side) | flat_cover(corners, side)) & left
        left &= ~cover
        for voxel in np.argwhere(cover):
            if at == 3:
                assert found[tuple(voxel)] == 1
                continue
            if not np.cross(corners[1] - corners[0], corners[2] - corners[0]).any():
                continue  # a point of it has several places in the raster
            place = nearest_shares(corners / 4096, voxel + 0.5) @ places[at].astype(float)
            # A place on the border between cells may be in either.
            near = {
                (int(np.clip(np.floor(place[1] + dv), 0, sizes[at, 1] - 1)), int(np.clip(np.floor(u), 0, top)))
                for dv in (-1e-6, 1e-6)
                for top in [sizes[at, 0] - 1]
                for u in (place[0] - 1e-6, place[0] + 1e-6)
            }
            allowed = {int(materials[starts[at] + row * sizes[at, 0] + column]) for row, column in near}
            assert int(found[tuple(voxel)]) in allowed
    assert not found[left].any()


BLOCKS = np.array([[(255, 0, 0), (0, 255, 0), (10, 20, 30)], [(0, 0, 255), (255, 255, 0), (200, 100, 50)]], np.uint8)


def blocks_between(low, high):
    """The colours of BLOCKS between two places, 0 … 1."""
    top = np.array([3, 2])
    first, last = (np.clip(np.floor(place * top), 0, top - 1).astype(int) for place in (low, high))
    return {tuple(BLOCKS[v, u].tolist()) for u in range(first[0], last[0] + 1) for v in range(first[1], last[1] + 1)}


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32), st.booleans())
def test_colours_are_those_of_the_image_around_the_nearest_point(seed, turned):
    """A rectangle anywhere in the grid; the image's pixels are larger than voxels, so their colours are exact."""
    random = np.random.default_rng(seed)
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0][:2]
    lengths = random.uniform([6, 4], [14, 12])
    origin = np.full(3, 16) - lengths @ axes / 2 + random.uniform(-1, 1, 3)
    flat = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    if turned:
        triangles = np.roll(triangles, 1, axis=1)
    texture = Texture(np.dstack([BLOCKS, np.full((2, 3), 255, np.uint8)]), ("clamp", "clamp"), nearest=True)
    mesh = Mesh(origin + flat * lengths @ axes, triangles, np.ones(2, np.uint8))
    grid = UNIT_GRID[5]
    coloured = assign_colours(painted(mesh, uv=flat[triangles], texture=texture), grid)
    found = voxel_colours(voxelize(coloured, grid, fill="surface").voxels, coloured.materials)
    covered = np.argwhere(found[..., 0] >= 0)
    assert len(covered) > 20
    reach = 0.75 / lengths  # half a cell's diagonal
    for voxel in covered:
        nearest = np.clip(axes @ (voxel + 0.5 - origin) / lengths, 0, 1)
        assert tuple(found[tuple(voxel)].tolist()) in blocks_between(nearest - reach, nearest + reach)


def test_vertex_colours_change_evenly_over_a_large_triangle():
    corners = np.array([[0.5, 0.5, 0.5], [60.5, 0.5, 0.5], [0.5, 60.5, 0.5]])
    ends = np.zeros((1, 3, 4))
    ends[0, :, :3] = np.eye(3)
    mesh = Mesh(corners, np.array([[0, 1, 2]], np.int32), np.ones(1, np.uint8))
    grid = UNIT_GRID[6]
    coloured = assign_colours(painted(mesh, colours=ends), grid, colours=254)
    found = voxel_colours(voxelize(coloured, grid, fill="surface").voxels, coloured.materials)
    for x, y, z in np.argwhere(found[..., 0] >= 0):
        if x + y < 59:
            linear = np.array([1 - x / 60 - y / 60, x / 60, y / 60])
            assert np.abs(linear_from_srgb(found[x, y, z]) - linear).max() < 0.09  # 254 colours of a thousand


def test_textures_finer_than_voxels_are_mixed_in_linear_light():
    checks = np.zeros((256, 256, 4), np.uint8)
    checks[::2, ::2] = checks[1::2, 1::2] = 255
    checks[:, :, 3] = 255
    corners = np.array([[0, 0, 0.5], [16, 0, 0.5], [16, 16, 0.5], [0, 16, 0.5]])
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    uv = (corners[:, :2] / 16)[triangles]
    scene = assign_colours(
        painted(Mesh(corners, triangles, np.ones(2, np.uint8)), uv=uv, texture=Texture(checks)), UNIT_GRID[4]
    )
    assert [material.colour for material in scene.materials[2:]] == [(188, 188, 188)]


def test_few_colours_are_exact_and_uniform_materials_stay():
    mesh = box_mesh([0, 0, 0], [8, 8, 8])
    colours = np.ones((12, 3, 4))
    shades = np.array([(9, 8, 7), (200, 100, 0), (0, 0, 0)], np.uint8)
    colours[..., :3] = linear_from_srgb(shades)[np.arange(12) % 3][:, None]
    surface_appearance = coated(mesh, colours=colours).appearance
    mesh = replace(mesh, appearance=replace(surface_appearance, rows=np.array([-1, *[0] * 11], np.int32)))
    mesh = replace(mesh, materials=np.array([2, *[1] * 11], np.uint8))
    own = (EMPTY, replace(PAINT, colour=(200, 100, 0)), Material("steel", (70, 70, 70)))
    scene = assign_colours(Scene("test", (SceneObject("o", mesh),), own), UNIT_GRID[3])
    assert scene.materials[:3] == own
    # A colour that the appearance's own material has is that material.
    assert [(one.name, one.colour) for one in scene.materials[3:]] == [
        ("appearance #000000", (0, 0, 0)),
        ("appearance #090807", (9, 8, 7)),
    ]
    assert set(np.unique(dense(voxelize(scene, UNIT_GRID[3]).voxels))) == {1, 2, 3, 4}


def sphere_scene(count=3):
    random = np.random.default_rng(5)
    pixels = random.integers(0, 256, (64, 64, 4), np.uint8)
    mesh = icosphere(2, (16, 16, 16), 13)
    uv = random.random((len(mesh.triangles), 3, 2))
    mesh = coated(mesh, uv=uv, texture=Texture(pixels))
    objects = [SceneObject(f"o{at}", mesh, np.diag([1 / (at + 1)] * 3 + [1])) for at in range(count)]
    return Scene("test", tuple(objects), (EMPTY, PAINT))


def test_the_result_does_not_depend_on_threads_nor_on_the_run():
    results = []
    for threads in (1, 3):
        scene = assign_colours(sphere_scene(), UNIT_GRID[5])
        results.append((scene.materials, voxelize(scene, UNIT_GRID[5], threads=threads).voxels))
    assert results[0][0] == results[1][0]
    assert same(results[0][1], results[1][1])


@pytest.mark.parametrize("colours", [1, 2, 32, 254])
def test_there_are_no_more_colours_than_asked_for(colours):
    scene = assign_colours(sphere_scene(), UNIT_GRID[5], colours=colours)
    assert len(scene.materials) <= 2 + colours
    assert len(scene.materials) > 2 + colours * 0.7


def test_instances_share_one_raster_of_the_finest():
    scene = assign_colours(sphere_scene(), UNIT_GRID[5])
    assert len({id(item.mesh) for item in scene.objects}) == 1
    alone = assign_colours(sphere_scene(1), UNIT_GRID[5])
    assert np.array_equal(scene.objects[0].mesh.material_map.sizes, alone.objects[0].mesh.material_map.sizes)


@pytest.mark.parametrize("fill", ["solid", "surface"])
def test_what_alpha_cuts_away_is_empty_and_the_rest_stays(fill):
    """A box of which the half beyond x = 4 is transparent."""
    mesh = box_mesh([0, 0, 0], [8, 8, 8])
    uv = mesh.positions[mesh.triangles][:, :, :2] / 8
    pixels = np.zeros((1, 8, 4), np.uint8)
    pixels[:, :4] = (255, 0, 0, 255)
    scene = painted(mesh, uv=uv, texture=Texture(pixels, ("clamp", "clamp"), nearest=True), cutoff=0.5)
    found = dense(voxelize(assign_colours(scene, UNIT_GRID[3]), UNIT_GRID[3], fill=fill).voxels)
    uncut = dense(voxelize(scene, UNIT_GRID[3], fill=fill).voxels)
    shell = dense(voxelize(scene, UNIT_GRID[3], fill="surface").voxels) != 0
    np.testing.assert_array_equal(found[:4] != 0, uncut[:4] != 0)
    assert not found[4:][shell[4:]].any()
    np.testing.assert_array_equal((found != 0)[~shell], (uncut != 0)[~shell])


def test_surface_that_is_cut_away_hides_no_other():
    near = np.array([[0.0, 0, 1.2], [8, 0, 1.2], [0, 8, 1.2]])
    far = near + np.array([0, 0, 0.5])
    mesh = Mesh(np.concatenate([near, far]), np.arange(6, dtype=np.int32).reshape(2, 3), np.ones(2, np.uint8))
    colours = np.ones((2, 3, 4))
    colours[0, :, 3] = 0
    found = dense(
        voxelize(assign_colours(painted(mesh, colours=colours, cutoff=0.5), UNIT_GRID[3]), UNIT_GRID[3]).voxels
    )
    whole = dense(voxelize(painted(mesh), UNIT_GRID[3]).voxels)
    np.testing.assert_array_equal(found != 0, whole != 0)


def test_all_may_be_cut_away():
    mesh = Mesh(np.array([[0.0, 0, 1], [8, 0, 1], [0, 8, 1]]), np.array([[0, 1, 2]], np.int32), np.ones(1, np.uint8))
    scene = assign_colours(painted(mesh, colours=np.zeros((1, 3, 4)), cutoff=0.5), UNIT_GRID[3])
    assert scene.materials == (EMPTY, PAINT)
    assert not dense(voxelize(scene, UNIT_GRID[3]).voxels).any()


def test_mirrors_stay_mirrors():
    scene = sphere_scene(1)
    glass = replace(PAINT, mirror=True)
    objects = (
        scene.objects[0],
        SceneObject("other", replace(scene.objects[0].mesh, materials=np.full(320, 2, np.uint8))),
    )
    tinted = assign_colours(
        Scene("test", objects, (EMPTY, glass, Material("matt", (0, 0, 0)))), UNIT_GRID[4], colours=20
    )
    assert {one.mirror for one in tinted.materials[3:] if one.name.startswith("appearance #")} == {True}
    assert {one.mirror for one in tinted.materials[3:] if one.name.startswith("matt #")} == {False}


def test_ids_that_were_left_out_are_taken_where_there_are_no_others():
    gap = Material("unused", (0, 0, 0), authored=False)
    table = (EMPTY, PAINT, *[gap] * 253, Material("last", (4, 4, 4)))
    scene = assign_colours(replace(sphere_scene(), materials=table), UNIT_GRID[4], colours=4)
    assert len(scene.materials) == 256
    assert [one.name.split()[0] for one in scene.materials[2:6]] == ["appearance"] * 4
    assert scene.materials[255].name == "last"
    full = (EMPTY, PAINT, *[Material("own", (0, 0, 0))] * 254)
    with pytest.raises(DoesNotFitError, match="leave none for textures and vertex colours; merge some"):
        assign_colours(replace(sphere_scene(), materials=full), UNIT_GRID[4])


def test_scenes_without_paint_and_objects_with_colliders_stay_as_they_are():
    plain = one_object(box_mesh([0, 0, 0], [4, 4, 4]))
    assert assign_colours(plain, UNIT_GRID[3]) is plain
    scene = painted(box_mesh([0, 0, 0], [4, 4, 4]))
    boxed = replace(scene.objects[0], colliders=(BoxCollider(np.zeros(3), np.ones(3)),))
    scene = replace(scene, objects=(boxed,))
    assert assign_colours(scene, UNIT_GRID[3]) is scene
    assert assign_colours(scene, UNIT_GRID[3], geometry="render") is not scene


@pytest.mark.parametrize("colours", [0, 255, -1])
def test_the_number_of_colours_is_checked(colours):
    with pytest.raises(ValueError, match="colours must be an integer 1 … 254"):
        assign_colours(sphere_scene(), UNIT_GRID[3], colours=colours)


def test_memory_is_bounded_however_many_voxels_are_covered():
    tints = assign_colours(painted(box_mesh([0, 0, 0], [65536] * 3)), UNIT_GRID[16]).objects[0].mesh.material_map
    assert 1 << 22 < tints.sizes.prod(axis=1).sum() == len(tints.materials) <= 1 << 23
    sliver = np.array([[0.0, 0, 0], [65536, 0, 0], [30000, 0.5, 0]])
    mesh = Mesh(sliver, np.array([[0, 1, 2]], np.int32), np.ones(1, np.uint8))
    assert assign_colours(painted(mesh), UNIT_GRID[16]).objects[0].mesh.material_map.sizes.tolist() == [[65536, 1]]


@pytest.mark.parametrize(
    ("broken", "message"),
    [
        ("sizes", "Mesh.material_map is for 5 triangles, and the mesh has 12"),
        ("corners", r"MaterialMap.corners must have shape \(12, 3, 2\), not \(5, 3, 2\)"),
        ("materials", r"MaterialMap.materials must have shape \(12,\), not \(5,\)"),
        ("negative", r"MaterialMap.sizes\[3, 0\] must be an integer 0 … 65536, not -1"),
        ("long", r"MaterialMap.sizes\[3, 0\] must be an integer 0 … 65536, not 131072"),
        ("half", "MaterialMap.sizes must be 0 in both columns of a row, or in neither"),
    ],
)
def test_material_maps_that_do_not_fit_their_mesh_are_refused(broken, message):
    mesh = box_mesh([0, 0, 0], [4, 4, 4])
    sizes, corners, materials = np.ones((12, 2), np.int32), np.zeros((12, 3, 2), np.float32), np.ones(12, np.uint8)
    if broken == "sizes":
        sizes, corners, materials = sizes[:5], corners[:5], materials[:5]
    elif broken == "corners":
        corners = corners[:5]
    elif broken == "materials":
        materials = materials[:5]
    elif broken == "negative":
        sizes[3] = -1
    elif broken == "long":
        sizes[3] = 1 << 17
    else:
        sizes[3] = (0, 1)
    with pytest.raises(ValueError, match=message):
        replace(mesh, material_map=MaterialMap(sizes, corners, materials))
