"""What ``voxrt serve --json``, ``voxrt upload --json`` and ``voxrt board --json`` print."""

from __future__ import annotations

from typing import Literal

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


class FindingEntry(msgspec.Struct, frozen=True):
    """What one part of a self-test found."""

    part: str
    state: Literal["passed", "failed", "open"]
    """open: a person must look, or press."""
    text: str


class CheckResult(msgspec.Struct, frozen=True):
    """``voxrt board check --json``."""

    device: str
    findings: tuple[FindingEntry, ...]


class ViewEntry(msgspec.Struct, frozen=True):
    """A view, as the board and as the exact model draw it."""

    size: tuple[int, int]
    equal: bool
    crc32: int | None
    """Checksum of the board's frame; null where the design is too old to have it, and counters alone are compared."""
    expected_crc32: int
    hits: int
    expected_hits: int


class ReportResult(msgspec.Struct, frozen=True):
    """``voxrt board report --json``."""

    device: str
    version: str
    clock_hz: int | None
    capacity: int
    """Words of its octree memory."""
    depth: int
    features: tuple[str, ...]
    scene: str
    words: int
    crc32: int
    """Checksum of the scene's words, as they were read from the board."""
    views: tuple[ViewEntry, ...]
    registers: dict[str, int]
    software: str
