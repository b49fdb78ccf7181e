"""The external memory of a ray tracer whose octree is behind caches, and what a frame has cost there."""

from __future__ import annotations

from voxrt.voxelize.value import Value

LINE_BYTES = 32
"""Bytes of a line, which is a block of eight words."""

_CLOCK_LIMIT = 1_000_000


class Dram(Value, frozen=True):
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


class CacheCost(Value, frozen=True):
    """What a frame cost at the caches; they are empty when it starts.

    Attributes
    ----------
    words_read
        Octree words that lanes read.
    word_requests
        How often lanes asked for a word: once for each word they read, and again for each time it had not come.
    line_requests
        How often the caches of lanes asked the shared cache for a line.
    lines_read
        Lines that the shared cache asked the external memory for.

    Examples
    --------
    >>> cost = CacheCost(words_read=1000, word_requests=1100, line_requests=100, lines_read=20)
    >>> cost.l1_hits, cost.l2_hits, cost.bytes_read
    (0.9, 0.8, 640)
    """

    words_read: int
    word_requests: int
    line_requests: int
    lines_read: int

    @property
    def l1_hits(self) -> float:
        """Part of the words that needed no request of a line, 0 … 1."""
        return 1 - self.line_requests / max(self.words_read, 1)

    @property
    def l2_hits(self) -> float:
        """Part of the requests of lines that needed no line of the external memory, 0 … 1."""
        return 1 - self.lines_read / max(self.line_requests, 1)

    @property
    def bytes_read(self) -> int:
        """Bytes from the external memory."""
        return LINE_BYTES * self.lines_read

    def __add__(self, other: CacheCost) -> CacheCost:
        """Give the cost of two frames."""
        return CacheCost(
            self.words_read + other.words_read,
            self.word_requests + other.word_requests,
            self.line_requests + other.line_requests,
            self.lines_read + other.lines_read,
        )
