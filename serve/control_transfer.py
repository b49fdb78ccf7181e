"""The transfer of control: one client at a time may change the view and the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

IDLE_SECONDS = 30.0
"""A controller that has sent no change for this time loses control to the next client that asks for it."""


class ControlTransfer:
    """Knows which client has control, and which clients wait for it.

    Parameters
    ----------
    clock
        Returns monotonic seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._waiting: list[int] = []
        self._last_use = 0.0
        self.controller: int | None = None

    @property
    def waiting(self) -> tuple[int, ...]:
        """Numbers of the clients that wait for control, in the order of their requests."""
        return tuple(self._waiting)

    def request(self, client: int) -> bool:
        """Request control: True when `client` has it now, False when it waits for it."""
        idle = self._clock() - self._last_use > IDLE_SECONDS
        if self.controller is None or self.controller == client or idle:
            self._transfer(client)
            return True
        if client not in self._waiting:
            self._waiting.append(client)
        return False

    def use(self, client: int) -> bool:
        """Tell whether `client` has control; if so, its idle time starts again."""
        if self.controller != client:
            return False
        self._last_use = self._clock()
        return True

    def release(self, client: int) -> None:
        """Release control, or stop waiting for it; the first client that waits gets it."""
        if client in self._waiting:
            self._waiting.remove(client)
        if self.controller == client:
            self.controller = None
            if self._waiting:
                self._transfer(self._waiting[0])

    def _transfer(self, client: int) -> None:
        if client in self._waiting:
            self._waiting.remove(client)
        self.controller = client
        self._last_use = self._clock()
