"""Reads USD stages in the process of the tests: a process for each of hundreds of sound stages would take minutes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pxr import Sdf

from voxrt.voxelize.formats.usd.stage_scene import read_stage

if TYPE_CHECKING:
    from voxrt.voxelize import Scene


class Unlimited:
    """An allowance without end."""

    def add(self, size: int) -> None:
        """Allow a file of any size."""


def load_usd(path: Path, **options: object) -> Scene:
    """Read a stage as the process does that reads it for users."""
    # USD keeps the layers that a caught error holds. A later test may have written other content at the same path, even
    # at the same tick of the file system's clock.
    held = [layer for layer in Sdf.Layer.GetLoadedLayers() if layer.realPath and Path(layer.realPath).is_file()]
    Sdf.Layer.ReloadLayers(held, force=True)
    return read_stage(path, Unlimited(), **options)
