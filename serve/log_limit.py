"""A limit on what is logged, so that no peer can fill a disk."""

from __future__ import annotations

import logging
import time

from voxrt.serve.rate_limiter import RateLimiter

_PER_SECOND = 0.1
_BURST = 5


class LogLimit(logging.Filter):
    """Passes a few records, and then one in ten seconds."""

    def __init__(self) -> None:
        super().__init__()
        self._limiter = RateLimiter(_PER_SECOND, time.monotonic, _BURST)
        self._left_out = 0

    def filter(self, record: logging.LogRecord) -> bool:
        """Tell whether a record is logged; it says how many were not."""
        if not self._limiter.acquire():
            self._left_out += 1
            return False
        if self._left_out:
            record.msg = f"{record.msg} ({self._left_out} further records were left out)"
            self._left_out = 0
        return True
