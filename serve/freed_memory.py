"""What becomes of memory that the process frees."""

from __future__ import annotations

import ctypes
import sys
from contextlib import suppress
from typing import Final

_M_MMAP_THRESHOLD: Final = -3  # malloc.h of glibc
_LARGE: Final = 1 << 20  # bytes


def return_freed_memory() -> None:
    """Have the C library return large arrays to the system as soon as they are freed.

    glibc maps large blocks on their own, and unmaps them. But only those are large that exceed the largest one that was
    freed before, up to 32 MiB. So a server whose scenes are edited keeps 40 MB. From here on, blocks of 1 MiB are
    large. Where there is another C library, nothing changes.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, _LARGE)
