"""Digging, building, undo and saving on the server's page, by real clicks."""

from __future__ import annotations

import base64

import numpy as np
import pytest
from fakes.browser import RESTS
from fakes.page_server import scene_of, shown_page
from msgspec.structs import replace
from oracles import worlds

from voxrt.board.edited_scene import rom_of
from voxrt.export import read_any
from voxrt.octree import Box, Sphere, World, census
from voxrt.sim import render
from voxrt.sim.picking import pick
from voxrt.voxelize import Material

PIXELS = """
const canvas = document.querySelector("#picture");
const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
return [canvas.width, canvas.height, Array.from(data.filter((_, i) => i % 4 < 3))];
"""
UNDO = "document.querySelector(\"[title='Ctrl Z']\")"
KEEP_FILES = """
window.savedFiles = {};
const made = URL.createObjectURL;
let last = null;
URL.createObjectURL = (blob) => made.call(URL, (last = blob));
HTMLAnchorElement.prototype.click = function () {
  const name = this.download;
  last.arrayBuffer().then((data) => { window.savedFiles[name] = btoa(String.fromCharCode(...new Uint8Array(data))); });
};
"""


def solid(session):
    world = session.renderer.world
    return None if world is None else census(world.rom().octree).solid_voxels


def test_edits_by_clicks(tmp_path):
    scene = scene_of("ball", worlds.ball(4), 4)
    whole = census(rom_of(scene).octree).solid_voxels
    with shown_page(scene) as (browser, server):
        session = server.session
        assert browser.until("document.querySelector('#scene').innerText === 'ball'")
        assert browser.until(RESTS)
        assert browser.run(f"return {UNDO}.disabled") is True
        place = browser.middle("#picture")

        def until_edits(number):
            for _ in range(200):
                if session.renderer.edits(None)["number"] == number:
                    break
                browser.draws()
            assert session.renderer.edits(None)["number"] == number

        browser.click("#edit-toggle")
        for number in (1, 2):
            browser.mouse([place])
            until_edits(number)
        assert solid(session) == whole - 2
        browser.click("[data-tool=build]")
        assert browser.run("return document.querySelector('[data-tool=dig]').ariaPressed") == "false"
        browser.mouse([place])
        until_edits(3)
        assert solid(session) == whole - 1
        assert browser.until(f"!{UNDO}.disabled")
        browser.click("[title='Ctrl Z']")
        until_edits(4)
        assert solid(session) == whole - 2
        browser.mouse([place, (place[0] + 60, place[1] + 20)], "middle")  # turns, and edits nothing
        browser.draws()
        assert browser.until(RESTS)
        assert session.renderer.edits(None)["number"] == 4
        view, world = session.renderer.view, session.renderer.world
        width, height, data = browser.run(PIXELS)
        expected = render(world.rom(), view.camera, view.size, engine="model").colour
        if expected.shape[:2] == (height, width):
            np.testing.assert_array_equal(np.array(data, np.uint8).reshape(height, width, 3), expected)

        browser.run(KEEP_FILES)
        browser.click("#save-mem")
        assert browser.until("Object.keys(window.savedFiles).length === 2")
        for name, text in browser.run("return window.savedFiles").items():
            (tmp_path / name).write_bytes(base64.b64decode(text))
        saved = read_any(tmp_path / "ball.mem")[0].rom
        np.testing.assert_array_equal(saved.octree.words, world.rom().octree.words)
        assert saved.materials[1].name == "m1"
        assert browser.faults() == []


class Edited:
    """A page with its server, and a world of Python that is edited as the server's should be."""

    def __init__(self, browser, server, scene):
        self.browser, self.renderer, self.world = browser, server.session.renderer, World(rom_of(scene))

    def until_edits(self, number):
        for _ in range(400):
            if self.renderer.edits(None)["number"] >= number:
                return
            self.browser.draws()
        raise AssertionError(f"there are {self.renderer.edits(None)} edits instead of {number}")

    def equals(self):
        found, expected = (one.rom().octree.words for one in (self.renderer.world, self.world))
        np.testing.assert_array_equal(found, expected)

    def shows(self, number, tool, place, size, material):
        """Wait for an edit, and compare it with that of a brush at the voxel that the ray of a place meets."""
        self.until_edits(number)
        found = pick(self.world, *ray_at(self.browser, self.renderer.view, place))
        middle = np.array(found.beside if tool == "build" else found.voxel) + 0.5
        shape = Sphere(middle, size / 2) if size > 1 else Box(middle - 0.5, middle + 0.5)
        if tool == "paint":
            self.world.paint(shape, material)
        else:
            self.world.fill(shape, material)
        self.equals()


