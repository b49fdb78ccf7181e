"""Scenes for the frame server: memories as a board takes them, and meshes built on the way."""

from __future__ import annotations

import tempfile
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

import numpy as np

from voxrt import voxelize
from voxrt.board.errors import Refused
from voxrt.board.scene import Scene
from voxrt.build_options import PREVIEW_SIZE
from voxrt.export import Blob, read_any
from voxrt.octree import RomError
from voxrt.pipeline import build
from voxrt.serve.blob import read_blob
from voxrt.sim import frame_scene
from voxrt.voxelize.assets import SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from voxrt.board.scene_memory import Progress

_STAGES = ("load", "fit", "tint", "voxelize", "octree")


def board_scene(blob: Blob) -> Scene:
    """Give a memory as a board takes it, seen as its author wants, or whole."""
    rom = blob.rom
    colours, mirrors = np.zeros((256, 3), dtype=np.uint8), np.zeros(256, dtype=np.bool_)
    for number, material in enumerate(rom.materials):
        colours[number], mirrors[number] = material.colour, material.mirror
    camera = blob.view or frame_scene(rom, PREVIEW_SIZE)
    return Scene(
        rom.name,
        rom.octree.depth,
        rom.octree.words,
        colours,
        mirrors,
        camera,
        blob.lighting,
    )


def load_scene(path: Path, depth: int | None = None, progress: Progress | None = None) -> Scene:
    """Read a memory, or build an asset, for a board.

    Parameters
    ----------
    path
        A blob, a ``.mem`` with or without its manifest, or an asset.
    depth
        Levels, for an asset and for a memory without manifest.
    progress
        Hears of each stage of a build.

    Raises
    ------
    RomError, AssetError, DoesNotFitError
        The file is not what it should be, or too large.
    """
    if path.suffix.lower() == ".blob":
        return read_blob(path.read_bytes())
    if path.suffix.lower() == ".mem":
        return board_scene(read_any(path, depth=depth)[0])

    def begin(stage: str) -> None:
        if progress is not None and stage in _STAGES:
            progress(stage, _STAGES.index(stage), len(_STAGES))

    built = build(path, depth=depth, progress=begin)
    return board_scene(Blob(built.rom, built.view, built.lighting))


class BuildingReader:
    """Makes scenes of uploaded memories and of uploaded assets, which it builds.

    Parameters
    ----------
    depth
        Levels that assets are built with; None for the usual ones.
    """

    def __init__(self, depth: int | None = None) -> None:
        self._depth = depth

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Suffixes of the files that it begins with."""
        return (".blob", ".mem", *sorted(SUFFIXES))

    def __call__(self, files: Mapping[str, bytes], progress: Progress) -> Scene:
        """Make the scene, or raise Refused."""
        for name in files:
            if PurePath(name).name != name or name in {".", ".."} or "\\" in name:
                raise Refused(f"{name}: is no plain file name; give the files without their folders")
        with tempfile.TemporaryDirectory(prefix="voxrt-") as folder:
            paths = [Path(folder, name) for name in files]
            for path, data in zip(paths, files.values(), strict=True):
                path.write_bytes(data)
            first = [path for path in paths if path.suffix.lower() in self.suffixes]
            if len(first) != 1:
                raise Refused(
                    f"{', '.join(files)}: one file of {' '.join(self.suffixes)} is wanted, with the files that it names"
                )
            try:
                return load_scene(first[0], self._depth if first[0].suffix.lower() in SUFFIXES else None, progress)
            except (RomError, voxelize.AssetError, voxelize.DoesNotFitError) as error:
                raise Refused(str(error).replace(f"{folder}/", "")) from error
