"""Reads USD stages in the process of the tests: a process for each of hundreds of sound stages would take minutes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.formats.usd.stage_scene import read_stage

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.voxelize import Scene


class Unlimited:
    """An allowance without end."""

    def add(self, size: int) -> None:
        """Allow a file of any size."""


def load_usd(path: Path, **options: object) -> Scene:
    """Read a stage as the process does that reads it for users."""
    return read_stage(path, Unlimited(), **options)
