"""What ``--json`` prints of the commands that look at memories."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import asdict

import voxrt
from voxrt.cli.results.build_results import CameraEntry, camera_entry
from voxrt.cli.terminal.messages import name_file
from voxrt.export import RomInfo
from voxrt.octree import AnimationFrame, Region  # noqa: TC001 - msgspec resolves annotations
from voxrt.sim import PixelColour  # noqa: TC001
from voxrt.voxelize import SceneWarning  # noqa: TC001

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.export import Blob
    from voxrt.sim import Camera, Likeness, RayPath
    from voxrt.views.depth_likeness import LikenessAtDepth

_AXES = ("x", "y", "z", None)
"""By the numbers of axes; the last is :data:`voxrt.sim.FACE_NONE`."""


class ConvertResult(msgspec.Struct, frozen=True):
    """``voxrt convert --json``."""

    outputs: list[str]
    """Files written, the memory first."""
    warnings: tuple[SceneWarning, ...]


class EditResult(msgspec.Struct, frozen=True):
    """``voxrt edit --json``."""

    outputs: list[str]
    """Files written, the memory first."""
    warnings: tuple[SceneWarning, ...]
    edits: int
    """Operations of the script."""
    words_before: int
    words: int
    """Those of the memory that was written."""


class WorldEntry(msgspec.Struct, frozen=True):
    """Where the voxels stand in the scene."""

    origin: tuple[float, float, float]
    """The lowest corner, metres."""
    voxel_size: float
    """Metres."""


class InfoResult(RomInfo, frozen=True):
    """``voxrt info --json``: what :class:`voxrt.export.RomInfo` holds, and where the voxels stand."""

    world: WorldEntry | None
    """Null for a memory that does not say."""
    mean_materials: int | None = None
    """Blocks that have one, for the level of detail; null for a memory without it."""
    frames: tuple[AnimationFrame, ...] | None = None
    """Those of an animation; null for a memory of one scene. All else is then of the first, but for the words."""


class DiffResult(msgspec.Struct, frozen=True):
    """``voxrt diff --json``: voxels that differ."""

    voxels: int
    appeared: int
    """Empty in the first, solid in the second."""
    vanished: int
    """Solid in the first, empty in the second."""
    recoloured: int
    """Solid in both, of different materials."""
    bounds: tuple[tuple[int, int, int], tuple[int, int, int]] | None
    """The smallest box that holds them: its lowest voxel, and one behind its highest."""
    regions: tuple[Region, ...]
    """The pieces that hang together, those with most voxels first."""


class CurveEntry(msgspec.Struct, frozen=True):
    """A point of the curve; figures as in :class:`CompareResult`."""

    depth: int
    words: int
    silhouette_iou: float | None
    depth_mean: float | None
    normal_agreement: float | None
    psnr: float | None
    ssim: float | None


class CompareResult(msgspec.Struct, frozen=True):
    """``voxrt compare --json``; null where nothing is seen that could be compared."""

    silhouette_iou: float | None
    depth_mean: float | None
    depth_median: float | None
    depth_95: float | None
    """Depths in voxels."""
    normal_cosine: float | None
    normal_agreement: float | None
    psnr: float | None
    ssim: float | None
    wrong_pixels: int | None
    """On which hardware and model differ; null where the hardware could not be run."""
    curve: list[CurveEntry]
    outputs: dict[str, str]


class ReadingEntry(msgspec.Struct, frozen=True):
    """A word that a ray read."""

    address: int
    word: int
    leaf: bool
    """False: the word is a pointer."""
    level: int
    """log2 of the octant's side, voxels."""
    low: tuple[int, int, int]
    """The octant's lowest voxel."""
    high: tuple[int, int, int]
    """One behind its highest."""
    axis: str | None
    """Across which the ray entered: the axis of the plane crossed last; null where it has crossed none."""
    t: int
    """The integer T of that crossing."""
    point: tuple[float, float, float]
    """Where that was, voxels."""


class TraceResult(msgspec.Struct, frozen=True):
    """``voxrt trace --json``."""

    pixel: tuple[int, int]
    size: tuple[int, int]
    camera: CameraEntry
    direction: tuple[int, int, int]
    root: int
    """Word 0, which is kept from ray to ray."""
    readings: list[ReadingEntry]
    """In order."""
    material: int
    """What was hit; 0 for nothing."""
    face: str | None
    """The axis of the side hit; null at a miss, and from within a solid."""
    voxel: tuple[int, int, int] | None
    """Null at a miss."""
    colour: PixelColour
    outputs: dict[str, str]
    """Files written with ``--wave``, by kind: `wave`, `gtkwave`, `surfer`."""


def trace_result(
    camera: Camera,
    size: tuple[int, int],
    pixel: tuple[int, int],
    path: RayPath,
    *,
    colour: PixelColour,
    outputs: dict[str, str],
) -> TraceResult:
    """Tell programs the way of a ray."""
    return TraceResult(
        pixel=pixel,
        size=size,
        camera=camera_entry(camera),
        direction=path.direction,
        root=path.root,
        readings=[
            ReadingEntry(
                address=reading.address,
                word=reading.word,
                leaf=reading.is_leaf,
                level=reading.level,
                low=reading.corner,
                high=reading.end,
                axis=_AXES[reading.axis],
                t=reading.time,
                point=path.point(reading.time),
            )
            for reading in path.readings
        ],
        material=path.material,
        face=_AXES[path.face],
        voxel=path.cell,
        colour=colour,
        outputs=outputs,
    )


def info_result(blob: Blob) -> InfoResult:
    """Tell programs what a memory holds."""
    rom = blob.rom
    facts = voxrt.rom_info(rom)
    return InfoResult(
        **asdict(facts),
        world=None if rom.grid is None else WorldEntry(rom.grid.origin, rom.grid.voxel_size),
        mean_materials=None if rom.octree.means is None else int((rom.octree.means > 0).sum()),
        frames=None if blob.animation is None else blob.animation.frames,
    )


def compare_result(
    likeness: Likeness, wrong_pixels: int | None, curve: tuple[LikenessAtDepth, ...], files: dict[str, Path]
) -> CompareResult:
    """Tell programs how like two pictures are."""
    points = []
    for point in curve:
        figures = _figures(point.likeness)
        known = {name: figures[name] for name in CurveEntry.__struct_fields__ if name in figures}
        points.append(CurveEntry(depth=point.depth, words=point.words, **known))
    outputs = {kind: name_file(path) for kind, path in files.items()}
    return CompareResult(**_figures(likeness), wrong_pixels=wrong_pixels, curve=points, outputs=outputs)


def _figures(likeness: Likeness) -> dict[str, float | None]:
    return {name: value if math.isfinite(value) else None for name, value in asdict(likeness).items()}
