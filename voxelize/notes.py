"""Counting what a file said and was not honoured as it stands."""

from __future__ import annotations

from voxrt.voxelize.errors import SceneWarning


class Notes:
    """A loader's warnings, one an (kind, message) pair, in order of first appearance."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str], int] = {}

    def add(self, kind: str, message: str, count: int = 1) -> None:
        """Count `count` more cases of `kind`; none when `count` is 0."""
        if count:
            self._counts[kind, message] = self._counts.get((kind, message), 0) + count

    def warnings(self) -> tuple[SceneWarning, ...]:
        """Everything counted so far."""
        return tuple(SceneWarning(kind, message, count) for (kind, message), count in self._counts.items())
