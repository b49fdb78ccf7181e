"""The memory of this machine that is free."""

from __future__ import annotations

import os
from pathlib import Path

_GROUP = Path("/sys/fs/cgroup")
_UNKNOWN = 4 << 30  # of systems that do not say


def free_memory() -> int:
    """Return the bytes that processes may still take: of the machine, and of the container that this process is in."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        free = next(int(line.split()[1]) << 10 for line in lines if line.startswith("MemAvailable:"))
    except (OSError, ValueError, StopIteration):  # not Linux: all of the memory
        pages = "SC_PHYS_PAGES" in getattr(os, "sysconf_names", {})
        free = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") if pages else _UNKNOWN
    try:
        most, used = (int((_GROUP / name).read_text(encoding="ascii")) for name in ("memory.max", "memory.current"))
    except (OSError, ValueError):  # no container, or one without a limit ("max")
        return free
    return min(free, max(most - used, 0))
