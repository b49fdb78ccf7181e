"""Baked light on scenes whose light is known."""

import numpy as np
import pytest
from oracles import ray
from oracles.meshes import box_mesh, icosphere, joined, one_object, scene_of

import voxrt
from voxrt.octree import census, to_dense
from voxrt.sim import _bake
from voxrt.sim.baking.bake import bake_light
from voxrt.sim.baking.daylight import SKY, SUN, Daylight, sky_light
from voxrt.voxelize import EMPTY, Grid, Material, Scene, SceneObject, assign_colours, fit_grid, voxelize

WHITE = (EMPTY, Material("white", (255, 255, 255)))


def baked(scene, depth=5, daylight=None, *, threads=0, grid=None):
    grid = grid or fit_grid(scene, depth=depth)
    scene = assign_colours(scene, grid)
    tree = voxrt.octree.build(voxelize(scene, grid).voxels)
    rom = voxrt.Rom("scene", tree, scene.materials, grid)
    return bake_light(rom, scene, daylight, threads=threads)


def white(*meshes):
    return Scene("white", tuple(SceneObject(f"o{i}", mesh) for i, mesh in enumerate(meshes)), WHITE)


def at(light, where):
    return np.flatnonzero((light.voxels == where).all(axis=1))[0]


def test_an_open_plane_gets_the_whole_sky_and_the_sun_by_its_cosine():
    light = baked(white(box_mesh((0, 0, 0), (32, 2, 32))), grid=Grid(5, (0, 0, 0), 1))
    middle = at(light, (16, 1, 16))
    assert light.sky[middle] == 1
    cosine = SUN[1] / np.linalg.norm(SUN)
    assert light.sun[middle] == pytest.approx(0.65 * cosine, abs=0.002)
    linear = 0.65 * cosine + SKY
    encoded = round(255 * (1.055 * linear ** (1 / 2.4) - 0.055))
    assert abs(int(light.colours[middle, 1]) - encoded) <= 1
    assert light.sky[at(light, (16, 0, 16))] == 0.5  # from below the horizon comes half as much
    assert light.sun[at(light, (16, 0, 16))] == 0


def test_a_wall_sees_half_of_sky_and_ground_and_casts_a_shadow():
    scene = white(box_mesh((0, 0, 0), (32, 2, 32)), box_mesh((14, 2, 0), (18, 30, 32)))
    light = baked(scene, grid=Grid(5, (0, 0, 0), 1), daylight=Daylight(sun=(1, 1, 0)))
    floor = light.voxels[:, 1] == 1
    floor &= (light.voxels[:, 2] > 4) & (
        light.voxels[:, 2] < 27
    )  # light is measured before the surface: not at its end
    lit, shaded = floor & (light.voxels[:, 0] > 20), floor & (light.voxels[:, 0] < 12)
    assert light.sun[lit].min() > 0.4
    assert light.sun[shaded].max() == 0
    assert light.sky[at(light, (20, 1, 16))] < light.sky[at(light, (29, 1, 16))] < 1  # darker in the corner


def test_a_closed_room_is_dark_inside_and_not_outside():
    # 4 voxels of wall around an empty room.
    room = joined(box_mesh((0, 0, 0), (32, 32, 32)), box_mesh((4, 4, 4), (28, 28, 28), inverted=True))
    light = baked(white(room), grid=Grid(5, (0, 0, 0), 1))
    inside = ((light.voxels >= 3) & (light.voxels <= 28)).all(axis=1)
    assert inside.sum() > 2000
    assert light.sky[inside].max() == 0
    assert light.sun[inside].max() == 0
    assert light.sky[~inside].min() >= 0.5
    assert (light.colours[inside] == 0).all()


