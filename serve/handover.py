"""Who steers: one viewer at a time, and how it passes to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

IDLE_SECONDS = 30.0
"""A controller that has asked for nothing this long gives way to whoever asks."""


class Handover:
    """The right to steer, held by at most one viewer; others wait in the order they asked.

    Parameters
    ----------
    clock
        Monotonic seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._waiting: list[int] = []
        self._last_use = 0.0
        self.controller: int | None = None

    @property
    def waiting(self) -> tuple[int, ...]:
        """Viewers that asked for the right and have not got it, first come first."""
        return tuple(self._waiting)

    def take(self, viewer: int) -> bool:
        """Ask for the right: True when `viewer` has it now, False when it waits for it."""
        idle = self._clock() - self._last_use > IDLE_SECONDS
        if self.controller is None or self.controller == viewer or idle:
            self._give(viewer)
            return True
        if viewer not in self._waiting:
            self._waiting.append(viewer)
        return False

    def use(self, viewer: int) -> bool:
        """Tell whether `viewer` may steer, and note that it does."""
        if self.controller != viewer:
            return False
        self._last_use = self._clock()
        return True

    def leave(self, viewer: int) -> None:
        """Give the right up, or the place in the queue; the first who waits gets it."""
        if viewer in self._waiting:
            self._waiting.remove(viewer)
        if self.controller == viewer:
            self.controller = None
            if self._waiting:
                self._give(self._waiting[0])

    def _give(self, viewer: int) -> None:
        if viewer in self._waiting:
            self._waiting.remove(viewer)
        self.controller = viewer
        self._last_use = self._clock()
