"""The memory and the time that reading a file in a process of its own may take.

A file of a few kilobytes can ask for any amount of either: by references to itself, by counts in damaged tables. The
process that reads it has a small allowance at first. Each file that it opens adds to it, in proportion to its size, so
that large scenes are read and small files cannot take the machine.

Memory is limited by ``RLIMIT_DATA``: what a process writes to, heap and stacks. ``RLIMIT_AS`` would count address
space as well, of which large libraries reserve gigabytes for their threads and map whole files. Time is limited twice:
as time of the processor, which does not depend on what else the machine does, and as time of day, for a process that
waits for ever.
"""

from __future__ import annotations

import os
import resource
import signal

import msgspec
from msgspec import Struct

from voxrt.voxelize.free_memory import free_memory

_MEMORY = 2 << 30
_LEAST_MEMORY = 256 << 20
_MEMORY_PER_BYTE = 64  # of files that the scene is made of
_SECONDS = 30.0
_SECONDS_PER_BYTE = 2e-6
_DAYTIME_FACTOR = 4


class Limits(Struct, frozen=True):
    """What a small file may take, and what no file may."""

    memory: int  # bytes that a small file may take
    most_memory: int  # bytes that no file may exceed
    seconds: float = _SECONDS  # seconds of the processor that a small file may take

    @classmethod
    def of_this_machine(cls) -> Limits:
        """Return 2 GiB for small files, half of the free memory for any, and 30 seconds."""
        most = max(free_memory() // 2, _LEAST_MEMORY)
        return cls(min(_MEMORY, most), most)


class Request(msgspec.Struct, frozen=True, kw_only=True):
    """What any reader is asked: its limits, its caller's process id, and the options that all of them have."""

    limits: Limits
    parent: int = msgspec.field(default_factory=os.getpid)
    output: int = 1  # the descriptor to which the reader writes its message
    time: float | None
    allow_outside: bool
    opaque_from: float


class Allowance:
    """The limits of this process, which grow with the files that it opens. The process ends where it exceeds them."""

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._bytes = 0
        _set(resource.RLIMIT_CORE, 0)
        self._apply()

    def add(self, size: int) -> None:
        """Allow what reading a file of `size` bytes may take."""
        self._bytes += size
        self._apply()

    def _apply(self) -> None:
        limits = self._limits
        memory = min(limits.memory + _MEMORY_PER_BYTE * self._bytes, limits.most_memory)
        seconds = limits.seconds + _SECONDS_PER_BYTE * self._bytes
        _set(resource.RLIMIT_DATA, memory)
        _set(resource.RLIMIT_CPU, max(1, int(seconds)))
        signal.setitimer(signal.ITIMER_REAL, seconds * _DAYTIME_FACTOR)  # SIGALRM ends the process


def _set(kind: int, wanted: int) -> None:
    """Set a soft limit, at most the hard one."""
    _, hard = resource.getrlimit(kind)
    soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
    resource.setrlimit(kind, (soft, hard))
