"""A rate limiter: a token bucket."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


class RateLimiter:
    """Permits `rate` events per second on average, and a burst.

    Parameters
    ----------
    rate
        Events per second.
    clock
        Returns monotonic seconds.
    burst
        Events at once; None for twice as many as `rate`.
    """

    def __init__(self, rate: float, clock: Callable[[], float], burst: float | None = None) -> None:
        self._rate = rate
        self._clock = clock
        self._burst = self._permits = 2 * rate if burst is None else burst
        self._refilled = clock()

    @property
    def rested(self) -> bool:
        """Whether nothing has been permitted for so long that a whole burst is permitted again."""
        self._refill()
        return self._permits >= self._burst

    def acquire(self) -> bool:
        """Permit one event, or tell that it is too early."""
        self._refill()
        if self._permits < 1:
            return False
        self._permits -= 1
        return True

    def charge(self, events: float) -> float:
        """Count events that have happened; return the seconds until the next ones are permitted."""
        self._refill()
        self._permits -= events
        return max(0.0, -self._permits / self._rate)

    def _refill(self) -> None:
        now = self._clock()
        self._permits = min(self._burst, self._permits + (now - self._refilled) * self._rate)
        self._refilled = now
