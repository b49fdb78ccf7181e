"""The static page on loopback, below a path, as on GitHub's pages."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, ClassVar

from fakes.site import site

if TYPE_CHECKING:
    from collections.abc import Iterator

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


@contextmanager
def serving_site() -> Iterator[str]:
    """Serve the site meanwhile; yield its address."""
    handler = partial(QuietHandler, directory=str(site()))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}{BELOW}/"
        server.shutdown()
        thread.join()
