"""Scenes for devices: octree memories and assets as :class:`voxrt.board.scene.Scene`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt import voxelize
from voxrt.board.errors import Refused
from voxrt.board.scene import Scene
from voxrt.building.pipeline import build
from voxrt.export import Blob, read_any
from voxrt.octree import RomError
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.serve.blob import read_blob
from voxrt.serve.scene_process import ChildReader
from voxrt.views.pictures import animation_camera
from voxrt.voxelize.assets import SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from voxrt.board.scene_memory import Progress

_STAGES = ("load", "fit", "colour", "voxelize", "octree")

ASSET_READER_SUFFIXES = (".blob", ".mem", *sorted(SUFFIXES))
"""Suffixes of the files that hold a scene."""


def board_scene(blob: Blob) -> Scene:
    """Make the scene of a memory, with its author's camera, or with one that sees all of it."""
    rom = blob.rom
    colours, mirrors = np.zeros((256, 3), dtype=np.uint8), np.zeros(256, dtype=np.bool_)
    for number, material in enumerate(rom.materials):
        colours[number], mirrors[number] = material.colour, material.mirror
    camera = animation_camera(blob, PREVIEW_SIZE)
    return Scene(
        rom.name,
        rom.octree.depth,
        rom.octree.words,
        colours,
        mirrors,
        camera,
        blob.lighting,
        *((blob.animation.roots, blob.animation.period) if blob.animation else ()),
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


def read_files(paths: Sequence[Path], progress: Progress, depth: int | None, memory_depth: int | None) -> Scene:
    """Make the scene of files, one of which is a memory or an asset.

    Parameters
    ----------
    paths
        That file, and those that it refers to.
    progress
        Receives the stages.
    depth
        Levels of an asset; None for the default.
    memory_depth
        Levels of a memory without manifest.

    Raises
    ------
    Refused
        The files are no scene.
    """
    main = [path for path in paths if path.suffix.lower() in ASSET_READER_SUFFIXES]
    if len(main) != 1:
        names = ", ".join(path.name for path in paths)
        raise Refused(
            f"{names}: upload exactly one file with a suffix of {' '.join(ASSET_READER_SUFFIXES)}, "
            "and the files that it refers to"
        )
    try:
        return load_scene(main[0], depth if main[0].suffix.lower() in SUFFIXES else memory_depth, progress)
    except (RomError, voxelize.AssetError, voxelize.DoesNotFitError) as error:
        raise Refused(str(error).replace(f"{main[0].parent}/", "")) from error


def asset_reader(depth: int | None = None, memory_depth: int | None = None) -> ChildReader:
    """Return the reader of memories and assets; each is read and built in a process of its own.

    Parameters
    ----------
    depth
        Levels of assets; None for the default.
    memory_depth
        Levels of memories without manifest; None refuses them.
    """
    levels = ["" if number is None else str(number) for number in (depth, memory_depth)]
    return ChildReader(ASSET_READER_SUFFIXES, ("-m", "voxrt.boards.scene_builder", *levels))
