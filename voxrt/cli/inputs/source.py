"""What a command looks at: a memory, or an asset that is built on the way."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import asdict

import voxrt
from voxrt.cli.terminal.messages import warn
from voxrt.cli.terminal.progress import build_bar
from voxrt.export import READABLE_SUFFIXES
from voxrt.octree.camera import refit
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.options.view_options import CameraOptions
from voxrt.views.viewpoint import authored_camera
from voxrt.voxelize.assets import SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from voxrt.export import Blob
    from voxrt.octree import Rom


class Source(Struct, frozen=True):
    """A memory and where it came from."""

    blob: Blob  # the memory, with the camera and the light that its file or its scene names
    scene: voxrt.Scene | None = None  # that it was built from; None for a memory from a file
    warnings: tuple[voxrt.SceneWarning, ...] = ()  # they have been printed

    @property
    def rom(self) -> Rom:
        """The memory."""
        return self.blob.rom

    def camera(self, size: tuple[int, int], sight: CameraOptions | None = None) -> voxrt.Camera:
        """Give the camera of the scene's preview, or the one that is asked for."""
        if sight is not None and sight != CameraOptions():
            return voxrt.aim_camera(self.rom, size, **asdict(sight))
        if self.blob.view is not None:
            if self.scene is not None and self.scene.viewpoint and self.rom.grid:
                return authored_camera(self.scene.viewpoint, self.rom.grid, size)
            return refit(self.blob.view, PREVIEW_SIZE, size)
        if self.blob.animation is not None:
            return voxrt.animation_camera(self.blob, size)
        return voxrt.aim_camera(self.rom, size)


def is_asset(path: Path) -> bool:
    """Tell whether a file must be built first: files of voxels are read as they are."""
    suffix = path.suffix.lower()
    return suffix in SUFFIXES and suffix not in READABLE_SUFFIXES


def read_source(
    path: Path,
    depth: int | None = None,
    dialect: str | None = None,
    colours: Mapping[str, tuple[int, int, int]] | None = None,
    *,
    frames: bool = False,
) -> Source:
    """Read a memory of any format, or build an asset in memory; warns of what was not honoured.

    `frames`: the command uses all frames of an animation, and not the first alone.
    """
    if is_asset(path):
        with build_bar() as bar:
            result = voxrt.build(path, depth=depth, progress=bar.begin, estimated=bar.estimate)
        warn(result.warnings)
        return Source(result.blob, result.scene, result.warnings)
    blob, warnings = voxrt.read_any(path, depth=depth, dialect=dialect, colours=colours)
    if blob.animation is not None and not frames:
        count = len(blob.animation.frames)
        warnings += (voxrt.SceneWarning("frames", f"{path.name} has {count} frames, and the first is used"),)
    warn(warnings)
    return Source(blob, warnings=warnings)
