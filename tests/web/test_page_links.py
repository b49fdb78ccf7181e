"""Links of the static page: what they carry to another browser, and what it says where they cannot be honoured."""

from __future__ import annotations

import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING

import numpy as np
import pytest
from fakes.browser import RESTS, Browser, chromium
from fakes.static_page import EXAMPLES, REFUSES, frame_of, notice, opened, rests, saved, show, shown, shows_exactly

import voxrt

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="module")
def other_browser(address: str):
    """A browser with another profile."""
    with chromium() as one:
        one.address = address
        yield one


def copied_link(browser: Browser) -> str:
    browser.click("#copy")
    assert browser.until("document.querySelector('#copy').textContent !== 'Copy link'")
    return browser.run("return location.search + location.hash")


def test_a_link_carries_scene_depth_and_camera(browser: Browser) -> None:
    opened(browser, "#scene=planet&depth=5", "planet", 5)
    browser.mouse([browser.middle("#picture"), (400, 300)])
    rests(browser)
    camera = browser.run("return window.voxrt.newest.camera")
    opened(browser, copied_link(browser), "planet", 5)
    rests(browser)
    again = browser.run("return window.voxrt.newest.camera")
    assert np.allclose(again["look"], camera["look"], atol=60)
    assert np.allclose(again["position"], camera["position"], atol=2)


def test_a_link_carries_a_dropped_model_to_another_browser(
    browser: Browser, other_browser: Browser, tmp_path: Path
) -> None:
    """Its words, materials, light and view arrive; the receiver's link and files are those of the sender."""
    opened(browser)
    show(browser, EXAMPLES / "house.obj", EXAMPLES / "house.mtl")
    browser.mouse([browser.middle("#picture"), (400, 300)])
    rests(browser)
    link = copied_link(browser)
    camera, size, colours = frame_of(browser)
    sent = saved(browser, tmp_path / "sent", "#save-mem", "house.mem")
    opened(other_browser, link, "house", 7)
    rests(other_browser)
    again, same_size, same_colours = frame_of(other_browser)
    assert size == same_size
    assert np.allclose(again["position"], camera["position"], atol=2)
    assert (colours != same_colours).any(axis=2).mean() < 0.02  # the camera of a link is rounded
    assert shows_exactly(other_browser, voxrt.build(EXAMPLES / "house.obj", depth=7).rom)
    assert saved(other_browser, tmp_path / "got", "#save-mem", "house.mem") == sent
    assert copied_link(other_browser).split("memory=")[1] == link.split("memory=")[1]
    assert other_browser.faults() == []


def test_a_memory_that_is_too_large_for_a_link_is_not_put_into_one(browser: Browser) -> None:
    opened(browser, "#scene=planet&depth=5", "planet", 5)
    browser.enter("#depth", 9)
    assert browser.until(shown("planet", 9)), notice(browser)
    show(browser, EXAMPLES / "planet.glb", depth=9)
    assert browser.until("document.querySelector('#share-says').textContent.includes('too large for a link')")
    assert copied_link(browser) == ""
    assert "Too large" in browser.run("return document.querySelector('#copy').textContent")


BAD = {
    "scene=castle": 'no example "castle"',
    "depth=7&camera=1,2,3,0,0,35,9": "names no scene",
    "scene=planet&depth=13": 'part "depth=13"',
    "scene=planet&depth=2": 'part "depth=2"',
    "scene=planet&camera=1,2,3": 'part "camera=1,2,3"',
    "scene=planet&bake=1,2,3,4": 'part "bake=',
    "scene=planet&view=top": 'part "view=top"',
    "scene=planet&memory=abc": "several scenes",
    "memory=abc": "damaged or cut off",
    "memory=%F0": "damaged or cut off",
}


def test_a_link_that_cannot_be_honoured_says_so_and_shows_no_scene(browser: Browser) -> None:
    for fragment, reason in BAD.items():
        browser.open("about:blank")
        browser.open(f"{browser.address}#{fragment}")
        assert browser.until(REFUSES), fragment
        assert notice(browser).startswith("This link cannot be shown")
        assert reason in notice(browser)
        assert browser.run("return document.querySelector('#stage').classList.contains('empty')")
    browser.click("[data-example=house]")
    assert browser.until(shown("house", 7)), notice(browser)
    assert browser.run("return location.hash") == ""


def test_a_link_that_is_cut_off_is_refused(browser: Browser) -> None:
    opened(browser)
    show(browser, EXAMPLES / "house.obj", EXAMPLES / "house.mtl", depth=7)
    link = copied_link(browser)
    browser.open("about:blank")
    browser.open(browser.address + link[:-20])
    assert browser.until(REFUSES)
    assert "damaged or cut off" in notice(browser)


def test_another_link_in_the_same_tab_shows_its_scene(browser: Browser) -> None:
    opened(browser)
    browser.run("location.hash = '#scene=house&depth=5'")
    assert browser.until(shown("house", 5)), notice(browser)


class SharingHandler(SimpleHTTPRequestHandler):
    """A server of models; those below /open/ may be read by other pages, and those below /endless/ never come."""

    ended = threading.Event()

    def do_GET(self) -> None:
        if self.path.startswith("/endless/"):
            self.ended.wait()
        else:
            super().do_GET()

    def log_message(self, *_: object) -> None:
        """Print nothing."""

    def translate_path(self, path: str) -> str:
        return super().translate_path(path.replace("/open/", "/").replace("/closed/", "/"))

    def end_headers(self) -> None:
        if self.path.startswith("/open/"):
            self.send_header("Access-Control-Allow-Origin", "*")
        super().end_headers()


