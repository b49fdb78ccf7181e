"""How long this process has been running: what a user waits for before the first stage begins."""

from __future__ import annotations

import os
import time

_LOADED = time.perf_counter()


def process_age() -> float:
    """Return the wall seconds since this process was started, to 0.01 s; less where the system does not tell."""
    try:
        with open("/proc/self/stat", "rb") as file:  # noqa: PTH123 - no path to speak of
            ticks = int(file.read().rpartition(b")")[2].split()[19])  # proc(5): starttime, the 22nd field
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK"))
    except (OSError, AttributeError, ValueError, IndexError):
        return time.perf_counter() - _LOADED
