"""A frame server in a thread of its own, for tests of the page."""

from __future__ import annotations

import asyncio
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
from fakes.browser import chromium
from fakes.frame_server import served
from oracles.cuts import memory_of

from voxrt.board.simulated.model import ModelDevice
from voxrt.boards.board_scenes import asset_reader, board_scene
from voxrt.export import Blob
from voxrt.octree import Octree, Rom
from voxrt.voxelize import Material

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fakes.browser import Browser
    from numpy.typing import NDArray

    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.serve.scene_process import SceneReader
    from voxrt.serve.server import FrameServer


def rom_of(name: str, world: NDArray[np.uint8], depth: int) -> Rom:
    """A memory of dense voxels, in bright colours."""
    colours = np.random.default_rng(5).integers(90, 256, (256, 3)).tolist()
    return Rom(name, Octree(depth, memory_of(world)), tuple(Material(f"m{i}", tuple(c)) for i, c in enumerate(colours)))


def scene_of(name: str, world: NDArray[np.uint8], depth: int) -> Scene:
    return board_scene(Blob(rom_of(name, world, depth)))


@contextmanager
def serving(
    scene: Scene,
    port: int = 0,
    *,
    device: Device | None = None,
    token: str | None = None,
    shown: bool = True,
    reader: SceneReader | None = None,
) -> Iterator[FrameServer]:
    """Serve a scene; with `shown` it is loaded at once, else the page lists it. `reader` reads uploads."""
    ready, loop = threading.Event(), asyncio.new_event_loop()
    kept = {}

    async def serve() -> None:
        kept["stop"] = asyncio.Event()
        loaded, files = scene if shown else None, reader or asset_reader(depth=4)
        async with served(
            device or ModelDevice(), loaded, {scene.name: scene}, files, port=port, token=token
        ) as server:
            kept["server"] = server
            ready.set()
            await kept["stop"].wait()

    thread = threading.Thread(target=lambda: loop.run_until_complete(serve()))
    thread.start()
    assert ready.wait(60)
    try:
        yield kept["server"]
    finally:
        loop.call_soon_threadsafe(kept["stop"].set)
        thread.join(30)
        loop.close()


@contextmanager
def shown_page(scene: Scene, **options: Any) -> Iterator[tuple[Browser, FrameServer]]:
    """A browser that shows the page of a server of its own."""
    with chromium() as browser, serving(scene, **options) as server:
        browser.open(server.url)
        yield browser, server
