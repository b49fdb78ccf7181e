"""Edits on the static page by real clicks: pictures, words and all that is made of them are those of voxrt.World."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from fakes.static_page import EXAMPLES, frame_of, notice, opened, registers, rests, saved, show, shown, shows_exactly

import voxrt
from voxrt.octree import Box, Sphere
from voxrt.octree.camera import Lighting
from voxrt.sim import pick

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fakes.browser import Browser

Place = tuple[float, float]
SIZES = (1, 2, 3, 5, 7, 9, 13, 17, 25, 33, 49, 65)


class Edited:
    """The page, and a World of Python in which the same is done."""

    def __init__(self, browser: Browser, rom: voxrt.Rom) -> None:
        self.browser = browser
        self.world = voxrt.World(rom)
        self.size = 5
        browser.click("#edit-toggle")
        assert browser.until("document.querySelector('#edit-figures')?.textContent")

    def use(self, tool: str, size: int = 5) -> None:
        self.browser.click(f"[data-tool={tool}]")
        self.browser.enter("#edit .brush input", SIZES.index(size))
        self.size = size

    def material(self, id_: int) -> None:
        self.browser.click(f"#swatches [data-id='{id_}']")

    def ray(self, place: Place) -> tuple[np.ndarray, np.ndarray]:
        """The ray of the pixel of the picture at a place of the page."""
        camera, (width, height), _ = frame_of(self.browser)
        x, y, box = self.browser.run(
            "const b = document.querySelector('#picture').getBoundingClientRect();"
            "return [arguments[0] - b.x, arguments[1] - b.y, [b.width, b.height]]",
            *place,
        )
        columns = self.browser.run("return document.querySelector('#picture').width")
        samples = width // columns
        part = min(box[0] / columns, box[1] / (height / samples))
        column = math.floor((x - box[0] / 2) / part + columns / 2) * samples
        row = math.floor((y - box[1] / 2) / part + height / samples / 2) * samples
        known = registers(camera)
        direction = np.array(known.look) + np.array(known.right) * (column - width // 2)
        return np.array(known.position) / 16, direction + np.array(known.up) * (height // 2 - row)

    def expect(self, place: Place, tool: str, material: int = 0) -> None:
        """Do in the World of Python what a tool does at a place."""
        found = pick(self.world, *self.ray(place))
        voxel = found.beside if tool == "build" else found.voxel
        middle = np.array(voxel) + 0.5
        shape = Sphere(middle, self.size / 2) if self.size > 1 else Box(voxel, np.array(voxel) + 1)
        if tool == "paint":
            self.world.paint(shape, material)
        else:
            self.world.fill(shape, material)

    def waits(self, edition: int) -> None:
        """Wait until the picture shows that many patches."""
        assert self.browser.until(f"document.querySelector('#stage').dataset.edition === '{edition}'"), notice(
            self.browser
        )

    def shows_exactly(self) -> bool:
        return shows_exactly(self.browser, self.world.rom())

    def middle(self, right: float = 0, down: float = 0) -> Place:
        """A place of the page; pixels count as they do where the scene is 684 of them across."""
        x, y = self.browser.middle("#picture")
        size = "const p = document.querySelector('#picture'); return Math.min(0.75 * p.clientWidth, p.clientHeight)"
        unit = self.browser.run(size) / 684
        return x + right * unit, y + down * unit


@pytest.fixture
def page(browser: Browser) -> Iterator[Edited]:
    browser.screen(1024, 768, ratio=0.5)  # few pixels: the tests are quick
    opened(browser)
    yield Edited(browser, voxrt.build(EXAMPLES / "courtyard.glb", depth=7).rom)
    browser.screen(1280, 800)


def test_left_digs_and_right_builds_exactly(page: Edited) -> None:
    page.material(4)
    for number, (tool, button, id_) in enumerate([("dig", "left", 0), ("build", "right", 4), ("dig", "left", 0)], 1):
        place = page.middle(40 * number - 140, 60)
        page.expect(place, tool, id_)
        page.browser.mouse([place], button)
        page.waits(number)
        assert page.shows_exactly(), number
    words = f"{8 * page.world.figures().blocks + 1:,} words"
    assert page.browser.until(f"document.querySelector('#edit-figures').textContent.startsWith('{words}')")
    assert page.browser.until(f"document.querySelector('#details').textContent.includes('{words}')")


def test_paint_undo_and_redo(page: Edited) -> None:
    before = frame_of(page.browser)[2]
    page.use("paint", 9)
    page.material(5)
    place = page.middle(-100, 80)
    page.expect(place, "paint", 5)
    page.browser.mouse([place])
    page.waits(1)
    assert page.shows_exactly()
    painted = frame_of(page.browser)[2]
    page.browser.keys(["\ue009", "z"], 0.01)
    page.waits(2)
    assert np.array_equal(frame_of(page.browser)[2], before)
    page.browser.keys(["\ue009", "y"], 0.01)
    page.waits(3)
    assert np.array_equal(frame_of(page.browser)[2], painted)
    undo = "#edit-tools button:nth-of-type(5)"
    assert page.browser.until(f"!document.querySelector('{undo}').disabled")  # the figures come after the picture
    page.browser.click(undo)
    page.waits(4)
    assert page.browser.until(f"document.querySelector('{undo}').disabled")


def test_a_held_button_repeats_and_is_undone_at_once(page: Edited) -> None:
    before = frame_of(page.browser)[2]
    x, y = page.middle(60, 40)
    common = {"x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1}
    page.browser.cdp("Input.dispatchMouseEvent", type="mousePressed", **common)
    page.waits(3)
    page.browser.cdp("Input.dispatchMouseEvent", type="mouseReleased", **common)
    edition = int(page.browser.run("return document.querySelector('#stage').dataset.edition"))
    page.browser.keys(["\ue009", "z"], 0.01)
    assert page.browser.until(f"Number(document.querySelector('#stage').dataset.edition) > {edition}")
    assert np.array_equal(frame_of(page.browser)[2], before)


def test_a_press_beside_the_scene_and_the_middle_button_turn(page: Edited) -> None:
    x, y = page.middle()
    for path, button in [([(30, y + 250), (130, y + 250)], "left"), ([(x, y), (x + 90, y)], "middle")]:
        before = page.browser.run("return window.voxrt.newest.camera.look.join()")
        page.browser.mouse(path, button)
        assert page.browser.until(f"window.voxrt.newest.camera.look.join() !== '{before}'")
        rests(page.browser)
    assert page.browser.run("return document.querySelector('#stage').dataset.edition") == "0"


def test_the_wheel_and_a_middle_click_choose_the_material(page: Edited) -> None:
    chosen = "Number(document.querySelector('#swatches [aria-pressed=true]').dataset.id)"
    page.material(2)
    page.browser.wheel(*page.middle(), 100)
    assert page.browser.until(f"{chosen} === 3")
    place = page.middle(-20, 110)
    id_ = pick(page.world, *page.ray(place)).material
    page.browser.mouse([place], "middle")
    assert page.browser.until(f"{chosen} === {id_}")


def test_a_frame_marks_the_face_under_the_pointer(page: Edited) -> None:
    page.use("build", 1)
    place = page.middle(-60, 90)
    found = pick(page.world, *page.ray(place))
    page.browser.cdp("Input.dispatchMouseEvent", type="mouseMoved", x=place[0], y=place[1])
    assert page.browser.until("document.querySelectorAll('#aim polygon').length === 2")
    corners = page.browser.run("return document.querySelector('#aim polygon').getAttribute('points')")
    camera, (width, height), _ = frame_of(page.browser)
    known = registers(camera)
    axis = next(axis for axis in range(3) if found.voxel[axis] != found.beside[axis])
    across = [other for other in range(3) if other != axis]
    plane = np.array(found.voxel) + np.eye(3)[axis] * (found.beside[axis] > found.voxel[axis])
    expected = []
    for first, second in [(0, 0), (1, 0), (1, 1), (0, 1)]:
        corner = plane + first * np.eye(3)[across[0]] + second * np.eye(3)[across[1]]
        away = corner - np.array(known.position) / 16
        t, a, b = np.linalg.solve(np.transpose([known.look, known.right, known.up]), away)
        expected.append((width // 2 + a / t + 0.5, height // 2 - b / t + 0.5))
    marked = [[float(part) for part in corner.split(",")] for corner in corners.split()]
    assert np.allclose(sorted(marked), sorted(expected), atol=0.06)


def test_a_finger_taps_rests_and_turns(page: Edited) -> None:
    page.browser.screen(390, 844, touch=True)
    try:
        rests(page.browser)
        place = page.middle(0, 40)
        page.expect(place, "dig")
        page.browser.touch([place])
        page.waits(1)
        assert page.shows_exactly()
        before = page.browser.run("return window.voxrt.newest.camera.look.join()")
        page.browser.touch([place, (place[0] + 40, place[1]), (place[0] + 80, place[1])])
        assert page.browser.until(f"window.voxrt.newest.camera.look.join() !== '{before}'")
        rests(page.browser)
        points = [{"x": place[0], "y": place[1], "id": 1}]
        page.browser.cdp("Input.dispatchTouchEvent", type="touchStart", touchPoints=points)
        page.waits(3)
        page.browser.cdp("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
    finally:
        page.browser.screen(1024, 768, ratio=0.5)


def test_light_is_that_of_the_changed_world(page: Edited) -> None:
    page.browser.click("#features button")  # the lamp, which makes shadows
    rests(page.browser)
    place = page.middle(-20, 60)
    page.use("build", 9)
    page.material(4)
    page.expect(place, "build", 4)
    page.browser.mouse([place])
    page.waits(1)
    rests(page.browser)
    lighting = Lighting(tuple(round(16 * 128 * part) for part in (1.4, 1.9, 1.1)), on=True)
    assert shows_exactly(page.browser, page.world.rom(), lighting)


def test_rays_links_pages_and_the_hardware_have_the_edits(page: Edited, tmp_path: Path) -> None:
    browser = page.browser
    place = page.middle(-20, 60)
    page.expect(place, "dig")
    browser.mouse([place])
    page.waits(1)
    browser.click("#run-hardware")  # at once: it waits for the edit
    browser.click("[data-tool=look]")
    browser.click("#inspect")
    found = pick(page.world, *page.ray(place))
    browser.mouse([place])
    assert browser.until("!document.querySelector('#ray').hidden")
    says = browser.run("return document.querySelector('#ray-result').textContent")
    assert f"at voxel {', '.join(map(str, found.voxel))}" in says
    assert browser.until("!document.querySelector('#hardware-result').hidden", 60)
    assert browser.run("return document.querySelector('#hardware-says').textContent").startswith("0 wrong pixels")
    one_page = saved(browser, tmp_path, "#save-page", "courtyard.html").decode()
    browser.click("#copy")
    assert browser.until("location.hash.includes('memory=')")
    packed = browser.run("return new URLSearchParams(location.hash.slice(1)).get('memory')")
    assert f'packed="{packed}"' in one_page
    # The link alone brings the edited scene.
    link = browser.run("return location.hash")
    opened(browser, link)
    assert f"{len(page.world.rom().octree.words):,} words" in browser.run(
        "return document.querySelector('#details').innerText"
    )
    assert page.shows_exactly()


def test_another_scene_ends_the_edits(page: Edited) -> None:
    page.browser.mouse([page.middle(-20, 60)])
    page.waits(1)
    page.browser.click("[data-example=house]")
    assert page.browser.until(shown("house", 7)), notice(page.browser)
    assert page.browser.run("return document.querySelector('#edit').hidden")
    assert not page.browser.run("return document.querySelector('#depth').disabled")
    page.browser.click("#edit-toggle")
    page.world = voxrt.World(voxrt.build(EXAMPLES / "house.obj", depth=7).rom)
    page.expect(page.middle(), "dig")
    page.browser.mouse([page.middle()])
    page.waits(2)
    assert page.shows_exactly()


def test_a_new_colour_is_built_and_saved(page: Edited, tmp_path: Path) -> None:
    page.use("build", 1)
    page.browser.enter("#edit input[type=color]", "#102030", "change")
    chosen = "document.querySelector('#swatches [aria-pressed=true]')"
    assert page.browser.until(f"{chosen}?.title === 'colour #102030'")
    id_ = page.world.add_material(voxrt.Material("colour #102030", (16, 32, 48)))
    place = page.middle(30, 70)
    page.expect(place, "build", id_)
    page.browser.mouse([place])
    page.waits(1)
    assert page.shows_exactly()
    words = saved(page.browser, tmp_path, "#save-mem", "courtyard.mem")  # at once: it waits for the edit
    (tmp_path / "voxrt.mem").write_bytes(words)
    manifest = saved(page.browser, tmp_path, "#save-manifest", "courtyard.json")
    (tmp_path / "voxrt.json").write_bytes(manifest)
    known = json.loads(manifest)
    assert (known["source"], known["objects"], known["warnings"]) == (None, [], [])
    read, _ = voxrt.read_rom(tmp_path / "voxrt.mem")
    assert np.array_equal(read.octree.words, page.world.rom().octree.words)
    assert read.materials == page.world.materials


def eye(browser: Browser) -> np.ndarray:
    rests(browser)
    return np.array(browser.run("return window.voxrt.view().eye"))


def test_walk_stands_on_the_ground_that_is_dug_away(page: Edited) -> None:
    browser = page.browser
    page.use("dig", 9)
    browser.click("#walk")
    assert browser.until("document.querySelector('#walk').getAttribute('aria-pressed') === 'true'")
    start = eye(browser)
    ground = np.floor(start - [0, 1, 0] * np.arange(30)[:, None]).astype(int)
    solid = np.flatnonzero(page.world.material_at(ground))
    tall = start[1] - (ground[solid[0]][1] + 1)
    size = page.world.rom().grid.voxel_size
    assert tall == pytest.approx(max(1.6, min(1.6 / size, 128 / 12)), abs=0.01)
    browser.keys(["w"], 0.4)
    walked = eye(browser)
    assert np.hypot(*(walked - start)[[0, 2]]) > 1
    assert page.world.material_at(np.floor(walked).astype(int)) == 0
    browser.run("document.querySelector('#picture').focus()")
    browser.keys(["\ue015"], 1.2)  # looks down at the feet
    assert browser.until("window.voxrt.view().pitch < -1.3")
    rests(browser)
    page.expect(page.middle(), "dig")
    browser.key("x", "KeyX")
    page.waits(1)
    assert browser.until(f"window.voxrt.view().eye[1] < {walked[1] - 1}")
    assert eye(browser)[1] < walked[1] - 1
    # Nothing is built where somebody stands.
    page.use("build", 9)
    browser.key("x", "KeyX")
    browser.click("#orbit")
    rests(browser)
    assert browser.run("return document.querySelector('#stage').dataset.edition") == "1"
    assert browser.run("return window.voxrt.view().fov") == pytest.approx(35)


def test_an_edited_memory_keeps_what_its_manifest_says_of_the_picture(browser: Browser, tmp_path: Path) -> None:
    rom = voxrt.build(EXAMPLES / "dog.usda", tmp_path).rom
    known = json.loads((tmp_path / "dog.json").read_text())
    known["view"] = {"position": [300, 900, -900], "look": [0, -60, 90], "right": [-1, 0, 0], "up": [0, 1, 1]}
    known["lighting"] = {"position": [9, 9, 9], "ambient": 40, "on": False, "flat": True, "bounces": 0, "faces": None}
    (tmp_path / "dog.json").write_text(json.dumps(known))
    opened(browser)
    show(browser, tmp_path / "dog.mem", tmp_path / "dog.json", depth=rom.octree.depth)
    page = Edited(browser, rom)
    size = int(browser.run("return document.querySelector('#edit output').textContent"))
    page.use("dig", size)
    browser.click("#frame")
    rests(browser)
    place = page.middle(0, -20)
    page.expect(place, "dig")
    browser.mouse([place])
    page.waits(1)
    folder = tmp_path / "saved"
    saved(browser, folder, "#save-mem", "dog.mem")
    manifest = json.loads(saved(browser, folder, "#save-manifest", "dog.json"))
    assert (manifest["view"], manifest["lighting"]) == (known["view"], known["lighting"])
    read, warnings = voxrt.read_rom(folder / "dog.mem")
    assert warnings == ()
    assert np.array_equal(read.octree.words, page.world.rom().octree.words)
    assert (read.materials, read.grid.voxel_size) == (rom.materials, rom.grid.voxel_size)