@pytest.mark.parametrize("daylight", [None, Daylight(sun=(-2, 1, 0.5), sky=(0.1, 0.2, 0.3), samples=12)])
def test_every_voxel_has_the_light_of_rational_rays(daylight):
    # The points and normals are taken as they are; what they see, and what it comes to, is found again.
    scene = scene_of(icosphere(2, (8, 9, 8), 5.5), box_mesh((1, 1, 1), (15, 2, 15), 2))
    light = baked(scene, grid=Grid(4, (0, 0, 0), 1), daylight=daylight)
    cube, surface = to_dense(light.rom.octree), light._surface
    daylight = daylight or Daylight()
    sky, sun = _bake.sky_directions(daylight.samples), _bake.sun_direction(daylight.sun)
    chosen = np.random.default_rng(0).choice(len(light.voxels), 25, replace=False)

    def share(origin, normal, directions):
        units = directions.steps / np.linalg.norm(directions.steps, axis=1, keepdims=True)
        cosines = np.maximum(units @ normal, 0)
        radiance = directions.weights / 65536
        sees = [ray.trace(cube, 16 * origin + 8, step)[0] == 0 for step in directions.steps]
        return (cosines * radiance * sees).sum(), cosines.sum()

    def light_at(origin, normal):
        received, full = share(origin, normal, sky)
        return 0.65 * share(origin, normal, sun)[0], received / full

    by_voxel = {}
    for row, number in enumerate(surface.voxels.tolist()):
        by_voxel.setdefault(number, []).append(row)
    for index in chosen.tolist():
        rows = by_voxel[int(light._rows[index])]
        candidates = [light_at(surface.origins[row], surface.normals[row] / 16384) for row in rows]
        total = max(of_sun + np.mean(daylight.sky) * share for of_sun, share in candidates)
        if total < 0.1 * (0.65 + np.mean(daylight.sky)):  # half of what its exposed faces get
            for way in np.concatenate([np.eye(3, dtype=int), -np.eye(3, dtype=int)]):
                beyond = light.voxels[index] + way
                if (beyond < 0).any() or (beyond >= len(cube)).any() or not cube[tuple(beyond)]:
                    candidates.append(tuple(part / 2 for part in light_at(beyond, way)))
        best = max(candidates, key=lambda pair: pair[0] + np.mean(daylight.sky) * pair[1])
        assert light.sun[index] == pytest.approx(best[0], abs=2e-4)
        assert light.sky[index] == pytest.approx(best[1], abs=2e-4)


def test_normals_of_a_sphere_are_radial_and_rays_start_in_empty_voxels_beside_it():
    light = baked(white(icosphere(4, (16, 16, 16), 13)), grid=Grid(5, (0, 0, 0), 1))
    surface = light._surface
    radial = light.voxels + 0.5 - 16
    radial /= np.linalg.norm(radial, axis=1, keepdims=True)
    assert len(surface.voxels) == len(light.voxels)
    assert np.einsum("nc,nc->n", surface.normals / 16384, radial).min() > 0.99
    assert light.sky.min() >= 0.5 - 1e-9  # convex: nothing hides the sky, and it is darkest below
    cube = np.pad(to_dense(light.rom.octree), 4)
    assert not cube[tuple((surface.origins + 4).T)].any()
    assert np.abs(surface.origins - light.voxels).max() <= 3


def test_a_box_is_smooth_on_its_faces_and_has_edges():
    light = baked(white(box_mesh((4, 4, 4), (28, 28, 28))), grid=Grid(5, (0, 0, 0), 1))
    normals = light._surface.normals
    top = (light.voxels[:, 1] == 27) & (np.abs(light.voxels[:, [0, 2]] - 15.5).max(axis=1) < 10)
    assert (normals[top] == (0, 16384, 0)).all()


def test_a_sheet_shows_its_lit_side():
    sheet = voxrt.voxelize.Mesh([[2, 9, 2], [30, 9, 2], [30, 9, 30], [2, 9, 30]], [[0, 1, 2], [0, 2, 3]], [1, 1])
    light = baked(white(sheet), grid=Grid(5, (0, 0, 0), 1))
    assert (light.sky == 1).all()  # though its triangles face down
    assert light.sun.min() > 0.5


