"""Choices of the static page: up axis, unit, fill, what warnings offer; long builds; saved pictures and films."""

from __future__ import annotations

import base64
import io
import struct
from typing import TYPE_CHECKING

import numpy as np
import pytest
from assets import asset
from fakes.browser import RESTS
from fakes.static_page import (
    EXAMPLES,
    REFUSES,
    drop,
    file_saved,
    frame_of,
    notice,
    on_paper,
    opened,
    registers,
    rests,
    save_to,
    saved,
    show,
    shown,
    shows_exactly,
)
from PIL import Image

import voxrt
from voxrt.sim import render

if TYPE_CHECKING:
    from pathlib import Path

    from fakes.browser import Browser

FACTS = "document.querySelector('#facts').innerText"


def wedge(path: Path) -> Path:
    """A closed wedge, different along each axis, as STL."""
    corners = [(0, 0, 0), (6, 0, 0), (0, 3, 0), (0, 0, 2)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    records = [struct.pack("<12fH", 0, 0, 0, *(v for i in face for v in corners[i]), 0) for face in faces]
    path.write_bytes(bytes(80) + struct.pack("<I", len(records)) + b"".join(records))
    return path


@pytest.mark.parametrize("kind", ["stl", "obj"])
def test_the_up_axis_and_the_unit_are_those_of_the_command(browser: Browser, tmp_path: Path, kind: str) -> None:
    path = wedge(tmp_path / "wedge.stl")
    if kind == "obj":
        path = EXAMPLES / "house.obj"
    default, other = ("z", "y") if kind == "stl" else ("y", "z")
    opened(browser)
    show(browser, path)
    assert browser.run("return document.querySelector('#up').value") == default
    browser.enter("#up", other, "change")
    rests(browser)
    browser.enter("#unit", "0.001", "change")
    turned = voxrt.build(path, depth=7, up=other, unit=0.001)
    assert browser.until(f"{FACTS}.includes('{len(turned.octree.words):,}') && {RESTS}")
    page = saved(browser, tmp_path / "page", "#save-mem", f"{path.stem}.mem")
    assert page == voxrt.build(path, tmp_path / "native", depth=7, up=other, unit=0.001).outputs["mem"].read_bytes()
    browser.click("[data-example=planet]")
    assert browser.until(shown("planet", 7))
    assert browser.run("return document.querySelector('#up').disabled")


def test_fill_and_rule_are_those_of_the_command_and_go_into_links(browser: Browser) -> None:
    opened(browser)
    browser.enter("#fill", "surface", "change")
    rests(browser)
    browser.enter("#rule", "centre", "change")
    built = voxrt.build(EXAMPLES / "courtyard.glb", depth=7, fill="surface", rule="centre")
    words = f"{FACTS}.includes('{len(built.octree.words):,}') && {RESTS}"
    assert browser.until(words)
    browser.click("#copy")
    opened(browser, browser.run("return location.hash"))
    assert browser.until(words)
    browser.enter("#fill", "auto", "change")
    for rule in ("centre", "half"):
        browser.enter("#rule", rule, "change")
        solid = voxrt.build(EXAMPLES / "courtyard.glb", depth=7, rule=rule)
        assert browser.until(f"{FACTS}.includes('{len(solid.octree.words):,}') && {RESTS}")


def test_a_warning_offers_what_mends_it(browser: Browser) -> None:
    """Thin sheets that were filled stay sheets after a click."""
    path = asset("stl/USD-Fileformat-plugins/suzanne.stl")
    opened(browser)
    show(browser, path)
    text = browser.run("return document.querySelector('#warnings').innerText")
    assert "Open parts were filled: suzanne." in text
    box = browser.run("return document.querySelector('#warnings').getBoundingClientRect().bottom")
    assert box < 800
    browser.click("#warnings button")
    words = len(voxrt.build(path, depth=7, fill="surface").octree.words)
    assert browser.until(f"{FACTS}.includes('{words:,}') && {RESTS}")
    assert browser.run("return document.querySelector('#fill').value") == "surface"
    assert "filled" not in browser.run("return document.querySelector('#warnings').innerText")


def test_a_model_that_lies_on_its_back_is_stood_up_by_a_click(browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "cone.obj"
    corners = ["v 0 0 0", "v 2 0 0", "v 2 2 0", "v 0 2 0", "v 1 1 5"]
    path.write_text("\n".join([*corners, "f 4 3 2 1", "f 1 2 5", "f 2 3 5", "f 3 4 5", "f 4 1 5"]) + "\n")
    opened(browser)
    show(browser, path)
    assert "up-axis" in {warning.kind for warning in voxrt.build(path, depth=7).warnings}
    assert "lie on its back" in browser.run("return document.querySelector('#warnings').innerText")
    browser.click("#warnings button")
    upright = voxrt.build(path, depth=7, up="z").rom
    assert browser.until(f"{FACTS}.includes('{len(upright.octree.words):,}') && {RESTS}")
    rests(browser)
    assert shows_exactly(browser, upright)
    assert "lie on its back" not in browser.run("return document.querySelector('#warnings').innerText")


def test_a_small_part_is_shown_by_a_click(browser: Browser) -> None:
    path = asset("trouble/trimesh/two_objects.obj")
    opened(browser)
    show(browser, path)
    assert "Too small to show at 128³: tetra." in browser.run("return document.querySelector('#warnings').innerText")
    browser.click("#warnings button")
    assert browser.until(shown("two_objects", 8)), notice(browser)


def test_files_that_are_missing_are_named(browser: Browser) -> None:
    opened(browser)
    show(browser, EXAMPLES / "house.obj")
    text = browser.run("return document.querySelector('#warnings').innerText")
    assert "house.mtl is missing: drop it together with the model." in text


def test_a_budget_that_ruins_the_surface_says_so(browser: Browser) -> None:
    opened(browser)
    browser.enter("#budget-words", 600, "change")
    warned = "document.querySelector('#warnings').innerText"
    assert browser.until(f"{warned}.includes('of the surface') && {RESTS}"), notice(browser)
    depth, words = voxrt.build(EXAMPLES / "courtyard.glb", depth=7, budget=600).budget.lossless
    assert f"{2**depth}\u00b3 fits without loss" in browser.run(f"return {warned}")
    browser.click("#warnings button")
    assert browser.until(shown("courtyard", depth)), notice(browser)
    assert f"{words:,}" in browser.run(f"return {FACTS}")


def test_a_long_build_has_a_bar_and_can_be_cancelled(browser: Browser) -> None:
    """The bar moves by an estimate of a coarser build; the scene before it stays."""
    opened(browser, "#scene=planet&depth=6", "planet", 6)
    browser.click("#bake")
    assert browser.until(f"{RESTS} && {FACTS}.includes('words')")
    browser.enter("#depth", 12)
    bar = "document.querySelector('#notice progress')"
    assert browser.until(f"!document.querySelector('#notice').hidden && !{bar}.hidden && {bar}.value > 0", 60)
    assert "about" in notice(browser)
    assert browser.run(f"return {bar}.value") < 1
    browser.click("#cancel")
    assert notice(browser) == ""
    assert browser.run("return document.querySelector('#stage').dataset.scene") == "planet 6"
    browser.enter("#depth", 5)
    assert browser.until(shown("planet", 5), 60), notice(browser)


def test_files_that_loaders_cannot_read_are_refused_in_our_words(browser: Browser, tmp_path: Path) -> None:
    (tmp_path / "empty.ply").touch()
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nend_header\n"
    (tmp_path / "cut.ply").write_text(header)
    opened(browser)
    for name, reason in (("empty.ply", "is empty; export it again"), ("cut.ply", "is damaged or cut off")):
        browser.click("#close")
        drop(browser, tmp_path / name)
        assert browser.until(REFUSES)
        assert f"{name}: {reason}" in notice(browser)


def test_a_picture_is_saved_at_twice_the_size(browser: Browser, tmp_path: Path) -> None:
    """Four rays per pixel: edges are mixed, and elsewhere a pixel is that of the model."""
    opened(browser)
    picture = Image.open(io.BytesIO(saved(browser, tmp_path, "#save", "courtyard.png"))).convert("RGB")
    width, height = browser.run("const { clientWidth, clientHeight } = stage; return [clientWidth, clientHeight]")
    assert picture.size == (2 * width, 2 * height)
    camera, size, _ = frame_of(browser)
    assert tuple(size) == picture.size  # at rest the page renders as many rays
    rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom
    native = render(on_paper(rom), registers(camera), tuple(size), engine="model").colour
    found = np.asarray(picture)
    same = (found == native).all(axis=2)
    assert same.mean() > 0.7
    assert len(np.unique(found.reshape(-1, 3), axis=0)) > len(np.unique(native.reshape(-1, 3), axis=0))


def test_a_turntable_is_a_film_of_one_turn(browser: Browser, tmp_path: Path) -> None:
    """The browser itself plays it: its frames are pictures from several sides."""
    opened(browser, "#scene=house&depth=5", "house", 5)
    save_to(browser, tmp_path)
    browser.click("#turntable")
    assert browser.until("!document.querySelector('#notice progress').hidden")
    assert browser.until("document.querySelector('#notice').hidden", 60), notice(browser)
    film = file_saved(browser, tmp_path, "house.webm")
    assert film.startswith(b"\x1a\x45\xdf\xa3")
    browser.open("about:blank")  # the page's policy plays no films
    script = """
        const [bytes, done] = arguments;
        const film = document.createElement("video");
        Object.assign(film, { muted: true, playbackRate: 4 });
        film.src = URL.createObjectURL(new Blob([Uint8Array.from(atob(bytes), (one) => one.charCodeAt(0))]));
        const pictures = [];
        const context = new OffscreenCanvas(32, 24).getContext("2d");
        film.onended = () => done([film.videoWidth, film.currentTime, pictures]);
        film.onerror = () => done([0, 0, [film.error.message]]);
        film.ontimeupdate = () => {
            context.drawImage(film, 0, 0, 32, 24);
            pictures.push(context.getImageData(0, 0, 32, 24).data.join());
        };
        film.play();
    """
    width, seconds, pictures = browser.run_async(script, base64.b64encode(film).decode())
    assert width >= 320, pictures
    assert seconds > 4
    assert len(set(pictures)) > 3
