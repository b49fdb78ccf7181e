"""Digging, building, undo and saving on the server's page, by real clicks."""

from __future__ import annotations

import base64
from dataclasses import replace

import numpy as np
from fakes.browser import RESTS
from fakes.page_server import scene_of, shown_page
from oracles import worlds

from voxrt.board.edited_scene import rom_of
from voxrt.export import read_any
from voxrt.octree import census
from voxrt.sim import render

PIXELS = """
const canvas = document.querySelector("#picture");
const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
return [canvas.width, canvas.height, Array.from(data.filter((_, i) => i % 4 < 3))];
"""
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
        assert browser.run("return document.querySelector('#undo').disabled") is True
        place = browser.middle("#picture")

        def until_edits(number):
            for _ in range(200):
                if session.renderer.edits(None)["number"] == number:
                    break
                browser.draws()
            assert session.renderer.edits(None)["number"] == number

        browser.click("#dig")
        for number in (1, 2):
            browser.mouse([place])
            until_edits(number)
        assert solid(session) == whole - 2
        browser.click("#build")
        assert browser.run("return document.querySelector('#dig').ariaPressed") == "false"
        browser.mouse([place])
        until_edits(3)
        assert solid(session) == whole - 1
        assert browser.until("!document.querySelector('#undo').disabled")
        browser.click("#undo")
        until_edits(4)
        assert solid(session) == whole - 2
        browser.mouse([place, (place[0] + 60, place[1] + 20)])  # a drag turns, and edits nothing
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


def test_an_edit_that_is_refused_is_told():
    scene = scene_of("ball", worlds.ball(4), 4)
    with shown_page(scene) as (browser, server):
        assert browser.until("document.querySelector('#scene').innerText === 'ball'")
        assert browser.until(RESTS)
        renderer = server.session.renderer
        browser.click("#build")
        renderer.scene = replace(renderer.scene, roots=(0, 0))
        browser.mouse([browser.middle("#picture")])
        assert browser.until("document.querySelector('#notice').innerText.includes('is an animation')")
