"""Dropping a frame that nobody waits for any more."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


class FrameDrop:
    """Drops the one frame that it is given to, from any thread, before the frame begins or while it is rendered.

    Examples
    --------
    >>> drop = FrameDrop()
    >>> drop.call_when_requested(lambda: print("end the frame"))
    >>> drop.request()
    end the frame
    >>> drop.requested
    True
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._calls: list[Callable[[], None]] = []
        self.requested = False

    def request(self) -> None:
        """End the frame; a frame that is complete stays."""
        with self._lock:
            self.requested = True
            calls, self._calls = self._calls, []
        for call in calls:
            call()

    def call_when_requested(self, call: Callable[[], None]) -> None:
        """Call a function once the frame is to end; at once where that was requested before."""
        with self._lock:
            if not self.requested:
                self._calls.append(call)
                return
        call()
