"""The transfer of control: one client at a time may change the view and the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

IDLE_SECONDS = 30.0
"""A controller that has sent no change for this time loses control to the client that waits for it, or asks next."""


class ControlTransfer:
    """Knows which client has control, and which clients wait for it.

    Parameters
    ----------
    clock
        Returns monotonic seconds.
    on_loss
        Called with the number of a client that has lost control.
    """

    def __init__(self, clock: Callable[[], float], on_loss: Callable[[int], None]) -> None:
        self._clock = clock
        self._on_loss = on_loss
        self._waiting: list[int] = []
        self._last_use = 0.0
        self.controller: int | None = None

    @property
    def waiting(self) -> tuple[int, ...]:
        """Numbers of the clients that wait for control, in the order of their requests."""
        return tuple(self._waiting)

    def request(self, client: int) -> bool:
        """Request control: True when `client` has it now, False when it waits for it."""
        if self.controller is None or self.controller == client or self._is_idle():
            self._transfer(client)
            return True
        if client not in self._waiting:
            self._waiting.append(client)
        return False

    def pass_on(self) -> bool:
        """Give control to the first client that waits, if the controller is idle; tell whether control has passed."""
        if not self._waiting or not self._is_idle():
            return False
        self._transfer(self._waiting[0])
        return True

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
            self._transfer(self._waiting[0] if self._waiting else None)

    def _is_idle(self) -> bool:
        return self._clock() - self._last_use > IDLE_SECONDS

    def _transfer(self, client: int | None) -> None:
        lost, self.controller = self.controller, client
        self._last_use = self._clock()
        if client in self._waiting:
            self._waiting.remove(client)
        if lost is not None and lost != client:
            self._on_loss(lost)
