"""What notebooks show."""

from __future__ import annotations

import base64
import io
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from voxrt import octree
from voxrt.sim import Frame, RenderCost
from voxrt.view import cards  # noqa: F401 - it registers the cards
from voxrt.voxelize import EMPTY, Material

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
RED, BLUE = (220, 40, 40), (40, 60, 220)


@pytest.fixture(params=["with PyVista", "without"])
def _maybe_pyvista(request, monkeypatch):
    if request.param == "without":
        monkeypatch.setitem(sys.modules, "pyvista", None)


def pixels(png):
    with Image.open(io.BytesIO(png)) as picture:
        return np.asarray(picture.convert("RGB")).astype(int)


@pytest.mark.usefixtures("_maybe_pyvista")
def test_memories_and_octrees():
    cube = np.zeros((16, 16, 16), np.uint8)
    cube[:8], cube[8:, :8] = 1, 2
    rom = octree.Rom("<two>", octree.from_dense(cube), (EMPTY, Material("red", RED), Material("blue", BLUE)))
    seen = pixels(rom._repr_png_())
    red, blue = (
        ((seen * colour).sum(axis=2) / np.linalg.norm(seen + 1, axis=2) / np.linalg.norm(colour))
        for colour in (RED, BLUE)
    )
    assert (red > 0.99).sum() > 1000
    assert (blue > 0.99).sum() > 1000
    assert np.argwhere(red > 0.99)[:, 1].mean() < np.argwhere(blue > 0.99)[:, 1].mean()
    assert np.argwhere(red > 0.99)[:, 0].mean() < np.argwhere(blue > 0.99)[:, 0].mean()
    for value in (rom, rom.octree):
        html = value._repr_html_()
        assert "16 voxels per side" in html
        assert f"{np.count_nonzero(cube):,} voxels" in html
        embedded = base64.b64decode(re.search(r"base64,([^\"]+)", html).group(1))
        assert pixels(embedded).shape == pixels(value._repr_png_()).shape
    assert "&lt;two&gt;" in rom._repr_html_()


@pytest.mark.usefixtures("_maybe_pyvista")
def test_the_deepest_world_is_drawn_in_its_coarse_octants():
    tree = octree.from_points(np.array([[0, 0, 0], [65535, 65535, 65535]]), np.ones(2, int), 16)
    assert pixels(tree._repr_png_()).ndim == 3


def test_builds_scenes_and_rays():
    import voxrt
    import voxrt.building.cards
    from voxrt.sim import follow_ray

    built = voxrt.build(EXAMPLES / "house.obj", depth=4)
    html = built._repr_html_()
    assert len(repr(built)) < 200
    for text in ("house", "16 voxels per side", f"{built.solid_voxels:,} voxels", "timber, glass, brick"):
        assert text in html
    assert pixels(built._repr_png_()).shape == (480, 640, 3)
    html = built.scene._repr_html_()
    triangles = sum(len(item.mesh.triangles) for item in built.scene.objects)
    assert f"<td>{triangles:,}</td>" in html
    assert pixels(base64.b64decode(re.search(r"base64,([^\"]+)", html).group(1))).ndim == 3
    path = follow_ray(built.octree, (-16, 130, 130), (1, 0, 0))
    html = path._repr_html_()
    assert html.count("<tr>") == 4 + 1 + len(path.readings)
    assert f"0x{path.readings[0].address:X}" in html


def test_frames():
    colour = np.random.default_rng(1).integers(0, 256, (6, 8, 3), dtype=np.uint8)
    frame = Frame(colour, np.ones((6, 8), np.uint8), np.zeros((6, 8), np.uint8), RenderCost(48, 480, 960, 0.5))
    np.testing.assert_array_equal(pixels(frame._repr_png_()), colour)
    html = frame._repr_html_()
    assert "8x6 pixels" in html
    assert "10.00 per ray" in html
    assert "20.00 per pixel" in html
    assert repr(frame) == "<Frame: 8x6 pixels, 1 material, 20.00 cycles per ray>"


def test_a_frame_is_saved_and_shown(tmp_path, monkeypatch):
    import voxrt
    from voxrt.octree.camera import Camera

    colour = np.random.default_rng(1).integers(0, 256, (6, 8, 4), dtype=np.uint8)
    frame = Frame(colour, np.ones((6, 8), np.uint8), np.zeros((6, 8), np.uint8), RenderCost(48, None, None, 0.5))
    picture = voxrt.Picture(frame, Camera((0, 0, 0), (1, 0, 0), (0, 0, 1), (0, 1, 0)), "model")
    assert repr(picture) == "<Picture: 8x6 pixels, 1 material, by model>"
    for number, save in enumerate(
        (
            frame.save,
            picture.save,
            lambda file: voxrt.save_picture(frame, file),
            lambda file: voxrt.save_picture(picture, file),
            lambda file: voxrt.save_picture(colour, file),
        )
    ):
        file = tmp_path / "new" / f"{number}.png"
        save(file)
        assert file.read_bytes() == frame._repr_png_()
    with Image.open(file) as opened:
        np.testing.assert_array_equal(np.asarray(opened), colour)
    with pytest.raises(voxrt.OutputError, match="is a folder; name a file"):
        frame.save(tmp_path)
    shown = []
    monkeypatch.setattr("PIL.ImageShow.show", lambda image: shown.append(np.asarray(image)) or True)
    picture.show()
    np.testing.assert_array_equal(shown, [colour])
    monkeypatch.setattr("PIL.ImageShow.show", lambda _: False)
    with pytest.raises(voxrt.SimulatorError, match="no program here shows pictures"):
        frame.show()


def test_a_notebook_shows_a_frame_in_its_cell(monkeypatch):
    shown = []
    display = SimpleNamespace(display=shown.append, Image=lambda data: data)
    notebook = SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=None), display=display)
    monkeypatch.setitem(sys.modules, "IPython", notebook)
    frame = Frame(np.zeros((2, 2, 3), np.uint8), *np.zeros((2, 2, 2), np.uint8), RenderCost(4, None, None, 0.5))
    frame.show()
    assert shown == [frame._repr_png_()]


def test_a_build_is_saved_as_its_suffix_says(tmp_path):
    import voxrt

    built = voxrt.build(EXAMPLES / "house.obj", tmp_path, depth=4, preview=True)
    built.save(tmp_path / "again.png")
    assert (tmp_path / "again.png").read_bytes() == built.outputs["preview"].read_bytes()
    unseen = voxrt.build(EXAMPLES / "house.obj", depth=4)
    assert unseen._repr_png_() == built._repr_png_()
    unseen.save(tmp_path / "again.mem")
    assert (tmp_path / "again.mem").read_bytes() == built.outputs["mem"].read_bytes()
    with pytest.raises(voxrt.RomError, match=r"a.jpeg: is not a format to write"):
        built.save(tmp_path / "a.jpeg")
