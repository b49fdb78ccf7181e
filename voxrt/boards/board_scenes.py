"""Scenes for devices: octree memories and assets as :class:`voxrt.board.scene.Scene`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt import voxelize
from voxrt.board.errors import Refused
from voxrt.board.scene import MEMORY_SUFFIXES, Scene
from voxrt.export import Blob, read_any
from voxrt.octree import RomError
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.serve.scene_process import ChildReader
from voxrt.sim.engine_arguments import mirrors_of, palette_of
from voxrt.views.pictures import animation_camera
from voxrt.voxelize.assets import SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from voxrt.board.scene_memory import Progress

_STAGES = ("load", "fit", "colour", "voxelize", "octree")

ASSET_READER_SUFFIXES = (*MEMORY_SUFFIXES, *sorted(set(SUFFIXES) - {".blend"}))
"""Suffixes of the files that hold a scene, of strangers too: Blender is not made to read theirs."""


def board_scene(blob: Blob) -> Scene:
    """Make the scene of a memory, with its author's camera, or with one that sees all of it."""
    rom = blob.rom
    camera = animation_camera(blob, PREVIEW_SIZE)
    return Scene(
        rom.name,
        rom.octree.depth,
        rom.octree.words,
        palette_of(rom.materials),
        mirrors_of(rom.materials),
        camera,
        blob.lighting,
        blob.roots,
        blob.animation.period if blob.animation else None,
        tuple(map(str, blob.provenance.warnings)),
        tuple(material.name for material in rom.materials),
        None if rom.grid is None else rom.grid.voxel_size,
    )


def load_scene(path: Path, depth: int | None = None, progress: Progress | None = None) -> Scene:
    """Read a blob or a memory, or build an asset, and make its scene; `progress` receives the stages of a build.

    `depth` is that of an asset, or of a memory without manifest; None for the default. RomError, AssetError or
    DoesNotFitError where the file is malformed or too large.
    """
    if path.suffix.lower() in MEMORY_SUFFIXES:
        blob, warnings = read_any(path, depth=depth)
        scene = board_scene(blob)
        scene = replace(scene, warnings=(*scene.warnings, *map(str, warnings)))
        return scene if path.suffix.lower() == ".mem" else replace(scene, camera=blob.view)
    from voxrt.building.pipeline import build  # noqa: PLC0415 - a memory does not wait for what builds

    def begin(stage: str) -> None:
        if progress is not None and stage in _STAGES:
            progress(stage, _STAGES.index(stage), len(_STAGES))

    return board_scene(build(path, depth=depth, progress=begin).blob)


def read_files(paths: Sequence[Path], progress: Progress, depth: int | None, memory_depth: int | None) -> Scene:
    """Make the scene of a memory or an asset, given with the files that it refers to; Refused if they are no scene.

    `depth` is that of an asset, None for the default; `memory_depth` that of a memory without manifest.
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

    `depth` and `memory_depth` are as for :func:`read_files`; None for `memory_depth` refuses memories without manifest.
    """
    levels = ["" if number is None else str(number) for number in (depth, memory_depth)]
    return ChildReader(ASSET_READER_SUFFIXES, ("-m", "voxrt.boards.scene_builder", *levels))
