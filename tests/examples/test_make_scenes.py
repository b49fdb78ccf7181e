"""The committed scenes are what the script makes, and they build to what their pictures promise."""

from __future__ import annotations

import filecmp
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import voxrt
from voxrt.octree import census

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SCENES = ("courtyard.glb", "house.obj", "house.mtl", "dog.usda", "planet.glb", "toadstool.vox")


def test_the_script_makes_the_committed_scenes(tmp_path):
    subprocess.run([sys.executable, EXAMPLES / "make_scenes.py", tmp_path], check=True)
    same, different, unreadable = filecmp.cmpfiles(tmp_path, EXAMPLES, SCENES, shallow=False)
    assert (sorted(same), different, unreadable) == (sorted(SCENES), [], [])
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(SCENES)


@pytest.mark.parametrize(
    ("scene", "materials"), [("courtyard.glb", 15), ("house.obj", 5), ("dog.usda", 5), ("planet.glb", 6)]
)
def test_every_material_is_seen_by_the_default_camera(scene, materials):
    result = voxrt.build(EXAMPLES / scene, depth=7)
    assert not result.warnings
    assert len(result.rom.materials) == 1 + materials
    assert set(census(result.rom.octree).voxels) == set(range(1 + materials))
    frame = voxrt.render(result.rom, size=(320, 240), engine="model")
    assert set(np.unique(frame.material)) == set(range(1 + materials))


def test_the_courtyard_stands_on_voxel_edges():
    result = voxrt.build(EXAMPLES / "courtyard.glb", depth=7)
    assert result.rom.grid is not None
    assert result.rom.grid.voxel_size == 0.125
    names = [material.name for material in result.rom.materials]
    voxels = census(result.rom.octree).voxels
    assert voxels[names.index("sun")] == 12 * 2**3  # flowers, boxes of a quarter of a metre
    assert voxels[names.index("water")] == pytest.approx(np.pi * (1.875 * 8) ** 2 * 2, rel=0.1)


def test_the_dog_is_of_powers_of_two():
    result = voxrt.build(EXAMPLES / "dog.usda", depth=7)
    assert {report.source for report in result.objects} == {"box"}
    assert any(any(report.grown) for report in result.objects)
    exact = voxrt.build(EXAMPLES / "dog.usda", depth=7, pow2="none")
    assert result.solid_voxels > exact.solid_voxels
    assert len(result.rom.octree.words) < len(exact.rom.octree.words) / 3
