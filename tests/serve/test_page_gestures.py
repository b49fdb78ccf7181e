"""The camera of the page by real mouse, touch and key events, on a desktop, a phone, and a phone that lies."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.browser import RESTS, SCREENS, chromium
from fakes.page_server import scene_of, serving, shown_page
from oracles import worlds

from voxrt.octree import Octree
from voxrt.sim import cast_rays, pixel_directions

DEPTH = 4
SHIFT = 8


class Page:
    """A page that shows a ball, and the camera that the server has from it."""

    def __init__(self, browser, server):
        self.browser, self.server = browser, server
        left, top, width, height = browser.run(
            "const b = document.querySelector('#picture').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]"
        )
        self.middle = np.array([left + width / 2, top + height / 2])
        self.shape = np.array([width, height])

    def rest(self):
        self.browser.draws()  # only then the stage may say that it is busy
        assert self.browser.until(f"({RESTS}) && !document.querySelector('#rendering').checkVisibility()")
        return self.server.session.renderer.view

    @property
    def eye(self):
        return np.array(self.rest().camera.position) / 16

    def axes(self):
        camera = self.rest().camera
        return [np.array(axis) / np.linalg.norm(axis) for axis in (camera.look, camera.right, camera.up)]

    def place_of(self, point):
        """Where a point of the scene is on the page, from the middle of the picture: right and down."""
        view = self.rest()
        look, right, up = (
            np.array(axis, dtype=float) for axis in (view.camera.look, view.camera.right, view.camera.up)
        )
        ahead, aside, above = np.linalg.solve(np.stack([look, right, up], axis=1), point - self.eye)
        scale = self.shape[0] / view.size[0]  # pixels of the page per column
        return np.array([aside / ahead, -above / ahead]) * scale

    def target(self):
        """The point of the central ray that is nearest to the middle of the scene."""
        look = self.axes()[0]
        return self.eye + look * (look @ (8 - self.eye))

    def path(self, right, down, start=(0, 0), steps=8):
        return [tuple(self.middle + start + np.array([right, down]) * step / steps) for step in range(steps + 1)]

    def drag(self, right, down, *, touch, fingers=1, button="left", modifiers=0):
        if touch:
            self.browser.touch(*(self.path(right, down, start=(40 * finger, 0)) for finger in range(fingers)))
        else:
            self.browser.mouse(self.path(right, down), button, modifiers=modifiers)


@pytest.fixture(params=SCREENS)
def page(request):
    width, height, touch = SCREENS[request.param]
    with chromium((1280, 900)) as browser, serving(scene_of("ball", worlds.ball(DEPTH), DEPTH)) as server:
        browser.screen(width, height, touch=touch)
        browser.open(server.url)
        assert browser.until(RESTS)
        shown = Page(browser, server)
        shown.touch = touch
        yield shown
        assert browser.faults() == []


def test_a_drag_orbits(page):
    target, distance = page.target(), np.linalg.norm(page.target() - page.eye)
    front = target - distance / 3 * page.axes()[0]  # nearer than the target
    before = page.place_of(front)
    page.drag(60, 40, touch=page.touch)
    assert page.place_of(target) == pytest.approx((0, 0), abs=3)
    assert np.linalg.norm(target - page.eye) == pytest.approx(distance, rel=0.02)
    moved = page.place_of(front) - before
    assert moved[0] > 5  # the front follows the pointer
    assert moved[1] > 5
    assert page.axes()[1][1] == pytest.approx(0, abs=0.01)  # the horizon stays level


@pytest.mark.parametrize("way", ["right", "middle", "shift"])
def test_a_right_drag_or_two_fingers_pan(page, way):
    if page.touch and way != "right":
        pytest.skip("fingers have one way to pan")
    target, look = page.target(), page.axes()[0]
    page.drag(
        60, 40, touch=page.touch, fingers=2,
        button="left" if way == "shift" else way, modifiers=SHIFT if way == "shift" else 0,
    )  # fmt: skip
    assert page.axes()[0] == pytest.approx(look, abs=0.01)
    assert page.place_of(target) == pytest.approx((60, 40), abs=4)  # the scene follows the pointer


def test_the_wheel_or_a_pinch_dollies(page):
    target, look, distance = page.target(), page.axes()[0], np.linalg.norm(page.target() - page.eye)
    if page.touch:
        page.browser.touch(page.path(60, 0, start=(30, 0)), page.path(-60, 0, start=(-30, 0)))
        factor = 30 / 90
    else:
        page.browser.wheel(*page.middle, -200)
        factor = np.exp(-0.2)
    assert page.axes()[0] == pytest.approx(look, abs=0.01)
    assert np.linalg.norm(target - page.eye) == pytest.approx(distance * factor, rel=0.05)
    assert page.place_of(target) == pytest.approx((0, 0), abs=4)


def hit_at(page, column, row):
    view, scene = page.rest(), page.server.session.renderer.scene
    direction = pixel_directions(view.camera, view.size)[row, column]
    return cast_rays(Octree(DEPTH, scene.words), page.eye[None], direction[None])


def test_a_double_click_focuses(page):
    look = page.axes()[0]
    columns, rows = page.rest().size
    away = np.array([-0.12, 0.1]) * min(page.shape)
    scale = columns / page.shape[0]
    column, row = (np.array([columns / 2, rows / 2]) + away * scale).astype(int)
    before = hit_at(page, column, row)
    assert before.hit[0]
    place = tuple(page.middle + away)
    if page.touch:
        page.browser.touch([place])
        page.browser.touch([place])
    else:
        page.browser.mouse([place], clicks=2)
    assert page.browser.until("document.querySelector('#stage').getAttribute('aria-busy') === 'true'", 2)
    columns, rows = page.rest().size
    after = hit_at(page, columns // 2, rows // 2)
    assert page.axes()[0] == pytest.approx(look, abs=0.01)
    assert after.voxel[0] == pytest.approx(before.voxel[0], abs=1)
    assert after.distance[0] < before.distance[0]


def test_f_frames_the_scene(page):
    page.drag(90, 60, touch=page.touch, fingers=2)
    if page.touch:
        page.browser.mouse([page.browser.middle("#frame")])
    else:
        page.browser.run("document.querySelector('#picture').focus()")
        page.browser.key("f", "KeyF")
    page.browser.until("document.querySelector('#stage').getAttribute('aria-busy') === 'true'", 2)
    solid = np.argwhere(worlds.ball(DEPTH))
    low, high = solid.min(axis=0), solid.max(axis=0) + 1
    corners = np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)])
    places = np.array([page.place_of(corner) for corner in corners]) / (page.shape / 2)
    reach = np.array([[-0.9, 0.9], [-0.92, 0.8]])  # there are tools at the bottom
    found = np.stack([places.min(axis=0), places.max(axis=0)], axis=1) / reach
    assert found.max() < 1.02  # all is in the picture
    assert found.min(axis=1).max() > 0.98  # as large as it can be: from side to side, or from top to bottom


def test_keys_fly_and_orbit():
    with shown_page(scene_of("ball", worlds.ball(DEPTH), DEPTH)) as (browser, server):
        assert browser.until(RESTS)
        page = Page(browser, server)
        browser.run("document.querySelector('#picture').focus()")
        look, right, _ = page.axes()
        for key, direction in (
            ("w", look),
            ("s", -look),
            ("d", right),
            ("a", -right),
            ("e", (0, 1, 0)),
            ("q", (0, -1, 0)),
        ):
            before = page.eye
            browser.keys([key], 0.2)
            moved = page.eye - before
            assert moved / np.linalg.norm(moved) == pytest.approx(direction, abs=0.1)
        assert page.axes()[0] == pytest.approx(look, abs=0.01)
        target, distance = page.target(), np.linalg.norm(page.target() - page.eye)
        browser.keys(["\ue014"], 0.2)  # right arrow
        assert np.linalg.norm(target - page.eye) == pytest.approx(distance, rel=0.02)
        assert page.axes()[0] != pytest.approx(look, abs=0.05)
        browser.keys(["+"], 0.2)
        assert np.linalg.norm(target - page.eye) < 0.95 * distance

        # In Fly, a drag turns around the eye.
        browser.mouse([browser.middle("#fly")])
        eye, look = page.eye, page.axes()[0]
        page.drag(100, 0, touch=False)
        assert page.eye == pytest.approx(eye, abs=0.1)
        assert page.axes()[0] != pytest.approx(look, abs=0.05)
        browser.key("r", "KeyR")
        camera = server.session.renderer.scene.camera
        assert page.eye == pytest.approx(np.array(camera.position) / 16, abs=0.1)


def test_fullscreen():
    with shown_page(scene_of("ball", worlds.ball(DEPTH), DEPTH)) as (browser, _):
        assert browser.until(RESTS)
        browser.mouse([browser.middle("#fullscreen")])
        assert browser.until("document.fullscreenElement === document.querySelector('#stage')")
        assert browser.until(
            "document.querySelector('#picture').width === document.querySelector('#stage').clientWidth"
        )
        browser.mouse([browser.middle("#fullscreen")])
        assert browser.until("document.fullscreenElement === null")
