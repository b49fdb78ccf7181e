"""A rate limiter: a token bucket."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


class RateLimiter:
    """Permits `rate` events per second on average, and a burst of twice as many.

    Parameters
    ----------
    rate
        Events per second.
    clock
        Returns monotonic seconds.
    """

    def __init__(self, rate: float, clock: Callable[[], float]) -> None:
        self._rate = rate
        self._clock = clock
        self._permits = 2 * rate
        self._refilled = clock()

    def acquire(self) -> float:
        """Permit one event: return 0, or the seconds until the next event is permitted."""
        now = self._clock()
        self._permits = min(2 * self._rate, self._permits + (now - self._refilled) * self._rate)
        self._refilled = now
        if self._permits < 1:
            return (1 - self._permits) / self._rate
        self._permits -= 1
        return 0.0
