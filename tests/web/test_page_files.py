"""Files that are dropped on the static page: shown as natively, or refused in a line."""

from __future__ import annotations

import hashlib
import struct
from typing import TYPE_CHECKING

import numpy as np
import pytest
from assets import asset
from fakes.static_page import (
    EXAMPLES,
    REFUSES,
    drop,
    frame_of,
    notice,
    on_paper,
    opened,
    registers,
    show,
    shows_exactly,
)
from PIL import Image

import voxrt
from voxrt.export.vox import read_vox, write_vox
from voxrt.sim import render

if TYPE_CHECKING:
    from pathlib import Path

    from fakes.browser import Browser


@pytest.mark.parametrize("files", [["house.obj", "house.mtl"], ["planet.glb"]], ids=lambda files: files[0])
def test_dropped_files_are_shown_exactly(browser: Browser, files: list[str]) -> None:
    opened(browser)
    show(browser, *(EXAMPLES / name for name in files))
    rom = voxrt.build(EXAMPLES / files[0], depth=7).rom
    assert shows_exactly(browser, rom)


def textured_square(folder: Path, image: str, pixels: np.ndarray) -> list[Path]:
    """A square with a texture, as OBJ."""
    Image.fromarray(pixels).save(folder / image)
    (folder / "square.mtl").write_text(f"newmtl look\nmap_Kd {image}\n")
    corners = ["v 0 0 0", "v 4 0 0", "v 4 3 1", "v 0 3 1", "vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    faces = ["usemtl look", "f 1/1 2/2 3/3", "f 1/1 3/3 4/4"]
    (folder / "square.obj").write_text("\n".join(["mtllib square.mtl", *corners, *faces]) + "\n")
    return [folder / name for name in ("square.obj", "square.mtl", image)]


@pytest.mark.parametrize(("image", "most"), [("map.png", 0), ("map.jpg", 3)])
def test_textures_are_shown_as_natively(browser: Browser, tmp_path: Path, image: str, most: int) -> None:
    """PNG exactly; JPEG, which the browser decodes, within rounding."""
    pixels = np.random.default_rng(4).integers(0, 256, (6, 5, 3), np.uint8).repeat(16, axis=0).repeat(16, axis=1)
    files = textured_square(tmp_path, image, pixels)
    opened(browser)
    show(browser, *files)
    camera, size, colours = frame_of(browser)
    rom = voxrt.build(files[0], depth=7).rom
    native = render(on_paper(rom), registers(camera), tuple(size), engine="model").colour
    assert len(np.unique(native.reshape(-1, 3), axis=0)) > 15
    assert np.abs(colours.astype(int) - native).mean() <= most


def test_a_magicavoxel_scene_is_shown_exactly(browser: Browser, tmp_path: Path) -> None:
    write_vox(tmp_path / "yard.vox", voxrt.build(EXAMPLES / "courtyard.glb", depth=6).rom)
    rom, _ = read_vox(tmp_path / "yard.vox")
    opened(browser)
    show(browser, tmp_path / "yard.vox", depth=rom.octree.depth)
    assert shows_exactly(browser, rom)


def test_draco_is_decoded_as_natively(browser: Browser) -> None:
    pytest.importorskip("DracoPy")
    for name in ("draco/Box/glTF_Binary/Box_Draco.glb", "glTF-Transform/functions/test/in/DenseSphere.glb"):
        path = asset(f"gltf/{name}")
        opened(browser)
        show(browser, path)
        rom = voxrt.build(path, depth=7).rom
        assert shows_exactly(browser, rom)
        assert f"{len(rom.octree.words):,}" in browser.run("return document.querySelector('#facts').innerText")


def test_malformed_assets_never_end_the_page(browser: Browser) -> None:
    """Each is refused or shown; the page stays."""
    opened(browser)
    kinds = {".glb", ".gltf", ".obj", ".stl", ".ply", ".usdz", ".usda", ".usdc", ".vox", ".mem"}
    files = [path for path in sorted(asset("malformed").rglob("*")) if path.suffix.lower() in kinds]
    for path in files[:: max(1, len(files) // 40)]:
        browser.run("document.querySelector('#close').click(); document.querySelector('#stage').dataset.scene = ''")
        drop(browser, path)
        assert browser.until(
            f"({REFUSES}) || document.querySelector('#stage').dataset.scene.startsWith({path.stem!r})"
        ), path
    browser.click("#close")
    show(browser, EXAMPLES / "planet.glb")


def stl_of_a_tetrahedron() -> bytes:
    corners = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    records = [struct.pack("<12fH", 0, 0, 0, *(v for i in face for v in corners[i]), 0) for face in faces]
    return bytes(80) + struct.pack("<I", len(records)) + b"".join(records)


PLY = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
PLY += "property list uchar int vertex_indices\nend_header\n"
PLY += "0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"


@pytest.mark.parametrize("kind", ["stl", "ply", "mem"])
def test_the_other_formats_drop_too(browser: Browser, tmp_path: Path, kind: str) -> None:
    opened(browser)
    files = [tmp_path / f"tetra.{kind}"]
    if kind == "mem":
        (tmp_path / "tetra.stl").write_bytes(stl_of_a_tetrahedron())
        built = voxrt.build(tmp_path / "tetra.stl", tmp_path, depth=7)
        files = list(built.outputs.values())
    else:
        files[0].write_bytes(stl_of_a_tetrahedron() if kind == "stl" else PLY.encode())
        built = voxrt.build(files[0], depth=7)
    show(browser, *files)
    assert shows_exactly(browser, built.rom)


USDA = """#usda 1.0
(
    defaultPrim = "flag"
    upAxis = "Y"
)
def Mesh "flag" (prepend apiSchemas = ["MaterialBindingAPI"])
{
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(0, 0, 0), (4, 0, 0), (4, 3, 1), (0, 3, 1)]
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
    rel material:binding = </flag/look>
    def Material "look"
    {
        token outputs:surface.connect = </flag/look/surface.outputs:surface>
        def Shader "surface"
        {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </flag/look/picture.outputs:rgb>
            token outputs:surface
        }
        def Shader "picture"
        {
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @flag.png@
            float2 inputs:st.connect = </flag/look/reader.outputs:result>
            float3 outputs:rgb
        }
        def Shader "reader"
        {
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }
    }
}
"""


def test_a_package_of_usd_has_its_textures(browser: Browser, tmp_path: Path) -> None:
    utils = pytest.importorskip("pxr.UsdUtils")
    squares = np.array([[[200, 30, 40], [250, 250, 240]], [[20, 60, 160], [240, 200, 30]]], np.uint8)
    Image.fromarray(squares.repeat(8, 0).repeat(8, 1)).save(tmp_path / "flag.png")
    (tmp_path / "flag.usda").write_text(USDA)
    assert utils.CreateNewUsdzPackage(str(tmp_path / "flag.usda"), str(tmp_path / "flag.usdz"))
    opened(browser)
    show(browser, tmp_path / "flag.usdz")
    rom = voxrt.build(tmp_path / "flag.usdz", depth=7).rom
    assert len(rom.materials) > 4
    assert shows_exactly(browser, rom)


def test_bad_files_are_refused_and_the_page_lives_on(browser: Browser, tmp_path: Path) -> None:
    opened(browser)
    bad = {
        "cut.glb": (EXAMPLES / "courtyard.glb").read_bytes()[:2000],
        "noise.glb": hashlib.sha512(b"noise").digest() * 50,
        "text.gltf": b'{"asset": {"version": "2.0"}}',
        "lone.gltf": b'{"asset": {"version": "2.0"}, "buffers": [{"uri": "lone.bin", "byteLength": 4}]}',
        "cut.mem": b"00000001\nFFFFFF01\n",
        "cycle.mem": b"00000001\n" + b"00000001\n" * 8,
        "empty.obj": b"",
        "notes.txt": b"hello",
        "cut.stl": stl_of_a_tetrahedron()[:120],
    }
    for name, content in bad.items():
        (tmp_path / name).write_bytes(content)
        browser.click("#close")
        drop(browser, tmp_path / name)
        assert browser.until(REFUSES), name
        assert name in notice(browser), notice(browser)
    show(browser, EXAMPLES / "planet.glb")
