"""The page in headless Chromium, with a frame server and the exact model: pictures, scenes, connections."""

from __future__ import annotations

import asyncio
import threading

import numpy as np
import pytest
from fakes.browser import RESTS, chromium
from fakes.page_server import rom_of, scene_of, serving, shown_page
from msgspec.structs import replace
from oracles import worlds

from voxrt.board.simulated.core import open_rtl
from voxrt.board.simulated.model import ModelDevice
from voxrt.export import write_rom
from voxrt.sim import look_at, pixel_directions

PIXELS = """
const canvas = document.querySelector("#picture");
const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
return [canvas.width, canvas.height, Array.from(data.filter((_, i) => i % 4 < 3))];
"""
CUBE = "".join(f"v {i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8)) + "".join(
    f"f {face}\n" for face in ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")
)


def picture(browser):
    width, height, data = browser.run(PIXELS)
    return np.array(data, dtype=np.uint8).reshape(height, width, 3)


def averaged(colour, samples):
    """The mean of each `samples` x `samples` pixels in linear light, sRGB."""
    part = colour.astype(np.float64) / 255
    linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
    height, width, _ = colour.shape
    mean = linear.reshape(height // samples, samples, width // samples, samples, 3).mean(axis=(1, 3))
    return 255 * np.where(mean <= 0.0031308, 12.92 * mean, 1.055 * mean ** (1 / 2.4) - 0.055)


def shows_the_view(server, browser):
    """Whether the canvas shows the frame that the model renders for the view of the server."""
    assert browser.until(RESTS)
    view, scene = server.session.renderer.view, server.session.renderer.scene
    device = ModelDevice()
    device.write_memory(0, scene.words)
    device.write_materials(scene.colours, scene.mirrors)
    device.select_scene(scene.roots[view.frame], scene.depth)
    expected = device.frame(view).colour
    shown = picture(browser)
    samples = expected.shape[0] // shown.shape[0]
    if samples == 1:
        return np.array_equal(shown, expected)
    return np.abs(shown - averaged(expected, samples)).max() < 1


def test_page(tmp_path):
    with shown_page(scene_of("first", worlds.boxes(4, 9, 3), 4)) as (browser, server):
        assert browser.until("document.querySelector('#scene').innerText === 'first'")
        assert shows_the_view(server, browser)
        stage = browser.run("const s = document.querySelector('#stage'); return [s.clientWidth, s.clientHeight]")
        assert list(picture(browser).shape[1::-1]) == stage
        before = server.session.renderer.view.camera

        # Turning the camera turns look, right and up: right-handed, orthogonal, at the largest scale.
        browser.run("document.querySelector('#picture').focus()")
        browser.keys(["\ue012"], 0.3)  # left arrow
        browser.keys(["w"], 0.3)
        assert browser.until(RESTS)
        view = server.session.renderer.view
        camera = view.camera
        assert camera != before
        look, right, up = (np.array(triple, dtype=float) for triple in (camera.look, camera.right, camera.up))
        cosines = [a @ b / np.linalg.norm(a) / np.linalg.norm(b) for a, b in ((look, right), (look, up), (right, up))]
        assert np.abs(cosines).max() < 0.03
        assert np.cross(look, up) @ right > 0
        eye = np.array(camera.position) / 16
        best = look_at(eye, eye + look, size=view.size)
        assert (
            np.abs(pixel_directions(best, view.size)).max() < 1.05 * np.abs(pixel_directions(camera, view.size)).max()
        )
        assert shows_the_view(server, browser)

        # A memory and a mesh, by the file dialogue.
        files = write_rom(tmp_path, rom_of("second", worlds.ball(4), 4))
        browser.give_files("#files", [str(files.mem), str(files.manifest)])
        assert browser.until("document.querySelector('#scene').innerText === 'second'")
        (tmp_path / "cube.obj").write_text(CUBE)
        browser.give_files("#files", [str(tmp_path / "cube.obj")])
        assert browser.until("document.querySelector('#scene').innerText === 'cube'")
        assert shows_the_view(server, browser)
        (tmp_path / "cube.obj").write_text("f 1 2 3\n")
        browser.give_files("#files", [str(tmp_path / "cube.obj")])
        assert browser.until("document.querySelector('#notice').innerText.includes('was not loaded')")
        browser.click("#close")

        # Controls of the panel: a scene, shading, background, flip, a view.
        browser.click("#panel [data-scene=first]")
        assert browser.until("document.querySelector('#scene').innerText === 'first'")
        for selector in ("[data-shading=flat]", "#flip-x", "#presets button:nth-child(2)"):
            browser.click(selector)
        browser.enter("#background", "#204060")
        assert browser.until("document.querySelector('[data-shading=flat]').ariaPressed === 'true'")
        assert shows_the_view(server, browser)
        view = server.session.renderer.view
        assert view.background == (0x20, 0x40, 0x60)
        assert view.lighting.shading == "flat"
        assert np.cross(view.camera.look, view.camera.up) @ view.camera.right < 0
        assert browser.faults() == []


@pytest.mark.parametrize("change", ["#flip-x", "#presets button:nth-child(2)", "[data-shading=flat]"])
def test_the_picture_is_busy_from_the_change_on(change):
    busy = "document.querySelector(arguments[0]).click(); return document.querySelector('#stage').ariaBusy"
    with shown_page(scene_of("first", worlds.boxes(4, 9, 3), 4)) as (browser, _):
        assert browser.until(f"{RESTS} && document.querySelector('#scene').innerText === 'first'")
        assert browser.run(busy, change) == "true"
        assert browser.until(RESTS)


def test_scenes_that_were_opened_stay_in_the_list(tmp_path):
    files = write_rom(tmp_path, rom_of("second", worlds.ball(4), 4))
    with shown_page(scene_of("first", worlds.boxes(4, 9, 3), 4)) as (browser, _):
        assert browser.until(f"{RESTS} && document.querySelector('#scene').innerText === 'first'")
        browser.give_files("#files", [str(files.mem), str(files.manifest)])
        for name in ("second", "first", "second"):
            assert browser.until(f"document.querySelector('#panel [data-scene={name}]')?.disabled === false")
            browser.click(f"#panel [data-scene={name}]")
            assert browser.until("document.querySelector('#notice').hidden")
            assert browser.until(f"document.querySelector('#scene').innerText === '{name}'")
            assert browser.until(f"document.querySelector('#panel [data-scene={name}]').ariaPressed === 'true'")
        assert browser.faults() == []


def test_a_link_shows_a_scene_and_a_view(tmp_path):
    files = write_rom(tmp_path, rom_of("second", worlds.ball(4), 4))
    with shown_page(scene_of("first", worlds.boxes(4, 9, 3), 4)) as (browser, server):
        assert browser.until(f"{RESTS} && document.querySelector('#scene').innerText === 'first'")
        browser.run("document.querySelector('#picture').focus()")
        browser.keys(["\ue012"], 0.3)  # left arrow
        assert browser.until(RESTS)
        camera = server.session.renderer.view.camera
        browser.click("#copy")
        link = browser.run("return location.href")
        browser.give_files("#files", [str(files.mem), str(files.manifest)])
        assert browser.until("document.querySelector('#scene').innerText === 'second'")
        assert browser.run("return document.querySelector('#copy').hidden")  # nobody else has its files
        browser.open("about:blank")
        browser.open(link)
        assert browser.until("document.querySelector('#scene').innerText === 'first'")
        browser.draws()
        assert browser.until(RESTS)
        again = server.session.renderer.view.camera
        assert np.allclose(again.look, camera.look, atol=60)
        assert np.allclose(again.position, camera.position, atol=2)
        browser.open("about:blank")
        browser.open(f"{server.url}#scene=castle")
        assert browser.until("document.querySelector('#notice').innerText.includes('castle was not loaded')")
        assert browser.faults() == []


def test_light():
    with shown_page(scene_of("ball", worlds.ball(4), 4)) as (browser, server):
        assert browser.until(RESTS)
        assert browser.run("return document.querySelector('[data-shading=faces]').ariaPressed") == "true"
        for shading in ("report", "faces"):
            browser.click(f"[data-shading={shading}]")
            assert browser.until(
                f"document.querySelector('[data-shading={shading}]').ariaPressed === 'true' && {RESTS}"
            )
            assert server.session.renderer.view.lighting.shading == shading
        assert browser.run("return document.querySelector('#light').hidden")
        browser.click("[data-feature=light]")
        assert browser.until("!document.querySelector('#light').hidden")
        for name, value in (("Direction", 90), ("Height", 0), ("Ambient", 200)):
            browser.enter(f"#light [aria-label={name}]", value)
        assert browser.until(f"document.querySelector('#light [aria-label=Ambient]').value === '200' && {RESTS}")
        lighting = server.session.renderer.view.lighting
        assert lighting.on
        assert lighting.ambient == 200
        x, y, z = np.array(lighting.position) / 16 - 8  # from the middle of the ball: level, and at the right
        assert x > 16
        assert (abs(y), abs(z)) == pytest.approx((0, 0), abs=0.1)
        assert shows_the_view(server, browser)


def test_an_animation_plays_and_stops_at_a_frame():
    still = scene_of("walk", worlds.boxes(4, 9, 3), 4)
    walk = replace(still, roots=(0, *(int(at) for at in np.flatnonzero(still.words[:9] >> 31 == 0)[1:3])), period=0.05)
    assert len(walk.roots) == 3
    seen = "window.seen = new Set(); new MutationObserver(() => window.seen.add(document.querySelector('#frame-number')"
    seen += ".textContent)).observe(document.querySelector('#frame-number'), { childList: true, characterData: true })"
    with shown_page(walk) as (browser, server):
        assert browser.until("document.querySelector('#play').textContent === 'Pause'")
        browser.run(seen)
        for number in (1, 2, 3):
            assert browser.until(f"window.seen.has('{number} / 3')")
        browser.mouse([browser.middle("#play")])
        assert browser.until(f"document.querySelector('#play').ariaPressed === 'false' && {RESTS}")
        for frame in (2, 0, 1):
            browser.enter("#frames", frame)
            assert browser.until(f"document.querySelector('#frame-number').textContent === '{frame + 1} / 3'")
            browser.draws()
            assert shows_the_view(server, browser)
            assert server.session.renderer.view.frame == frame
        browser.run("window.seen.clear()")
        browser.mouse([browser.middle("#play")])
        assert browser.until("window.seen.size === 3")
        assert browser.faults() == []


def test_an_empty_server_shows_where_to_drop_and_what_to_open(tmp_path):
    (tmp_path / "cube.obj").write_text(CUBE)
    with shown_page(scene_of("first", worlds.boxes(4, 9, 3), 4), shown=False) as (browser, server):
        assert browser.until("document.querySelector('#empty').checkVisibility()")
        assert browser.run("return document.querySelector('#empty').innerText").startswith("Drop a scene here")
        assert not browser.run("return document.querySelector('#tools').checkVisibility({visibilityProperty: true})")
        assert browser.until("!document.querySelector('#empty [data-scene=first]').disabled")
        browser.drop(400, 300, [str(tmp_path / "cube.obj")])
        assert browser.until("document.querySelector('#scene').innerText === 'cube'")
        assert browser.run("return document.querySelector('#empty').hidden && document.querySelector('#drop').hidden")
        assert shows_the_view(server, browser)
    with shown_page(scene_of("first", worlds.boxes(4, 9, 3), 4), shown=False) as (browser, server):
        assert browser.until("!document.querySelector('#empty [data-scene=first]').disabled")
        x, y = browser.middle("#empty [data-scene=first]")
        browser.mouse([(x, y)])
        assert browser.until("document.querySelector('#scene').innerText === 'first'")


class EndlessReader:
    """Reads files without end."""

    suffixes = (".obj",)

    def __init__(self):
        self.cancelled = threading.Event()

    async def read(self, _paths, progress):
        progress("voxelize", 1, 2)
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            self.cancelled.set()
            raise


def test_an_upload_shows_its_progress_and_can_be_cancelled(tmp_path):
    (tmp_path / "cube.obj").write_text(CUBE)
    reader = EndlessReader()
    with shown_page(scene_of("first", worlds.ball(4), 4), reader=reader) as (browser, server):
        assert browser.until(RESTS)
        for _ in range(2):  # the server accepts another upload afterwards
            browser.give_files("#files", [str(tmp_path / "cube.obj")])
            assert browser.until("document.querySelector('#notice p').innerText === 'Voxelizing'")
            assert browser.run("return document.querySelector('#notice progress').value") == 0.5
            browser.mouse([browser.middle("#cancel")])
            assert browser.until("document.querySelector('#notice').hidden")
            assert reader.cancelled.wait(30)
            reader.cancelled.clear()
        assert browser.run("return document.querySelector('#scene').innerText") == "first"
        assert server.session.renderer.scene_number == 1


def test_a_slow_device_shows_coarse_pictures_first():
    scene = scene_of("first", worlds.boxes(4, 9, 3), 4)
    with shown_page(scene, device=open_rtl("lit")) as (browser, _):
        assert browser.until("document.querySelector('#rendering').innerText.startsWith('rendering, about')", 60)
        width, stage = browser.run(
            "return [document.querySelector('#picture').width, document.querySelector('#stage').clientWidth]"
        )
        assert width <= stage / 2  # a coarse picture is shown meanwhile
        seconds = browser.run("return Number(document.querySelector('#rendering').innerText.match(/[0-9]+/)[0])")
        assert 1 <= seconds <= 60


def test_the_connection_is_lost_and_restored():
    scene = scene_of("first", worlds.boxes(4, 9, 3), 4)
    away = "document.querySelector('#away h2').innerText"
    with chromium((420, 800), dark=False) as browser:
        with serving(scene) as server:
            port = server.port
            browser.open(server.url)
            assert browser.until("document.querySelector('#connection').innerText === 'exact model'")
        assert browser.until(f"{away} === 'The server does not answer'")
        with serving(scene, port) as server:
            assert browser.until("document.querySelector('#away').hidden")
            assert shows_the_view(server, browser)
            assert browser.run("return document.documentElement.scrollWidth <= innerWidth")


def test_a_wrong_token_and_a_wrong_origin_are_told_apart():
    with chromium() as browser, serving(scene_of("first", worlds.ball(4), 4), token="sesame") as server:
        away = "document.querySelector('#away h2').innerText"
        for address in (f"http://127.0.0.1:{server.port}/", f"http://127.0.0.1:{server.port}/#token=wrong"):
            browser.open(address)
            assert browser.until(f"{away} === 'The token is missing or wrong'")
            browser.open("about:blank")
        browser.open(f"http://127.0.0.1:{server.port}/")
        assert browser.until("document.querySelector('#token-form').checkVisibility()")
        browser.run("document.querySelector('#token-form input').focus()")
        for letter in "sesame":
            browser.key(letter, f"Key{letter.upper()}")
        browser.key("Enter")
        assert browser.until("document.querySelector('#scene').innerText === 'first'")
        assert browser.run("return document.querySelector('#away').hidden && location.hash === '#token=sesame'")
        browser.open(server.url.replace("127.0.0.1", "voxrt.example"))  # this name is 127.0.0.1 too
        assert browser.until(f"{away} === 'The server does not know this address'")
        text = browser.run("return document.querySelector('#away p').innerText")
        assert f"pages of http://voxrt.example:{server.port} may not connect" in text
        assert "--origin" in text


def test_a_second_viewer_follows_and_takes_control():
    with shown_page(scene_of("first", worlds.ball(4), 4)) as (browser, server):
        assert browser.until(RESTS)
        before = server.session.renderer.view
        with chromium((700, 500)) as other:
            other.open(server.url)
            assert other.until("document.querySelector('#control').innerText === 'viewer 1 has control'")
            other.mouse([(100, 200), (200, 220)])
            assert other.run("return document.querySelector('[data-scene=first]').disabled")
            assert server.session.renderer.view == before
            browser.open("about:blank")  # the first viewer leaves
            assert other.until("document.querySelector('#control').innerText === ''")
            assert shows_the_view(server, other)
