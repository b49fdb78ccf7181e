"""What a process that reads a USD file is told."""

from __future__ import annotations

import msgspec


class Request(msgspec.Struct, frozen=True, kw_only=True):
    """The options and limits of ``read_isolated``, and the process id of its caller."""

    parent: int
    variants: tuple[str, ...]
    time: float | None
    allow_outside: bool
    memory: int
    most_memory: int
    seconds: float