def test_colliders_have_the_normals_of_their_voxels():
    item = SceneObject(
        "ball", box_mesh((0, 0, 0), (1, 1, 1)), np.eye(4), (voxrt.voxelize.BoxCollider((4, 4, 4), (20, 20, 20)),)
    )
    light = baked(Scene("box", (item,), WHITE), grid=Grid(5, (0, 0, 0), 1))
    normals = light._surface.normals
    top = light.voxels[:, 1] == light.voxels[:, 1].max()
    inner = top & (np.abs(light.voxels[:, [0, 2]] - 11.5).max(axis=1) < 5)
    assert inner.any()
    assert (normals[inner] == (0, 16384, 0)).all()


def test_the_memory_holds_the_colours_and_the_same_voxels():
    scene = scene_of(icosphere(3, (16, 16, 16), 13, material=200), box_mesh((1, 1, 1), (31, 3, 31), 90))
    light = baked(scene, grid=Grid(5, (0, 0, 0), 1))
    before, rom = to_dense(light.rom.octree), light.memory()
    after = to_dense(rom.octree)
    assert ((before != 0) == (after != 0)).all()
    exposed = np.zeros(before.shape, bool)
    exposed[tuple(light.voxels.T)] = True
    padded = np.pad(before != 0, 1)
    seen = np.zeros(before.shape, bool)
    for axis in range(3):
        for step in (-1, 1):
            seen |= ~np.roll(padded, step, axis)[1:-1, 1:-1, 1:-1]
    assert (exposed == (seen & (before != 0))).all()
    assert (after[~exposed] == before[~exposed]).all()  # what is not seen keeps its material
    table = np.array([one.colour for one in rom.materials])
    found = table[after[tuple(light.voxels.T)]]
    assert len(rom.materials) <= 256
    assert np.abs(found - light.colours.astype(int)).max() <= 16
    assert np.abs(found - light.colours.astype(int)).mean() < 1
    few = light.memory(5)
    assert (
        len({few.materials[number].colour for number in census(few.octree).voxels if number} - {(200,) * 3, (90,) * 3})
        <= 5
    )


def test_mirrors_are_not_baked():
    materials = (EMPTY, Material("white", (255, 255, 255)), Material("mirror", (10, 200, 30), mirror=True))
    scene = Scene("mirror", (SceneObject("m", box_mesh((2, 2, 2), (30, 30, 30), 2)),), materials)
    rom = baked(scene, grid=Grid(5, (0, 0, 0), 1)).memory()
    assert {rom.materials[number] for number in census(rom.octree).voxels if number} == {materials[2]}


def test_bytes_do_not_depend_on_threads():
    scene = one_object(icosphere(3, (16, 16, 16), 13, material=200))
    memories = [baked(scene, threads=threads).memory(threads=threads) for threads in (1, 3)]
    assert memories[0].octree.words.tobytes() == memories[1].octree.words.tobytes()
    assert memories[0].materials == memories[1].materials


@pytest.mark.parametrize("depth", [1, 2, 3])
def test_the_smallest_worlds(depth):
    side = 1 << depth
    light = baked(white(box_mesh((0, 0, 0), (side, side, side))), grid=Grid(depth, (0, 0, 0), 1))
    rom = light.memory()
    assert census(rom.octree).solid_voxels == side**3
    assert len(light.voxels) == side**3 - max(side - 2, 0) ** 3


def test_daylight_is_checked():
    with pytest.raises(ValueError, match="samples must be an integer 1 … 4096, not 0"):
        Daylight(samples=0)
    with pytest.raises(ValueError, match="sky must be light of 0 … 16, not -1"):
        Daylight(sky=(0, -1, 0))
    with pytest.raises(ValueError, match="sky must be a colour like '#9db4d0', not 'blue'"):
        sky_light("blue")
    assert len(_bake.sun_direction((0, 0, 0)).steps) == 0