CHOSEN = "document.querySelector('#swatches [aria-pressed=true]')"


@pytest.fixture
def page():
    scene = scene_of("ball", worlds.ball(5), 5)
    scene = replace(scene, names=scene.names[:9])
    with shown_page(scene) as (browser, server):
        assert browser.until("document.querySelector('#scene').innerText === 'ball'")
        assert browser.until(RESTS)
        browser.click("#edit-toggle")
        assert browser.until("document.querySelectorAll('#swatches button').length === 8")
        yield Edited(browser, server, scene)
        assert browser.faults() == []


def test_tools_do_what_they_do_in_a_world_of_python(page):
    """Both buttons, the brush and its keys, a new colour, undo, and the figures."""
    browser = page.browser
    x, y = browser.middle("#picture")
    browser.mouse([(x - 30, y)])
    page.shows(1, "dig", (x - 30, y), 1, 0)
    browser.keys(["]", "]"], 0.01)
    browser.mouse([(x + 40, y)], "right")
    page.shows(2, "build", (x + 40, y), 3, 1)
    browser.enter("#edit input[type=color]", "#3060f0", "change")
    assert browser.until(f"{CHOSEN}?.title === '#3060f0'")
    fresh = page.world.add_material(Material("#3060f0", (48, 96, 240)))
    browser.click("[data-tool=paint]")
    browser.mouse([(x, y + 40)])
    page.shows(4, "paint", (x, y + 40), 3, fresh)
    words = f"{8 * page.world.figures().blocks + 1:,} words · "
    assert browser.until(f"document.querySelector('#edit-figures').textContent.startsWith('{words}')")
    browser.keys(["\ue009", "z"], 0.01)
    page.until_edits(5)
    page.world.undo()
    page.equals()


def test_the_wheel_chooses_and_a_held_button_repeats(page):
    browser = page.browser
    x, y = browser.middle("#picture")
    browser.wheel(x, y, 50)
    assert browser.until(f"{CHOSEN}.dataset.id === '2'")
    browser.mouse([(x, y)], "middle")
    taken = pick(page.world, *ray_at(browser, page.renderer.view, (x, y))).material
    assert taken != 2
    assert browser.until(f"{CHOSEN}.dataset.id === '{taken}'")
    assert browser.until("document.querySelectorAll('#aim polygon').length === 2")
    pressed = {"x": x, "y": y, "button": "left", "clickCount": 1}
    browser.cdp("Input.dispatchMouseEvent", type="mousePressed", buttons=1, **pressed)
    page.until_edits(3)
    browser.cdp("Input.dispatchMouseEvent", type="mouseReleased", **pressed)
    browser.draws()
    edits = page.renderer.edits(None)["number"]
    browser.keys(["\ue009", "z"], 0.01)  # all of it is one stroke
    page.until_edits(edits + 1)
    page.equals()
    assert browser.until(f"{UNDO}.disabled")


def test_a_finger_taps_and_rests(page):
    browser = page.browser
    browser.screen(390, 844, touch=True)
    assert browser.until(RESTS)
    x, y = browser.middle("#picture")
    browser.touch([(x, y + 60)])
    page.shows(1, "dig", (x, y + 60), 1, 0)
    points = [{"x": x, "y": y + 60, "id": 1}]
    browser.cdp("Input.dispatchTouchEvent", type="touchStart", touchPoints=points)
    page.until_edits(3)
    browser.cdp("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])


def ray_at(browser, view, place):
    """The ray of the pixel at a place of the page, in voxels."""
    script = """const box = document.querySelector('#picture').getBoundingClientRect();
    return [box.x, box.y, box.width, box.height]"""
    left, top, wide, high = browser.run(script)
    width, height = view.size
    column, row = int((place[0] - left) / wide * width), int((place[1] - top) / high * height)
    camera = view.camera
    direction = np.array(camera.look) + np.array(camera.right) * (column - width // 2)
    return np.array(camera.position) / 16, direction + np.array(camera.up) * (height // 2 - row)


def test_an_edit_that_is_refused_is_told():
    scene = scene_of("ball", worlds.ball(4), 4)
    with shown_page(scene) as (browser, server):
        assert browser.until("document.querySelector('#scene').innerText === 'ball'")
        assert browser.until(RESTS)
        renderer = server.session.renderer
        browser.click("#edit-toggle")
        renderer.scene = replace(renderer.scene, roots=(0, 0))
        browser.mouse([browser.middle("#picture")])
        assert browser.until("document.querySelector('#notice').innerText.includes('is an animation')")
