"""What a command looks at: a memory, or an asset that is built on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import voxrt
from voxrt.build_options import PREVIEW_SIZE
from voxrt.cli.arguments import Sight
from voxrt.cli.messages import warn
from voxrt.octree.camera import refit
from voxrt.viewpoint import authored_camera
from voxrt.voxelize.assets import SUFFIXES

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.octree import Rom


@dataclass(frozen=True)
class Source:
    """A memory and where it came from: the camera that its file names, and the scene it was built from, if any."""

    rom: Rom
    view: voxrt.Camera | None = None
    scene: voxrt.Scene | None = None

    def camera(self, size: tuple[int, int], sight: Sight) -> voxrt.Camera:
        """Give the camera of the scene's preview, or the one that is asked for."""
        if self.view and self.scene is not None and self.scene.viewpoint and self.rom.grid and sight == Sight():
            return authored_camera(self.scene.viewpoint, self.rom.grid, size)
        return aim(self.rom, self.view, size, sight)


def read_source(path: Path, depth: int | None) -> Source:
    """Read a memory of any format, or build an asset; warns of what was not honoured."""
    if path.suffix.lower() in SUFFIXES:
        result = voxrt.build(path, depth=depth)
        warn(result.warnings)
        return Source(result.rom, result.view, result.scene)
    blob, warnings = voxrt.read_any(path, depth=depth)
    warn(warnings)
    return Source(blob.rom, view=blob.view)


def aim(rom: Rom, view: voxrt.Camera | None, size: tuple[int, int], sight: Sight) -> voxrt.Camera:
    """Give the camera that a memory's file names, unless another is asked for."""
    if view is not None and sight == Sight():
        return refit(view, PREVIEW_SIZE, size)
    return voxrt.aim_camera(rom, size, position=sight.position, look=sight.look, right=sight.right, up=sight.up)
