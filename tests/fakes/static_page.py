"""What tests do with the static page in a browser: open it, drop files, read its picture, save its files."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from fakes.browser import RESTS
from msgspec.structs import replace

from voxrt.octree.camera import Camera, Lighting
from voxrt.options.notations import BACKGROUNDS
from voxrt.sim import render
from voxrt.voxelize import EMPTY

if TYPE_CHECKING:
    from fakes.browser import Browser

    from voxrt.octree import Rom

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
REFUSES = "document.querySelector('#notice').dataset.kind === 'error' && !document.querySelector('#notice').hidden"


def shown(name: str, depth: int) -> str:
    """The page shows a scene, and its picture is complete."""
    return f"document.querySelector('#stage').dataset.scene === '{name} {depth}' && {RESTS}"


def opened(browser: Browser, fragment: str = "", name: str = "courtyard", depth: int = 7) -> None:
    """Open the page anew, and wait until it shows a scene."""
    browser.open("about:blank")
    browser.open(browser.address + fragment)
    assert browser.until(shown(name, depth)), notice(browser)


def rests(browser: Browser) -> None:
    """Wait until the picture is that of everything that was done."""
    browser.draws()
    assert browser.until(RESTS)


def show(browser: Browser, *files: Path, depth: int = 7) -> None:
    """Drop files, and wait until the page shows the first."""
    drop(browser, *files)
    assert browser.until(shown(files[0].stem, depth)), notice(browser)


def drop(browser: Browser, *files: Path) -> None:
    """Drop files on the picture."""
    browser.drop(*browser.middle("#stage"), [str(file) for file in files])


def notice(browser: Browser) -> str:
    """What the page tells, or nothing."""
    return browser.run("const n = document.querySelector('#notice'); return n.hidden ? '' : n.innerText")


def registers(camera: dict[str, list[int]]) -> Camera:
    """The camera of a frame."""
    return Camera(*(tuple(camera[part]) for part in ("position", "look", "right", "up")))


def frame_of(browser: Browser) -> tuple[dict, list[int], np.ndarray]:
    """The camera registers, the size and the colours of the newest frame that was rendered."""
    script = """
        const done = arguments[0];
        const { camera, width, height } = window.voxrt.newest;
        const colours = window.voxrt.colours();
        let text = "";
        for (let at = 0; at < colours.length; at += 1 << 14)
            text += String.fromCharCode(...colours.subarray(at, at + (1 << 14)));
        done({ camera, size: [width, height], pixels: btoa(text) });
    """
    got = browser.run_async(script)
    width, height = got["size"]
    colours = np.frombuffer(base64.b64decode(got["pixels"]), np.uint8).reshape(height, width, 3)
    return got["camera"], got["size"], colours


def on_paper(rom: Rom) -> Rom:
    """The memory with the page's background, unless it has one of its own."""
    empty = rom.materials[0]
    if empty.colour != EMPTY.colour:
        return rom
    return replace(rom, materials=(replace(empty, colour=BACKGROUNDS["light"]), *rom.materials[1:]))


def shows_exactly(browser: Browser, rom: Rom, lighting: Lighting | None = None) -> bool:
    """The newest frame is that of the exact model, run natively."""
    camera, size, colours = frame_of(browser)
    native = render(on_paper(rom), registers(camera), tuple(size), engine="model", lighting=lighting or Lighting())
    return np.array_equal(colours, native.colour)


def saved(browser: Browser, folder: Path, button: str, name: str) -> bytes:
    """Click a button and return the file that the browser saves."""
    save_to(browser, folder)
    browser.run("document.querySelector(arguments[0]).click()", button)
    return file_saved(browser, folder, name)


def save_to(browser: Browser, folder: Path) -> None:
    """Let the browser save files in a folder."""
    folder.mkdir(exist_ok=True)
    browser.cdp("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder), eventsEnabled=False)


def file_saved(browser: Browser, folder: Path, name: str) -> bytes:
    """Wait until the browser has saved a file, and return it."""
    for _ in range(1000):
        browser.draws()
        if (folder / name).exists() and not list(folder.glob("*.crdownload")):
            return (folder / name).read_bytes()
    raise AssertionError(f"{name} was not saved; there is {[path.name for path in folder.iterdir()]}")
