"""What the viewer shows beside the octants."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

import voxrt
from voxrt.octree import census
from voxrt.view.scene_overlay import find_owners, preview_of, scene_triangles
from voxrt.voxelize import DoesNotFitError

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.mark.parametrize("name", ["house.obj", "dog.usda"])
def test_owners_have_the_voxels_that_the_build_reports(name):
    built = voxrt.build(EXAMPLES / name, depth=5)
    owners = find_owners(built.scene, built.rom.grid)
    assert owners.names == tuple(item.name for item in built.objects)
    owned = census(owners.octree).voxels
    assert [owned.get(number, 0) for number in range(1, len(owners.names) + 1)] == [o.voxels for o in built.objects]


def test_owners_of_too_many_objects():
    built = voxrt.build(EXAMPLES / "house.obj", depth=3)
    many = replace(built.scene, objects=built.scene.objects * 256)
    with pytest.raises(DoesNotFitError, match="owners can be told of 255 objects"):
        find_owners(many, built.rom.grid)


def test_triangles_stand_in_the_grid_and_face_outwards():
    built = voxrt.build(EXAMPLES / "house.obj", depth=5)
    mirrored = np.diag([-1.0, 1, 1, 1])
    objects = tuple(replace(item, transform=mirrored @ item.transform) for item in built.scene.objects)
    volumes = []
    for scene in (built.scene, replace(built.scene, objects=objects)):
        triangles = scene_triangles(scene, built.rom.grid)
        volumes.append(np.linalg.det(triangles).sum() / 6)
    assert triangles.shape[1:] == (3, 3)
    assert volumes[0] > 0
    assert volumes[1] == pytest.approx(volumes[0])
    whole = scene_triangles(built.scene, built.rom.grid)
    assert -1e-6 < whole.min() < whole.max() < 32 + 1e-6


def test_a_previews_rays_are_those_of_its_pixels():
    rom = voxrt.build(EXAMPLES / "house.obj", depth=5).rom
    preview = preview_of(rom, voxrt.aim_camera(rom, (32, 24)), (32, 24), (16, 12))
    for pixel in ((16, 12), (0, 0)):
        ray = preview.follow(pixel)
        hit = ray.words[-1] if len(ray.words) else 0
        background = tuple(preview.colour[pixel[1], pixel[0]]) == rom.materials[0].colour
        assert background == (hit & 0xFF == 0)
        assert len(ray.words) == len(ray.corners) == len(ray.levels) == len(ray.points)
        assert ray.table[0] == f"pixel {pixel[0]},{pixel[1]}: {len(ray.words)} words"
