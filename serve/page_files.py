"""The files of the browser page."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import voxrt.octree
from voxrt.voxelize.value import Value

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}
HEADERS = (
    ("Cache-Control", "no-cache"),
    ("X-Content-Type-Options", "nosniff"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    (
        "Content-Security-Policy",
        (
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
            "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        ),
    ),
)
"""HTTP headers of every file: the page loads nothing from elsewhere, and no other page may embed it."""


class PageFile(Value, frozen=True):
    """The bytes of a file and its media type."""

    data: bytes
    media_type: str


@cache
def load_page_files() -> dict[str, PageFile]:
    """Return the files of the page by their path in URLs; they are read once."""
    folder = Path(__file__).with_name("page")
    files = {
        f"/{path.name}": PageFile(path.read_bytes(), _TYPES[path.suffix])
        for path in sorted(folder.iterdir())
        if path.suffix in _TYPES
    }
    words = Path(voxrt.octree.__file__).with_name("words.js")
    files["/voxrt/words.js"] = PageFile(words.read_bytes(), _TYPES[".js"])
    return {"/": files["/index.html"], **files}