@pytest.fixture(scope="module")
def models():
    """The address of a server with the example scenes, of another origin than the page."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(SharingHandler, directory=str(EXAMPLES))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        SharingHandler.ended.set()
        server.shutdown()


def test_a_link_names_models_elsewhere(browser: Browser, models: str) -> None:
    urls = f"?model={models}/open/house.obj&model={models}/open/house.mtl"
    opened(browser, f"{urls}#depth=6", "house", 6)
    assert shows_exactly(browser, voxrt.build(EXAMPLES / "house.obj", depth=6).rom)
    browser.enter("#up", "z", "change")
    turned = voxrt.build(EXAMPLES / "house.obj", depth=6, up="z").rom
    words = f"document.querySelector('#facts').innerText.includes('{len(turned.octree.words):,}')"
    assert browser.until(f"{words} && {RESTS}")
    link = copied_link(browser)
    assert "depth=6&up=z" in link
    opened(browser, link, "house", 6)
    assert shows_exactly(browser, turned)


def test_a_model_that_cannot_be_fetched_is_named(opened_browser: Browser, models: str) -> None:
    """The browser itself puts the answer of the server on the console."""
    for path, reason in (("closed/planet.glb", "CORS"), ("open/none.glb", "404"), ("open/solids.py", "no scene")):
        opened_browser.open("about:blank")
        opened_browser.open(f"{opened_browser.address}?model={models}/{path}")
        assert opened_browser.until(REFUSES)
        assert reason in notice(opened_browser)
        assert path.split("/")[1] in notice(opened_browser)
    opened_browser.faults()


def test_a_server_that_never_answers_keeps_nobody_waiting(browser: Browser, models: str) -> None:
    """Its loading ends by Cancel, and by the choice of something else."""
    loading = "document.querySelector('#notice').innerText.includes('Loading')"
    for choice in ("#cancel", "[data-example=house]"):
        browser.open("about:blank")
        browser.open(f"{browser.address}?model={models}/endless/planet.glb")
        assert browser.until(f"{loading} && document.querySelector('#cancel').checkVisibility()")
        browser.click(choice)
        assert browser.until("document.querySelector('#notice').hidden")
    assert browser.until(shown("house", 7)), notice(browser)
    assert browser.run("return location.search + location.hash") == ""
    assert notice(browser) == ""


PICTURE = "document.querySelector('#picture')"
ELEMENT = "document.querySelector('voxrt-view')"


def test_a_page_of_one_file_shows_the_view_without_a_server(
    browser: Browser, other_browser: Browser, tmp_path: Path
) -> None:
    """Opened from the disk by another browser: the pixels of the page, turned by mouse and keys."""
    opened(browser)
    show(browser, EXAMPLES / "house.obj", EXAMPLES / "house.mtl")
    opened(browser, copied_link(browser), "house", 7)
    rests(browser)
    width, height = browser.run("const { clientWidth, clientHeight } = stage; return [clientWidth, clientHeight]")
    pixels, columns = browser.run(f"return [{PICTURE}.toDataURL(), {PICTURE}.width]")
    saved(browser, tmp_path, "#save-page", "house.html")
    other_browser.open((tmp_path / "house.html").as_uri())
    other_browser.run(f"Object.assign({ELEMENT}.style, {{ width: '{width}px', height: '{height}px' }})")
    canvas = f"{ELEMENT}.shadowRoot.querySelector('canvas')"
    rest = f"{ELEMENT}.getAttribute('aria-busy') === 'false' && {canvas}.width === {columns}"
    assert other_browser.until(rest), other_browser.faults()
    assert other_browser.run(f"return {canvas}.toDataURL()") == pixels
    other_browser.mouse([(400, 300), (460, 300)])
    other_browser.draws()
    assert other_browser.until(rest)
    turned = other_browser.run(f"return {canvas}.toDataURL()")
    assert turned != pixels
    other_browser.key("ArrowLeft")
    other_browser.draws()
    assert other_browser.until(rest)
    assert other_browser.run(f"return {canvas}.toDataURL()") != turned
    assert other_browser.faults() == []


def test_names_of_files_and_materials_stay_text(browser: Browser, other_browser: Browser, tmp_path: Path) -> None:
    """On the page, in a link, and in a page of one file."""
    name, material = "<i>&amp;", "</script><i>-->"
    for file in ("house.obj", "house.mtl"):
        text = (EXAMPLES / file).read_text().replace("tiles", material)
        (tmp_path / file.replace("house.obj", f"{name}.obj")).write_text(text)
    opened(browser)
    show(browser, tmp_path / f"{name}.obj", tmp_path / "house.mtl")
    opened(other_browser, copied_link(browser), name, 7)
    saved(browser, tmp_path / "page", "#save-page", "_i_&amp;.html")
    assert browser.run("return document.querySelector('i')") is None
    assert other_browser.run("return document.querySelector('i')") is None
    other_browser.open((tmp_path / "page" / "_i_&amp;.html").as_uri())
    assert other_browser.until(f"{ELEMENT}.getAttribute('aria-busy') === 'false'"), other_browser.faults()
    assert other_browser.run("return [document.title, document.querySelector('i')]") == [name, None]
    assert other_browser.faults() == []
