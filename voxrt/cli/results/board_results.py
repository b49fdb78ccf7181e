"""What ``voxrt serve --json`` and ``voxrt upload --json`` print."""

from __future__ import annotations

import msgspec


class ServeResult(msgspec.Struct, frozen=True):
    """``voxrt serve --json``, printed when the server listens."""

    url: str
    """The page's address, with the token where there is one."""
    urls: tuple[str, ...]
    """All of its addresses: those of this machine, its names, and loopback."""
    port: int
    legacy_port: int | None


class UploadResult(msgspec.Struct, frozen=True):
    """``voxrt upload --json``."""

    name: str
    depth: int
    words: int
    crc32: int
    """Checksum of the words as the board read them back, little-endian bytes."""
    written: bool
    """False for a dry run."""
