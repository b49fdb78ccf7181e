"""Scenes for devices: octree memories and assets as :class:`voxrt.board.scene.Scene`."""

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

_STAGES = ("load", "fit", "colour", "voxelize", "octree")


def board_scene(blob: Blob) -> Scene:
    """Make the scene of a memory, with its author's camera, or with one that sees all of it."""
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
    """Read a memory or build an asset, and make its scene.

    Parameters
    ----------
    path
        A blob, a ``.mem`` with or without its manifest, or an asset.
    depth
        Levels of an asset, or of a memory without manifest; None for the default.
    progress
        Receives the stages of a build.

    Raises
    ------
    RomError, AssetError, DoesNotFitError
        The file is malformed or too large.
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


class AssetReader:
    """Makes scenes from uploaded memories, and builds scenes from uploaded assets.

    Parameters
    ----------
    depth
        Levels of assets; None for the default.
    """

    def __init__(self, depth: int | None = None) -> None:
        self._depth = depth

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Suffixes of the files that hold a scene."""
        return (".blob", ".mem", *sorted(SUFFIXES))

    def __call__(self, files: Mapping[str, bytes], progress: Progress) -> Scene:
        """Make a scene from files, given by name.

        Raises
        ------
        Refused
            The files are no scene.
        """
        for name in files:
            if PurePath(name).name != name or name in {".", ".."} or "\\" in name:
                raise Refused(f"{name}: is no plain file name; upload the files without their folders")
        with tempfile.TemporaryDirectory(prefix="voxrt-") as folder:
            paths = [Path(folder, name) for name in files]
            for path, data in zip(paths, files.values(), strict=True):
                path.write_bytes(data)
            main = [path for path in paths if path.suffix.lower() in self.suffixes]
            if len(main) != 1:
                raise Refused(
                    f"{', '.join(files)}: upload exactly one file with a suffix of {' '.join(self.suffixes)}, "
                    "and the files that it refers to"
                )
            try:
                return load_scene(main[0], self._depth if main[0].suffix.lower() in SUFFIXES else None, progress)
            except (RomError, voxelize.AssetError, voxelize.DoesNotFitError) as error:
                raise Refused(str(error).replace(f"{folder}/", "")) from error
