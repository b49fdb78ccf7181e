"""Walking on the server's page by real keys and a real mouse: gravity, walls, digging and building where one stands."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest
from fakes.browser import RESTS, chromium
from fakes.page_server import scene_of, serving

from voxrt.octree import Octree, material_at, to_dense
from voxrt.serve.frame_client import open_client

SIDE = 64
EYE = SIDE / 32
WALKS = "document.querySelector('#walk').getAttribute('aria-pressed') === 'true'"


def yard():
    """Ground of eight voxels, a wall at x = 48, and a tunnel below the ground that nobody sees."""
    cells = np.zeros((SIDE,) * 3, np.uint8)
    cells[:, :8] = 1
    cells[48:, 8:40] = 2
    cells[20:44, 2:6, 20:44] = 0
    return cells


class Walk:
    """Somebody who walks in the yard, and the server whose camera is the eye."""

    def __init__(self, browser, server):
        self.browser, self.renderer, self.url = browser, server.session.renderer, server.url
        assert browser.until("document.querySelector('#scene').innerText === 'yard'")
        self.rests()
        browser.click("#walk")
        assert browser.until(WALKS)
        self.rests()

    def rests(self):
        self.browser.draws()
        assert self.browser.until(RESTS)

    @property
    def eye(self):
        return np.array(self.renderer.view.camera.position) / 16

    @property
    def edits(self):
        return self.renderer.edits(None)["number"]

    def until(self, condition):
        for _ in range(600):
            if condition():
                return
            self.browser.draws()
        raise AssertionError(self.eye)

    def is_free(self):
        """Whether the body of the eye meets nothing solid: voxel by voxel."""
        low, high = self.eye + np.array([[-0.3, -1.6, -0.3], [0.3, 0.2, 0.3]]) * EYE / 1.6
        cells = [np.arange(np.floor(a + 0.1), np.ceil(b - 0.1)) for a, b in zip(low, high, strict=True)]
        points = np.stack(np.meshgrid(*cells, indexing="ij"), axis=-1).reshape(-1, 3).astype(int)
        return not material_at(Octree(6, self.renderer.still_scene().words), points).any()


@pytest.fixture
def walk():
    with chromium(mouse=True) as browser, serving(scene_of("yard", yard(), 6)) as server:
        browser.screen(1024, 768, ratio=0.5)
        browser.open(server.url)
        yield Walk(browser, server)
        assert browser.faults() == []


def test_one_falls_to_the_ground_walks_to_walls_and_jumps(walk):
    browser = walk.browser
    ground = walk.eye[1]
    assert ground == pytest.approx(8 + EYE, abs=0.1)
    start, places = walk.eye, []
    with browser.held("w", "KeyW"):
        for _ in range(20):
            browser.draws()
            places.append(walk.eye)
    walk.rests()
    assert np.hypot(*(walk.eye - start)[[0, 2]]) > 1
    assert walk.is_free()
    assert all(place[1] == pytest.approx(ground, abs=0.1) for place in places)
    for key in "wa":  # to a wall, or to the end of the world
        browser.keys([key], 4)
        walk.rests()
        assert walk.is_free()
        assert (walk.eye[[0, 2]] > 0).all()
        assert (walk.eye[[0, 2]] < SIDE).all()
    with browser.held(" ", "Space"):
        walk.until(lambda: walk.eye[1] > ground + 0.5)
    walk.until(lambda: abs(walk.eye[1] - ground) < 0.1)
    browser.key("f", "KeyF")
    walk.rests()
    assert not browser.run(f"return {WALKS}")


def test_a_locked_mouse_digs_into_the_tunnel_below_and_one_undo_closes_it(walk):
    browser, begin = walk.browser, to_dense(Octree(6, walk.renderer.still_scene().words))
    ground, (x, y) = walk.eye[1], browser.middle("#picture")
    browser.click("#edit-toggle")
    browser.mouse([(x, y)])
    assert browser.until("document.pointerLockElement?.id === 'picture'")
    assert walk.edits == 0
    browser.cdp("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y + 900)
    walk.rests()
    pressed = {"x": x, "y": y + 900, "button": "left", "clickCount": 1}
    browser.cdp("Input.dispatchMouseEvent", type="mousePressed", buttons=1, **pressed)
    walk.until(lambda: walk.eye[1] < ground - 3)
    browser.cdp("Input.dispatchMouseEvent", type="mouseReleased", **pressed)
    walk.rests()
    assert walk.is_free()
    edits = walk.edits
    assert edits > 1
    browser.mouse([(x, y + 900)], "right")  # nothing is built where one stands
    walk.rests()
    assert walk.is_free()
    if walk.edits > edits:
        browser.keys(["\ue009", "z"], 0.01)
        walk.until(lambda: walk.edits == edits + 2)
        edits += 2
    browser.keys(["\ue009", "z"], 0.01)
    walk.until(lambda: walk.edits == edits + 1)
    np.testing.assert_array_equal(to_dense(Octree(6, walk.renderer.still_scene().words)), begin)


def test_another_scene_ends_the_walk_and_so_does_another_viewer_with_control(walk):
    browser, renderer = walk.browser, walk.renderer
    number = renderer.scene_number
    browser.click("[data-scenes] button")
    walk.until(lambda: renderer.scene_number == number + 1)
    assert browser.until(f"!({WALKS})")
    walk.rests()
    browser.click("#walk")
    assert browser.until(WALKS)

    async def take_over():
        async with open_client(walk.url) as client:
            await client.request("take")
            assert browser.until("!document.querySelector('#release').hidden")
            browser.click("#release")
            assert browser.until(f"!({WALKS})")

    asyncio.run(take_over())
