"""Take the manual's pictures of the page, docs/pictures/page*.png: ``python docs/make_page_pictures.py``.

Headless Chromium shows ``voxrt serve``'s page on the exact model with the example scenes: wide and dark with the
courtyard, narrow and light with the dog. Wants Debian's chromium and chromium-driver, and a machine that does nothing
else, for the times that the page shows.
"""

from __future__ import annotations

import asyncio
import sys
import threading
from pathlib import Path

from voxrt.board.simulated.model import ModelDevice
from voxrt.boards.board_scenes import asset_reader
from voxrt.serve.scene_library import SceneLibrary
from voxrt.serve.server import FrameServer
from voxrt.serve.server_options import ServerOptions

REPOSITORY = Path(__file__).resolve().parents[1]
PICTURES = REPOSITORY / "docs" / "pictures"
EXAMPLES = ("courtyard.glb", "dog.usda", "house.obj", "planet.glb")
SCENES = {Path(name).stem: REPOSITORY / "examples" / name for name in EXAMPLES}
DEPTH = 7
SHOTS = (("page", "courtyard", (1280, 800), True), ("page-phone", "dog", (390, 844), False))

sys.path.append(str(REPOSITORY / "tests"))
from fakes.browser import chromium  # noqa: E402 - the tests' own browser


async def serve(ready: threading.Event, finished: threading.Event, address: dict[str, str]) -> None:
    """Serve until the pictures are taken."""
    scenes = {name: [path] for name, path in SCENES.items()}
    async with FrameServer(ModelDevice(), SceneLibrary(asset_reader(DEPTH), scenes), ServerOptions()) as server:
        address["url"] = server.url
        ready.set()
        await asyncio.to_thread(finished.wait)


def main() -> None:
    """Take all pictures."""
    ready, finished, address = threading.Event(), threading.Event(), {}
    serving = threading.Thread(target=lambda: asyncio.run(serve(ready, finished, address)))
    serving.start()
    ready.wait()
    try:
        for name, scene, size, dark in SHOTS:
            with chromium() as browser:
                browser.screen(*size, touch=not dark, ratio=1 if dark else 2)
                browser.theme(dark=dark)
                browser.open(address["url"])
                browser.until(f"!document.querySelector('[data-scene={scene}]').disabled")
                browser.run("document.querySelector(arguments[0]).click()", f"[data-scene={scene}]")
                browser.until(f"document.querySelector('#scene').innerText === '{scene}'")
                browser.run("document.querySelector('#frame').click()")
                browser.until("document.querySelector('#stage').ariaBusy === 'true'", 1)
                browser.until("document.querySelector('#stage').ariaBusy === 'false'")
                browser.until("document.querySelector('#figures').textContent.includes('idle')", 5)
                (PICTURES / f"{name}.png").write_bytes(browser.screenshot())
    finally:
        finished.set()
        serving.join()


if __name__ == "__main__":
    main()
