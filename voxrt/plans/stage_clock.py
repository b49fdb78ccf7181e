"""The stages of a build and the seconds that each takes."""

from __future__ import annotations

from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class StageClock:
    """The stages of a build and the seconds that each took, without those of a stage within it.

    `progress` is called with the name of each stage as it begins for the first time.

    Examples
    --------
    >>> clock = StageClock(print)
    >>> with clock.stage("load"):
    ...     pass
    load
    >>> list(clock.seconds)
    ['load']
    """

    def __init__(self, progress: Callable[[str], None] | None) -> None:
        self._progress = progress
        self._begun: set[str] = set()
        self._within = 0.0  # seconds of the stages within the present one
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Count the seconds of the block; a stage that comes again adds to its seconds."""
        if self._progress is not None and name not in self._begun:
            self._progress(name)
        self._begun.add(name)
        beside, self._within = self._within, 0.0
        start = perf_counter()
        yield
        took = perf_counter() - start
        self.seconds[name] = self.seconds.get(name, 0.0) + took - self._within
        self._within = beside + took
