"""The external memory of a ray tracer whose octree is behind caches, and what a frame has cost there."""

from __future__ import annotations

from dataclasses import dataclass

LINE_BYTES = 32
"""Bytes of a line, which is a block of eight words."""

_CLOCK_LIMIT = 1_000_000


@dataclass(frozen=True, slots=True)
class Dram:
    """How fast an external memory is, in clocks of the ray tracer.

    Attributes
    ----------
    latency
        From the address of a line to the first of its four beats, 0 … 1000000. After 65536 clocks without an answer the
        ray tracer gives the frame up.
    interval
        At least so many from one line to the next, 1 … 1000000.
    jitter
        Up to so many more for each line, at random, 0 … 1000000.
    seed
        Of what is random: jitter, and when the memory takes no address. 0: neither.

    Raises
    ------
    ValueError
        A number is out of range.

    Examples
    --------
    >>> Dram(latency=80).interval
    3
    """

    latency: int = 50
    interval: int = 3
    jitter: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        """Check the ranges."""
        for name, low, high in (
            ("latency", 0, _CLOCK_LIMIT),
            ("interval", 1, _CLOCK_LIMIT),
            ("jitter", 0, _CLOCK_LIMIT),
            ("seed", 0, (1 << 32) - 1),
        ):
            if not low <= getattr(self, name) <= high:
                raise ValueError(f"{name} {getattr(self, name)} is not {low} … {high}")


@dataclass(frozen=True, slots=True)
class CacheCost:
    """What a frame cost at the caches; they are empty when it starts.

    Attributes
    ----------
    word_requests
        How often lanes asked for a word: once for each word they read, and again for each time it had not come.
    line_requests
        How often the caches of lanes asked the shared cache for a line.
    lines_read
        Lines that the shared cache asked the external memory for.
    l1_hits
        Part of the words that needed no request of a line, 0 … 1.
    l2_hits
        Part of the requests of lines that needed no line of the external memory, 0 … 1.

    Examples
    --------
    >>> CacheCost.of(words_read=1000, word_requests=1100, line_requests=100, lines_read=20).l2_hits
    0.8
    """

    word_requests: int
    line_requests: int
    lines_read: int
    l1_hits: float
    l2_hits: float

    @property
    def bytes_read(self) -> int:
        """Bytes from the external memory."""
        return LINE_BYTES * self.lines_read

    @classmethod
    def of(cls, words_read: int, word_requests: int, line_requests: int, lines_read: int) -> CacheCost:
        """Make it of what the ray tracer counts.

        Examples
        --------
        >>> CacheCost.of(words_read=0, word_requests=0, line_requests=0, lines_read=0).l1_hits
        1.0
        """
        return cls(
            word_requests,
            line_requests,
            lines_read,
            1 - line_requests / max(words_read, 1),
            1 - lines_read / max(line_requests, 1),
        )
