"""The camera and the light of a scene file, in pictures, manifests, blobs and on boards."""

import numpy as np
import pytest

import voxrt
from voxrt import export
from voxrt.boards.board_scenes import load_scene
from voxrt.sim import Lighting
from voxrt.sim import render as render_frame

YARD = """
[materials]
grass = { colour = [90, 160, 60] }
stone = { colour = [150, 150, 160] }
[camera]
eye = [6, 5, 7]
target = [0, 0.5, 0]
[light]
position = [4, 6, 1]
[[objects]]
box = { size = [8, 0.5, 8], centre = [0, -0.25, 0] }
material = "grass"
[[objects]]
box = { size = [1, 3, 1], corner = [-0.5, 0, -0.5] }
material = "stone"
"""
SIZE = (64, 48)


@pytest.fixture
def yard(tmp_path):
    path = tmp_path / "yard.toml"
    path.write_text(YARD)
    return path


AS_IT_IS = {"samples": 1}  # a preview like the picture of the memory, whose background the author chose


def test_the_preview_has_the_light(yard, tmp_path):
    lit = voxrt.build(yard, tmp_path, depth=5, preview=True, size=SIZE, **AS_IT_IS)
    assert lit.warnings == ()
    origin, voxel = np.array(lit.rom.grid.origin), lit.rom.grid.voxel_size
    place = tuple(int(x) for x in np.rint((np.array([4, 6, 1]) - origin) / voxel * 16))
    assert lit.lighting == Lighting(place, 90, on=True)
    expected = render_frame(lit.rom, lit.preview.camera, SIZE, engine="model", lighting=Lighting(place, on=True))
    assert np.array_equal(lit.preview.frame.colour, expected.colour)
    yard.write_text(YARD.replace("[light]\nposition = [4, 6, 1]\n", ""))
    plain = voxrt.build(yard, tmp_path, depth=5, preview=True, size=SIZE, **AS_IT_IS, engine="model")
    assert plain.lighting is None
    assert (plain.preview.frame.colour != expected.colour).any()


def test_the_preview_has_the_mirrors(yard, tmp_path):
    yard.write_text(
        YARD.replace("[150, 150, 160]", "[150, 150, 160], mirror = true").replace("[light]\nposition = [4, 6, 1]\n", "")
    )
    built = voxrt.build(yard, tmp_path, depth=5, preview=True, size=SIZE, **AS_IT_IS)
    assert built.lighting == Lighting(bounces=4)
    expected = render_frame(built.rom, built.preview.camera, SIZE, engine="model", lighting=Lighting(bounces=4))
    assert np.array_equal(built.preview.frame.colour, expected.colour)
    plain = render_frame(built.rom, built.preview.camera, SIZE, engine="model")
    assert (plain.colour != expected.colour).any()
    assert load_scene(tmp_path / "yard.mem").lighting.features == {"mirrors"}


def test_camera_and_light_stand_in_manifest_blob_and_board(yard, tmp_path):
    built = voxrt.build(yard, tmp_path, depth=5)
    read, _ = voxrt.read_any(tmp_path / "yard.mem")
    assert (read.view, read.lighting) == (built.view, built.lighting)
    assert read.view is not None
    voxrt.convert(read, tmp_path / "yard.blob")
    assert export.read_blob(tmp_path / "yard.blob").lighting == built.lighting
    for path in (yard, tmp_path / "yard.mem", tmp_path / "yard.blob"):
        scene = load_scene(path, depth=5 if path == yard else None)
        assert scene.camera.position == built.view.position
        assert scene.lighting.position == built.lighting.position
        assert scene.lighting.features == {"light"}


def test_what_cannot_be_seen_is_counted(yard, tmp_path):
    yard.write_text(YARD.replace("[6, 5, 7]", "[1e9, 5, 7]").replace("[4, 6, 1]", "[1e9, 0, 0]"))
    built = voxrt.build(yard, tmp_path, depth=5)
    assert [one.kind for one in built.warnings] == ["camera", "light"]
    assert (built.view, built.lighting) == (None, None)
