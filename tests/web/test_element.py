"""The custom element of the npm package, on a page of somebody else, as the manual shows it."""

from __future__ import annotations

import re
import shutil
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING

import pytest
from fakes.browser import Browser, chromium
from fakes.site import ROOT, site

import voxrt
from voxrt.export import write_rom

if TYPE_CHECKING:
    from pathlib import Path

ELEMENT = "document.querySelector('voxrt-view')"
CANVAS = f"{ELEMENT}.shadowRoot.querySelector('canvas')"
RESTS = f"{ELEMENT}.getAttribute('aria-busy') === 'false'"
SAYS = f"{ELEMENT}.shadowRoot.querySelector('p').textContent"


class QuietHandler(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Print nothing."""


@pytest.fixture(scope="module")
def browser():
    with chromium() as one:
        yield one


@pytest.fixture
def address(tmp_path: Path):
    """A server with a memory, the file of the package, and the page of the manual."""
    site()
    shutil.copyfile(ROOT / "build" / "web" / "package" / "voxrt-view.js", tmp_path / "voxrt-view.js")
    write_rom(tmp_path, voxrt.build(ROOT / "examples" / "house.obj", depth=6).rom, stem="world")
    manual = (ROOT / "docs" / "embedding.md").read_text(encoding="utf-8")
    (page,) = re.findall(r"```html\n(<!doctype.*?)```", manual, re.DOTALL)
    (tmp_path / "index.html").write_text(page)
    (tmp_path / "blank.html").write_text('<!doctype html><script type="module" src="voxrt-view.js"></script>')
    (tmp_path / "favicon.ico").touch()
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(QuietHandler, directory=str(tmp_path))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


def test_the_page_of_the_manual_shows_a_memory(browser: Browser, address: str) -> None:
    browser.open(address)
    assert browser.until(RESTS), browser.run(f"return {SAYS}")
    label = browser.run(f"return {CANVAS}.getAttribute('aria-label')")
    assert label.startswith("world")
    first = browser.run(f"return {CANVAS}.toDataURL()")
    browser.mouse([(200, 200), (260, 220)])
    browser.draws()
    assert browser.until(RESTS)
    assert browser.run(f"return {CANVAS}.toDataURL()") != first
    assert browser.faults() == []


def test_another_memory_takes_its_place(browser: Browser, address: str, tmp_path: Path) -> None:
    write_rom(tmp_path, voxrt.build(ROOT / "examples" / "planet.glb", depth=5).rom, stem="other")
    browser.open(address)
    assert browser.until(RESTS)
    browser.run(f"{ELEMENT}.setAttribute('src', 'other.mem')")
    assert browser.until(f"{CANVAS}.getAttribute('aria-label').startsWith('other') && {RESTS}")
    browser.run(f"{ELEMENT}.remove()")
    assert browser.faults() == []


MOVED = """
    window.workers = new Set();
    window.Worker = class extends Worker {
        constructor(...how) { super(...how); window.workers.add(this); }
        terminate() { window.workers.delete(this); super.terminate(); }
    };
    const element = Object.assign(document.createElement("voxrt-view"), { style: "width: 320px" });
    element.setAttribute("src", "world.mem?version=2");
    document.body.append(element);
    document.body.appendChild(document.createElement("div")).append(element);
"""


def test_an_element_that_is_moved_while_it_loads_shows_one_memory(browser: Browser, address: str) -> None:
    """No worker remains of what it left; an address with a query has its manifest, with the query, beside it."""
    browser.open("about:blank")
    browser.open(f"{address}blank.html")
    browser.run(MOVED)
    assert browser.until(RESTS), browser.run(f"return {SAYS}")
    assert browser.run(f"return {CANVAS}.getAttribute('aria-label')").startswith("world.")
    browser.run(f"{ELEMENT}.remove()")
    assert browser.until("window.workers.size === 0")
    assert browser.faults() == []


def test_a_memory_that_is_not_there_is_named(browser: Browser, address: str) -> None:
    browser.open(address)
    browser.run(f"{ELEMENT}.setAttribute('src', 'none.mem')")
    assert browser.until(f"{SAYS}.includes('none.mem: the server answers 404')")
    browser.faults()
