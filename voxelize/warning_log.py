"""A loader's warnings, counted while it reads."""

from __future__ import annotations

from voxrt.voxelize.errors import SceneWarning


class WarningLog:
    """Warnings in order of first appearance; equal ones are counted."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str], int] = {}

    def add(self, kind: str, message: str, count: int = 1) -> None:
        """Count `count` more cases of a warning; none when `count` is 0."""
        if count:
            self._counts[kind, message] = self._counts.get((kind, message), 0) + count

    def warnings(self) -> tuple[SceneWarning, ...]:
        """Return the warnings so far."""
        return tuple(SceneWarning(kind, message, count) for (kind, message), count in self._counts.items())
