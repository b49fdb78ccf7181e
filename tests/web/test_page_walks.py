"""Walking on the static page by real keys and a real mouse, which is locked: gravity, walls, digging and building."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from fakes.browser import chromium
from fakes.static_page import EXAMPLES, opened, rests, shown, shows_exactly

import voxrt
from voxrt.octree import Sphere
from voxrt.sim import pick

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fakes.browser import Browser

SIDE = 128
EYE = SIDE / 12
"""Voxels from the soles to the eye in this world; the rest of a body as in serve/page/walk.js."""
BODY = np.array([[-0.3, -1.6, -0.3], [0.3, 0.2, 0.3]]) * EYE / 1.6
TURN = 0.002


@pytest.fixture(scope="module")
def opened_browser(address: str):
    with chromium(mouse=True) as one:
        one.address = address
        one.screen(1024, 768, ratio=0.5)
        yield one


class Walk:
    """Somebody who walks in the courtyard with the tool Dig, and a World of Python in which the same is done."""

    def __init__(self, browser: Browser) -> None:
        self.browser, self.brush = browser, 5
        self.world = voxrt.World(voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom)
        opened(browser)
        browser.click("#edit-toggle")
        assert browser.until("document.querySelector('#edit-figures')?.textContent")
        browser.click("#walk")
        assert browser.until("document.querySelector('#walk').getAttribute('aria-pressed') === 'true'")
        rests(browser)
        self.place = browser.middle("#picture")
        browser.mouse([self.place])
        assert browser.until("document.pointerLockElement?.id === 'picture'")

    @property
    def view(self) -> dict:
        return self.browser.run("return window.voxrt.view()")

    @property
    def edition(self) -> int:
        return int(self.browser.run("return document.querySelector('#stage').dataset.edition"))

    def walks(self) -> bool:
        return self.browser.run("return document.querySelector('#walk').getAttribute('aria-pressed')") == "true"

    def turn(self, right: float, down: float) -> None:
        x, y = self.place
        self.place = x + right, y + down
        self.browser.cdp("Input.dispatchMouseEvent", type="mouseMoved", x=self.place[0], y=self.place[1])
        rests(self.browser)

    def expect(self, *, build: int = 0) -> None:
        """Do in the World of Python what a tool does in the middle of the picture."""
        camera = self.browser.run("return window.voxrt.newest.camera")
        found = pick(self.world, np.array(camera["position"]) / 16, camera["look"])
        self.world.fill(Sphere(np.add(found.beside if build else found.voxel, 0.5), self.brush / 2), build)

    def waits(self, edition: int) -> None:
        assert self.browser.until(f"document.querySelector('#stage').dataset.edition === '{edition}'"), self.edition
        rests(self.browser)

    def shows_exactly(self) -> bool:
        return shows_exactly(self.browser, self.world.rom())

    def is_free(self, eye: list[float], soles: float = 0) -> bool:
        """Whether the body of an eye meets nothing solid, from so far above its soles: brute force, voxel by voxel."""
        low, high = np.array(eye) + BODY + [[0, soles, 0], [0, 0, 0]]
        cells = [np.arange(np.floor(a + 0.01), np.ceil(b - 0.01)) for a, b in zip(low, high, strict=True)]
        points = np.stack(np.meshgrid(*cells, indexing="ij"), axis=-1).reshape(-1, 3).astype(int)
        return not self.world.material_at(points).any()


@pytest.fixture
def walk(browser: Browser) -> Iterator[Walk]:
    one = Walk(browser)
    yield one
    browser.run("document.exitPointerLock()")


def test_the_press_that_locks_the_mouse_does_nothing_else_and_the_mouse_looks_around(walk: Walk) -> None:
    assert walk.edition == 0
    before = walk.view
    walk.turn(70, 30)
    after = walk.view
    assert after["yaw"] - before["yaw"] == pytest.approx(70 * TURN, abs=1e-6)
    assert after["pitch"] - before["pitch"] == pytest.approx(-30 * TURN, abs=1e-6)
    assert after["eye"] == before["eye"]
    # Browsers refuse the lock for a second after Escape; the next press gets it again.
    browser = walk.browser
    browser.run(
        "document.exitPointerLock();"
        "document.querySelector('#picture').requestPointerLock = () => Promise.reject(new Error('too soon'))"
    )
    assert browser.until("!document.pointerLockElement")
    browser.mouse([walk.place])
    rests(browser)
    browser.run("delete document.querySelector('#picture').requestPointerLock")
    browser.mouse([walk.place])
    assert browser.until("document.pointerLockElement?.id === 'picture'")
    assert walk.edition == 0


def test_a_locked_mouse_digs_builds_and_undoes_where_one_looks(walk: Walk) -> None:
    browser = walk.browser
    walk.turn(0, 100)
    material = int(browser.run("return document.querySelector('#swatches [aria-pressed=true]').dataset.id"))
    walk.expect()
    browser.mouse([walk.place])
    walk.waits(1)
    assert walk.shows_exactly()
    dug = walk.world.rom()
    walk.turn(-60, 0)
    walk.expect(build=material)
    browser.mouse([walk.place], "right")
    walk.waits(2)
    assert walk.shows_exactly()
    browser.keys(["\ue009", "z"], 0.01)
    walk.waits(3)
    assert shows_exactly(browser, dug)
    # Who runs digs, too: Shift is no gesture here.
    walk.world.undo()
    walk.turn(-60, 0)
    walk.expect()
    with browser.held("Shift", "ShiftLeft"):
        browser.mouse([walk.place], modifiers=8)
        walk.waits(4)
    assert walk.shows_exactly()
    # The middle button takes the material, the wheel the next one; neither moves the eye.
    before = walk.view
    browser.mouse([walk.place], "middle")
    browser.wheel(*walk.place, 100)
    rests(browser)
    assert walk.view == before


def test_a_held_button_digs_a_trench_where_the_mouse_turns(walk: Walk) -> None:
    browser = walk.browser
    walk.turn(0, 100)
    x, y = walk.place
    common = {"y": y, "button": "left", "buttons": 1}
    browser.cdp("Input.dispatchMouseEvent", type="mousePressed", x=x, clickCount=1, **common)
    for edition in range(1, 5):
        assert browser.until(f"Number(document.querySelector('#stage').dataset.edition) >= {edition}")
        x += 30
        browser.cdp("Input.dispatchMouseEvent", type="mouseMoved", x=x, **common)
    browser.cdp("Input.dispatchMouseEvent", type="mouseReleased", x=x, clickCount=1, **common)
    rests(browser)
    edition = walk.edition
    browser.keys(["\ue009", "z"], 0.01)  # all of it is one stroke
    walk.waits(edition + 1)
    assert walk.shows_exactly()


def test_keys_walk_up_to_walls_and_jump_back_to_the_ground(walk: Walk) -> None:
    browser = walk.browser
    start = walk.view["eye"]
    places = []
    with browser.held("w", "KeyW"):
        for _ in range(25):
            browser.draws()
            places.append(walk.view["eye"])
    rests(browser)
    end = walk.view["eye"]
    assert walk.is_free(end)
    assert all(walk.is_free(eye, soles=2.5) for eye in places)  # the eye is up later, where a step was climbed
    assert np.hypot(*np.subtract(end, start)[[0, 2]]) > 2
    browser.keys(["w"], 3)  # to the house or the fence
    rests(browser)
    stopped = walk.view["eye"]
    browser.keys(["w"], 0.5)
    rests(browser)
    assert np.abs(np.subtract(walk.view["eye"], stopped)).max() < 8  # along the wall, at most
    assert walk.is_free(walk.view["eye"])
    ground = walk.view["eye"][1]
    with browser.held(" ", "Space"):
        assert browser.until(f"window.voxrt.view().eye[1] > {ground + 4}")
    assert browser.until(f"Math.abs(window.voxrt.view().eye[1] - {ground}) < 0.01")


def test_who_digs_below_falls_and_undo_lifts_again(walk: Walk) -> None:
    browser = walk.browser
    walk.turn(0, 800)
    assert walk.view["pitch"] == pytest.approx(-np.pi / 2, abs=0.05)
    ground = walk.view["eye"][1]
    for _ in range(2):
        browser.key("]", "BracketRight")
    walk.brush = 9  # wider than a body
    walk.expect()
    browser.mouse([walk.place])
    walk.waits(1)
    assert browser.until(f"window.voxrt.view().eye[1] < {ground - 1}")
    rests(browser)
    assert walk.is_free(walk.view["eye"])
    assert walk.shows_exactly()
    browser.keys(["\ue009", "z"], 0.01)
    assert browser.until(f"Math.abs(window.voxrt.view().eye[1] - {ground}) < 0.01")
    walk.world.undo()
    rests(browser)
    assert walk.is_free(walk.view["eye"])
    assert walk.shows_exactly()


def test_other_ways_of_moving_and_other_scenes_end_the_walk(walk: Walk) -> None:
    browser = walk.browser
    browser.key("f", "KeyF")
    rests(browser)
    assert (walk.walks(), round(walk.view["fov"])) == (False, 35)
    assert browser.until("!document.pointerLockElement")
    browser.click("#walk")
    assert browser.until("document.querySelector('#walk').getAttribute('aria-pressed') === 'true'")
    browser.click("#walk")  # again: the picture of the orbit is not that of who walks
    rests(browser)
    browser.mouse([walk.place])
    assert browser.until("document.pointerLockElement?.id === 'picture'")
    browser.click("[data-example=house]")
    assert browser.until(shown("house", 7))
    assert (walk.walks(), round(walk.view["fov"])) == (False, 35)
    assert browser.until("!document.pointerLockElement")
