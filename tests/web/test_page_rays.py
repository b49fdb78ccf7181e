"""Rays on the static page: one followed word by word, and all of a picture by the verilated ray tracer."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fakes.static_page import EXAMPLES, opened, registers, rests

import voxrt
from voxrt.sim import render

if TYPE_CHECKING:
    from fakes.browser import Browser


def test_a_ray_is_followed_as_voxrt_trace_does(browser: Browser) -> None:
    opened(browser)
    browser.click("#inspect")
    browser.mouse([browser.middle("#picture")])
    assert browser.until("!document.querySelector('#ray').hidden")
    text = browser.run("return document.querySelector('#ray-result').textContent")
    column, row = (int(part) for part in re.match(r"Pixel (\d+), (\d+)", text).groups())
    camera, size = browser.run(
        "const { width, height } = document.querySelector('#picture');"
        "return [window.voxrt.shownCamera(), [width, height]]"
    )
    rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom
    path = voxrt.sim.follow_pixel(rom.octree, registers(camera), tuple(size), (column, row))
    rows = browser.run(
        "return [...document.querySelectorAll('#ray-rows tr')].map(r => [...r.cells])"
        ".map(cells => cells.map(c => c.textContent))"
    )
    assert [(one[1], one[2]) for one in rows] == [(str(step.address), f"{step.word:08X}") for step in path.readings]
    assert "hits" in text
    assert browser.run("return document.querySelectorAll('#octants path').length") > 0


def hardware_says(browser: Browser) -> str:
    return browser.run("return document.querySelector('#hardware-says').textContent")


def test_the_real_hardware_renders_the_view_with_no_wrong_pixel(browser: Browser, paths: list[str]) -> None:
    opened(browser)
    assert not any("hardware.wasm" in path for path in paths)
    browser.click("#run-hardware")
    assert browser.until("!document.querySelector('#hardware-result').hidden", 60), hardware_says(browser)
    assert hardware_says(browser).startswith("0 wrong pixels of 76,800")
    assert any("hardware.wasm" in path for path in paths)
    # The circuit counts the clocks that it takes natively, for the same view.
    script = """
        const { toRegisters } = await import("./camera.js");
        arguments[0](toRegisters(window.voxrt.view(), [320, 240]));
    """
    camera = browser.run_async(f"(async (...arguments) => {{ {script} }})(...arguments)")
    rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom
    native = render(rom, registers(camera), (320, 240), engine="rtl", config="tiny")
    facts = browser.run("return document.querySelector('#hardware-facts').innerText")
    assert f"{native.cost.cycles:,}" in facts
    assert f"{native.cost.cycles / 76800:.2f}" in facts


def test_a_run_of_the_hardware_can_be_cancelled_and_the_page_stays_usable(browser: Browser) -> None:
    opened(browser)
    browser.click("#run-hardware")
    assert browser.run("return document.querySelector('#run-hardware').textContent") == "Cancel"
    x, y = browser.middle("#picture")
    before = browser.run("return window.voxrt.newest.camera.look")
    browser.mouse([(x, y), (x + 60, y)])
    rests(browser)
    assert browser.run("return window.voxrt.newest.camera.look") != before
    browser.run("const run = document.querySelector('#run-hardware'); if (run.textContent === 'Cancel') run.click()")
    assert browser.until("document.querySelector('#run-hardware').textContent === 'Run the real hardware'")
    assert browser.run("return document.querySelector('#hardware-progress').hidden")
    browser.click("#run-hardware")
    assert browser.until("!document.querySelector('#hardware-result').hidden", 60), hardware_says(browser)
    assert hardware_says(browser).startswith("0 wrong pixels")
