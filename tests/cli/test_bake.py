"""``voxrt build --bake`` from the command line and from Python."""

import json
import subprocess
import sys

import numpy as np
import pytest

import voxrt
from voxrt.export import read_manifest
from voxrt.octree.camera import Lighting

HOUSE = "examples/house.obj"


def test_a_baked_memory_says_so_and_is_shown_flat(tmp_path):
    built = voxrt.build(HOUSE, tmp_path, depth=5, bake=True, sky="#ffffff", preview=True, samples=1, background="dark")
    manifest = read_manifest(built.outputs["manifest"])
    assert manifest.baked.sky == (1, 1, 1)
    assert manifest.baked.samples == 64
    assert manifest.baked.words == len(built.octree.words) > manifest.baked.words_before
    assert manifest.baked.words_before == len(voxrt.build(HOUSE, depth=5).octree.words)
    assert manifest.lighting == Lighting(flat=True)
    picture = built.preview.frame
    colours = np.array([one.colour for one in built.rom.materials], np.uint8)
    assert (picture.colour == colours[picture.material]).all()
    assert json.loads(built.outputs["manifest"].read_text())["baked"]["sun"] == [1, 3, 2]


def test_a_budget_is_weighed_against_colours(tmp_path):
    whole = voxrt.build(HOUSE, depth=5, bake=True)
    fitted = voxrt.build(HOUSE, tmp_path, depth=5, bake=True, budget=1500, size=(160, 120))
    assert len(fitted.octree.words) <= 1500 < len(whole.octree.words)
    assert fitted.bake.colours in (254, 64, 16)
    assert fitted.bake.words == len(whole.octree.words)
    assert fitted.solid_voxels >= whole.solid_voxels


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"sky": "blue"}, "sky must be a colour like '#9db4d0', not 'blue'"),
        ({"sky": -1}, "sky must be a strength of 0 … 16"),
        ({"sun": (1, 2)}, "sun must have shape"),
        ({"bake_samples": 0}, "bake_samples must be an integer 1 … 4096, not 0"),
    ],
)
def test_wrong_light_is_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        voxrt.BuildOptions(bake=True, **wrong)


def test_conversion_keeps_what_was_baked(tmp_path):
    built = voxrt.build(HOUSE, tmp_path, depth=4, bake=True)
    blob, _ = voxrt.read_any(built.outputs["mem"])
    voxrt.convert(blob, tmp_path / "house.blob")
    there, _ = voxrt.read_any(tmp_path / "house.blob")
    voxrt.convert(there, tmp_path / "other" / "house.coe")
    assert read_manifest(tmp_path / "other" / "house.json").baked == built.baked


def test_octants_of_baked_light_keep_their_colours(tmp_path):
    built = voxrt.build(HOUSE, tmp_path, depth=4, bake=True)
    finished = subprocess.run(
        [sys.executable, "-m", "voxrt", "view", built.outputs["mem"], "-o", tmp_path / "o.html"],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert "wrote" in finished.stderr
    assert "255.0, 255.0, 255.0, 255.0, 255.0, 255.0" in (tmp_path / "o.html").read_text()
