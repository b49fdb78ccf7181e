"""The page in headless Chromium, with a frame server and the exact model."""

from __future__ import annotations

import asyncio
import threading
from contextlib import contextmanager

import numpy as np
from fakes.browser import chromium
from fakes.scene_reader import ReadyScenes
from oracles import worlds
from oracles.cuts import memory_of

from voxrt.board.simulated.model import ModelDevice
from voxrt.board_scenes import asset_reader, board_scene
from voxrt.export import Blob, write_rom
from voxrt.octree import Octree, Rom
from voxrt.serve.scene_library import SceneLibrary
from voxrt.serve.server import FrameServer
from voxrt.serve.server_options import ServerOptions
from voxrt.sim import look_at, pixel_directions
from voxrt.voxelize import Material

PIXELS = """
const canvas = document.querySelector("#picture");
const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
return [canvas.width, canvas.height, Array.from(data.filter((_, i) => i % 4 < 3))];
"""


def rom_of(name, world, depth):
    colours = np.random.default_rng(5).integers(90, 256, (256, 3)).tolist()
    return Rom(name, Octree(depth, memory_of(world)), tuple(Material(f"m{i}", tuple(c)) for i, c in enumerate(colours)))


@contextmanager
def serving(scene, port=0):
    """A server in a thread of its own."""
    ready, loop = threading.Event(), asyncio.new_event_loop()
    kept = {}

    async def serve():
        kept["stop"] = asyncio.Event()
        own = ReadyScenes(**{scene.name: scene})
        library = SceneLibrary(asset_reader(depth=4), own.files, own)
        async with FrameServer(ModelDevice(), library, ServerOptions(port=port)) as server:
            await server.session.renderer.load(scene, lambda *_: None)
            kept["server"] = server
            ready.set()
            await kept["stop"].wait()
            ready.clear()

    thread = threading.Thread(target=lambda: loop.run_until_complete(serve()))
    thread.start()
    assert ready.wait(30)
    try:
        yield kept["server"]
    finally:
        loop.call_soon_threadsafe(kept["stop"].set)
        thread.join(30)
        loop.close()


def picture(browser):
    width, height, data = browser.run(PIXELS)
    return np.array(data, dtype=np.uint8).reshape(height, width, 3)


def shown(server, browser):
    """Whether the canvas shows exactly the frame that the model renders for the view of the server."""
    view, scene = server.session.renderer.view, server.session.renderer.scene
    device = ModelDevice()
    device.write_memory(0, scene.words)
    device.write_materials(scene.colours, scene.mirrors)
    device.select_scene(0, scene.depth)
    expected = device.frame(view).colour
    return any(np.array_equal(picture(browser), expected) for _ in range(20))


def test_page(tmp_path):
    first = board_scene(Blob(rom_of("first", worlds.boxes(4, 9, 3), 4)))
    idle = "document.querySelector('#overlay').innerText.includes('idle')"
    with chromium() as browser, serving(first) as server:
        browser.open(server.url)
        assert browser.until("document.querySelector('#control').innerText === 'you have control'")
        assert browser.until(idle)
        assert shown(server, browser)
        before = server.session.renderer.view.camera

        # Turning the camera turns look, right and up: right-handed, orthogonal, at the largest scale.
        browser.run("document.querySelector('#picture').focus()")
        browser.keys(["\ue012"], 0.3)  # left arrow
        browser.keys(["w"], 0.3)
        assert browser.until(idle)
        camera = server.session.renderer.view.camera
        assert camera != before
        look, right, up = (np.array(triple, dtype=float) for triple in (camera.look, camera.right, camera.up))
        cosines = [a @ b / np.linalg.norm(a) / np.linalg.norm(b) for a, b in ((look, right), (look, up), (right, up))]
        assert np.abs(cosines).max() < 0.03
        assert np.cross(look, up) @ right > 0
        eye = np.array(camera.position) / 16
        best = look_at(eye, eye + look, size=(640, 480))
        assert (
            np.abs(pixel_directions(best, (640, 480))).max() < 1.02 * np.abs(pixel_directions(camera, (640, 480))).max()
        )
        assert shown(server, browser)

        # A memory and a mesh, by the file dialogue; dropped files take the same way.
        files = write_rom(tmp_path, rom_of("second", worlds.ball(4), 4))
        browser.give_files("#files", [str(files.mem), str(files.manifest)])
        assert browser.until("document.querySelector('#scene').innerText.startsWith('second')")
        (tmp_path / "cube.obj").write_text(
            "".join(f"v {i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8))
            + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
        )
        browser.give_files("#files", [str(tmp_path / "cube.obj")])
        assert browser.until("document.querySelector('#scene').innerText.startsWith('cube')")
        (tmp_path / "cube.obj").write_text("f 1 2 3\n")
        browser.give_files("#files", [str(tmp_path / "cube.obj")])
        assert browser.until("document.querySelector('#notice').innerText.includes('was not loaded')")
        browser.run("document.querySelector('#notice button').click()")

        # Controls of the panel: flat colours, background, flip, a preset.
        for selector in ("[data-shading=flat]", "#flip-x", "#presets button:nth-child(2)", "[data-scene=first]"):
            browser.run("document.querySelector(arguments[0]).click()", selector)
        assert browser.until("document.querySelector('#scene').innerText.startsWith('first')")
        browser.run(
            "const c = document.querySelector('#background'); c.value = '#204060'; c.dispatchEvent(new Event('input'))"
        )
        assert browser.until(idle)
        assert server.session.renderer.view.background == (0x20, 0x40, 0x60)
        assert server.session.renderer.view.lighting.shading == "flat"
        assert shown(server, browser)
        assert browser.faults() == []


def test_the_connection_is_lost_and_restored():
    scene = board_scene(Blob(rom_of("first", worlds.boxes(4, 9, 3), 4)))
    with chromium((420, 800), dark=False) as browser:
        with serving(scene) as server:
            port = server.port
            browser.open(server.url)
            assert browser.until("document.querySelector('#connection').innerText === 'connected'")
        assert browser.until("document.querySelector('#notice').innerText.includes('Not connected to the board')")
        with serving(scene, port):
            assert browser.until("document.querySelector('#control').innerText === 'you have control'")
            assert browser.run("return document.querySelector('#notice').hidden")
            assert browser.run("return document.documentElement.scrollWidth <= innerWidth")
