"""What notebooks show."""

from __future__ import annotations

import base64
import io
import re
import sys
from pathlib import Path

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
    assert pixels(built._repr_png_()).ndim == 3
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
