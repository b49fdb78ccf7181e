"""The static page in headless Chromium: its first picture, its controls, links, screens of every size."""

from __future__ import annotations

import gzip
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from fakes.site import site
from fakes.static_page import EXAMPLES, notice, opened, rests, shown, shows_exactly

import voxrt

if TYPE_CHECKING:
    from fakes.browser import Browser

ROOT = Path(__file__).resolve().parents[2]


def test_the_example_is_shown_exactly_as_natively(browser: Browser) -> None:
    opened(browser)
    rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom
    assert shows_exactly(browser, rom)
    text = browser.run("return document.querySelector('#memory').innerText")
    assert f"{len(rom.octree.words):,}" in text
    assert "pynq-z1" in text
    assert "fits" in text


def test_the_depth_slider_builds_anew_and_keeps_the_view(browser: Browser) -> None:
    opened(browser)
    before = browser.run("return window.voxrt.newest.camera")
    browser.enter("#depth", 8)
    assert browser.until(shown("courtyard", 8)), notice(browser)
    after = browser.run("return window.voxrt.newest.camera")
    assert np.allclose(np.array(after["position"]), 2 * np.array(before["position"]), atol=2)
    words = len(voxrt.build(EXAMPLES / "courtyard.glb", depth=8).octree.words)
    assert f"{words:,}" in browser.run("return document.querySelector('#facts').innerText")


def test_a_drag_orbits_and_a_finger_too(browser: Browser) -> None:
    opened(browser)
    x, y = browser.middle("#picture")
    first = browser.run("return window.voxrt.newest.camera")
    browser.mouse([(x, y), (x + 60, y), (x + 120, y)])
    rests(browser)
    second = browser.run("return window.voxrt.newest.camera")
    assert second["look"] != first["look"]
    browser.touch([(x, y), (x - 50, y + 10), (x - 100, y + 20)])
    rests(browser)
    assert browser.run("return window.voxrt.newest.camera.look") != second["look"]


def test_nothing_is_asked_of_other_servers(browser: Browser) -> None:
    opened(browser)
    names = browser.run("return performance.getEntriesByType('resource').map(one => one.name)")
    assert names
    assert all(name.startswith((browser.address, "blob:")) for name in names)


def test_little_is_transferred_before_the_first_picture(browser: Browser, paths: list[str]) -> None:
    """Below 600 kB where the server compresses, as most do."""
    opened(browser)
    # The service worker fetches what it keeps, once; the page does not wait for it.
    browser.run_async("const [done] = arguments; navigator.serviceWorker.ready.then(() => done(null))")
    browser.cdp("Network.clearBrowserCache")
    paths.clear()
    opened(browser)
    below = browser.run("return location.pathname")
    files = {site() / path.split("?")[0].removeprefix(below) for path in paths}
    # Whether the service worker is a new one is asked at any time after.
    files.discard(site() / "offline.js")
    assert any(path.name == "voxrt.wasm" for path in files)
    assert sum(len(gzip.compress(path.read_bytes())) for path in files if path.is_file()) < 600_000


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844), (844, 390)])
def test_the_page_fits_every_screen(browser: Browser, width: int, height: int) -> None:
    browser.screen(width, height, touch=width < 1000)
    try:
        opened(browser)
        assert browser.run("return document.documentElement.scrollWidth") <= width
        box = browser.run(
            "const b = document.querySelector('#stage').getBoundingClientRect(); return [b.width, b.height]"
        )
        assert min(box) > 150
        cut = "return [...document.querySelectorAll('.chips button')].filter(one => one.scrollWidth > one.clientWidth)"
        assert browser.run(f"{cut}.map(one => one.textContent)") == []
    finally:
        browser.screen(1280, 800)


def test_shadings_are_explained(browser: Browser) -> None:
    opened(browser)
    browser.click("[data-shading=report]")
    says = "document.querySelector('#shading-says')"
    assert browser.until(f"{says}.textContent.includes('turn away are darker')")
    assert browser.run(f"return {says}.checkVisibility()")


def test_every_control_has_a_name_and_keys_reach_it(browser: Browser) -> None:
    opened(browser)
    nameless = browser.run(
        "return [...document.querySelectorAll('button, input:not([hidden]), select')].filter(one => one.offsetParent"
        " && !one.innerText && !one.getAttribute('aria-label') && !one.labels?.length).map(one => one.outerHTML)"
    )
    assert nameless == []
    browser.run("document.querySelector('#picture').focus()")
    before = browser.run("return window.voxrt.newest.camera.look")
    browser.keys(["\ue014"], 0.3)
    rests(browser)
    assert browser.run("return window.voxrt.newest.camera.look") != before


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_axe_finds_no_fault(browser: Browser, dark: bool) -> None:
    source = ROOT / "web" / "node_modules" / "axe-core" / "axe.min.js"
    if not source.exists():
        pytest.skip("axe-core is not here: make site")
    browser.theme(dark=dark)
    opened(browser)
    browser.click("#inspect")
    browser.mouse([browser.middle("#picture")])
    assert browser.until("!document.querySelector('#ray').hidden")
    browser.click("#edit-toggle")
    assert browser.until("document.querySelector('#edit-figures')?.textContent")
    browser.run(
        source.read_text()
        + "; window.axe = axe; window.faults = null; axe.run().then(found => { window.faults = found.violations })"
    )
    assert browser.until("window.faults !== null")
    found = browser.run(
        "return window.faults.map(one => [one.id, one.help, one.nodes.map(node => node.html.slice(0, 200))])"
    )
    browser.theme(dark=True)
    assert found == []


def test_a_picture_that_is_refined_does_not_jump(browser: Browser) -> None:
    """Corners of coarse frames look within half a pixel of the finest frame where its corners look."""
    opened(browser)
    script = """
        const [done] = arguments;
        (async () => {
          const { alignedRegisters, pixelDirection } = await import("./camera.js");
          const finest = [1824, 1504];
          let worst = 0;
          for (let i = 0; i < 200; i++) {
            const pose = { eye: [9, 9, 9], yaw: i * 0.7, pitch: Math.sin(i) * 1.5, fov: 35, distance: 50 };
            const corner = (size, x, y) => {
              const registers = alignedRegisters(pose, size, finest);
              const ray = pixelDirection(registers, size, x * size[0], y * size[1]);
              return ray.map((part) => part / Math.hypot(...ray));
            };
            for (const [x, y] of [[0, 0], [1, 0], [0, 1], [1, 1]])
              for (const part of [2, 4, 8]) {
                const coarse = corner(finest.map((side) => side / part), x, y);
                const fine = corner(finest, x, y);
                worst = Math.max(worst, Math.hypot(...coarse.map((one, axis) => one - fine[axis])));
              }
          }
          done(worst);
        })();
    """
    pixel = 2 * np.tan(np.deg2rad(35 / 2)) / (0.75 * 1824)
    assert browser.run_async(script) < pixel / 2
