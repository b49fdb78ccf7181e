from __future__ import annotations

import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import ClassVar

import pytest
from fakes.browser import Browser, chromium
from fakes.site import site

BELOW = "/voxrt/try"


class QuietHandler(SimpleHTTPRequestHandler):
    """Python's own file server, which lists what was asked for instead of printing it."""

    paths: ClassVar[list[str]] = []

    def log_message(self, *_: object) -> None:
        self.paths.append(self.path)

    def translate_path(self, path: str) -> str:
        return super().translate_path(path.removeprefix(BELOW))

    def end_headers(self) -> None:
        self.send_header("Cache-Control", "no-store")  # a test sees each path that its page asks for
        super().end_headers()


@pytest.fixture(scope="session")
def address():
    """Where the site is served: below a path, as on GitHub's pages, from loopback."""
    handler = partial(QuietHandler, directory=str(site()))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}{BELOW}/"
        server.shutdown()


@pytest.fixture
def paths():
    """The paths that the page asks for, from the start of the test."""
    QuietHandler.paths.clear()
    return QuietHandler.paths


@pytest.fixture(scope="module")
def opened_browser(address: str):
    with chromium() as one:
        one.address = address
        yield one


@pytest.fixture
def browser(opened_browser: Browser):
    """The browser of the module; the page must say nothing severe on its console."""
    yield opened_browser
    assert opened_browser.faults() == []
