"""The ray of a double-click and the bounds of a scene, against the exact model and dense voxels."""

from __future__ import annotations

import numpy as np
import pytest
from oracles import worlds
from oracles.cuts import memory_of

from voxrt.board.scene import Scene
from voxrt.octree import Octree
from voxrt.serve.ray_cast import cast_ray
from voxrt.serve.solid_bounds import solid_bounds
from voxrt.sim import FACE_NONE, cast_rays

DEPTH = 4
WORLDS = {
    "noise": worlds.noise(DEPTH, 0.05, 3),
    "boxes": worlds.boxes(DEPTH, 9, 3),
    "ball": worlds.ball(DEPTH),
    "empty": np.zeros((16, 16, 16), np.uint8),
    "full": np.full((16, 16, 16), 7, np.uint8),
}


def scene_of(voxels):
    return Scene("scene", DEPTH, memory_of(voxels), np.zeros((256, 3), np.uint8), np.zeros(256, bool))


@pytest.mark.parametrize("world", WORLDS)
def test_rays_hit_what_the_model_hits(world):
    voxels = WORLDS[world]
    scene = scene_of(voxels)
    rng = np.random.default_rng(8)
    origins = rng.integers(-4, 21, (600, 3)) * 16 + rng.choice([0, 0, 5], (600, 3))  # in, around and on planes
    directions = rng.choice([-7, -3, -1, 0, 1, 2, 9], (600, 3))
    directions[~directions.any(axis=1)] = 1
    expected = cast_rays(Octree(DEPTH, scene.words), origins / 16, directions)
    for number, (origin, direction) in enumerate(zip(origins.tolist(), directions.tolist(), strict=True)):
        hit = cast_ray(scene, tuple(origin), tuple(direction))
        assert (hit is not None) == expected.hit[number]
        if hit is not None:
            assert hit.voxel == tuple(expected.voxel[number])
            assert hit.material == expected.material[number]
            assert (FACE_NONE if hit.face is None else hit.face) == expected.face[number]
            place = np.array(origin) / 16 + expected.parameter[number] * np.array(direction)
            assert hit.point == pytest.approx(place, abs=1e-9)


def test_a_ray_without_direction_sees_its_own_voxel():
    scene = scene_of(WORLDS["boxes"])
    solid, empty = np.argwhere(WORLDS["boxes"])[0], np.argwhere(WORLDS["boxes"] == 0)[0]
    assert cast_ray(scene, tuple((16 * solid + 8).tolist()), (0, 0, 0)).voxel == tuple(solid)
    assert cast_ray(scene, tuple((16 * empty + 8).tolist()), (0, 0, 0)) is None


@pytest.mark.parametrize("world", WORLDS)
def test_bounds_hold_the_solid_voxels_and_no_more(world):
    solid = np.argwhere(WORLDS[world])
    bounds = solid_bounds(scene_of(WORLDS[world]))
    if len(solid) == 0:
        assert bounds is None
    else:
        assert bounds == (tuple(solid.min(axis=0)), tuple(solid.max(axis=0) + 1))


def test_bounds_of_one_voxel_in_any_corner():
    for place in np.ndindex(2, 2, 2):
        voxels = np.zeros((16, 16, 16), np.uint8)
        corner = tuple(13 * axis + 1 for axis in place)
        voxels[corner] = 1
        assert solid_bounds(scene_of(voxels)) == (corner, tuple(axis + 1 for axis in corner))
