"""From an asset file to files for the hardware, in one call: load, fit, voxelize, build, write, preview."""

from __future__ import annotations

import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt import export, octree, sim, voxelize
from voxrt.outputs import check_folder, staged
from voxrt.viewpoint import aim_camera

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterator

    from voxrt.octree import Rom
    from voxrt.sim import Camera, Frame
    from voxrt.voxelize import ObjectReport, SceneWarning

DEFAULT_DEPTH = 7
"""Levels of the octree when neither they nor the voxels' size are given."""

PREVIEW_SIZE = (640, 480)
"""Width and height of a picture when nobody says, pixels."""


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """A frame, the camera that saw it and the engine that rendered it."""

    frame: Frame
    camera: Camera
    engine: sim.Engine


@dataclass(frozen=True, eq=False, slots=True)
class BuildResult:
    """What a build made.

    Attributes
    ----------
    rom
        The octree memory with its materials and its place in the scene.
    voxels
        How many voxels are solid.
    objects
        How each object was voxelized, in authored order.
    warnings
        What the asset said and was not honoured as it stands.
    outputs
        The files written, by kind: ``"mem"``, ``"manifest"``, ``"preview"``.
    preview
        The rendered picture, None when none was asked for.
    seconds
        Wall seconds a stage, in order: ``"load"``, ``"fit"``, ``"voxelize"``, ``"octree"``, ``"write"``, ``"preview"``.
    """

    rom: Rom
    voxels: int
    objects: tuple[ObjectReport, ...]
    warnings: tuple[SceneWarning, ...]
    outputs: dict[str, Path] = field(default_factory=dict)
    preview: Picture | None = None
    seconds: dict[str, float] = field(default_factory=dict)


def build(
    asset: str | os.PathLike[str],
    output: str | os.PathLike[str] | None = None,
    *,
    depth: int | None = None,
    voxel_size: float | None = None,
    fill: voxelize.Fill = "solid",
    geometry: voxelize.Geometry = "auto",
    pow2: voxelize.Pow2 = "box",
    up: voxelize.UpAxis | None = None,
    unit: float | None = None,
    dialect: octree.Dialect = "report",
    preview: str | os.PathLike[str] | None = None,
    size: tuple[int, int] = PREVIEW_SIZE,
    engine: sim.Engine = "rtl",
    threads: int = 0,
    progress: Callable[[str], None] | None = None,
) -> BuildResult:
    """Build the octree memory of an asset, and write it with its manifest and its preview.

    Parameters
    ----------
    asset
        A glTF, OBJ, USD, STL or PLY file.
    output
        Folder for ``NAME.mem`` and ``NAME.json``, made when it is missing; None writes neither.
    depth
        Levels of the octree, 1 … 16: the scene's bounding cube gets 2**depth voxels a side. 7 when neither this nor
        `voxel_size` is given.
    voxel_size
        Metres a voxel.
    fill
        ``"solid"`` fills what closed surfaces enclose, ``"surface"`` keeps the shell.
    geometry
        ``"auto"`` takes an object's colliders where it has some, else its triangles; ``"render"`` always the
        triangles; ``"collider"`` always colliders, the bounding box where an object has none.
    pow2
        ``"box"`` rounds box colliders up to powers of two voxels, ``"none"`` never.
    up, unit
        The up axis and the metres per unit, for formats that do not say.
    dialect
        How the memory's words spell a material.
    preview
        PNG file for a picture of the whole scene, `size` pixels wide and high, rendered by `engine`.
    threads
        Threads for the native stages, 0 for one a core. The result does not depend on it.
    progress
        Called with each stage's name as it begins.

    Raises
    ------
    AssetError
        The asset cannot be honoured.
    DoesNotFitError
        The asset is sound but too large.
    OutputError
        A file cannot be written where it was asked for. Old files stay as they were.
    SimulatorError
        The preview cannot be rendered. The memory and the manifest are complete by then.
    """
    asset = Path(asset)
    seconds: dict[str, float] = {}

    @contextmanager
    def stage(name: str) -> Iterator[None]:
        if progress is not None:
            progress(name)
        start = time.perf_counter()
        yield
        seconds[name] = time.perf_counter() - start

    for folder in (output, None if preview is None else Path(preview).parent):
        if folder is not None:
            check_folder(Path(folder))
    with stage("load"):
        scene = voxelize.load(asset, up=up, unit=unit)
    with stage("fit"):
        if depth is None and voxel_size is None:
            depth = DEFAULT_DEPTH
        grid = voxelize.fit_grid(scene, depth=depth, voxel_size=voxel_size, geometry=geometry, pow2=pow2)
    with stage("voxelize"):
        voxelization = voxelize.voxelize(scene, grid, fill=fill, geometry=geometry, pow2=pow2, threads=threads)
    with stage("octree"):
        rom = octree.Rom(scene.name, octree.build(voxelization.voxels), scene.materials, grid)
    warnings = scene.warnings + voxelization.warnings
    voxels = sum(report.voxels for report in voxelization.objects)
    outputs: dict[str, Path] = {}
    if output is not None:
        with stage("write"):
            # The file keeps the asset's name byte for byte, even where that is no text.
            mem, manifest = (Path(output) / f"{asset.stem}{suffix}" for suffix in (".mem", ".json"))
            with staged((mem, manifest)) as (new_mem, new_manifest):
                export.write_mem(new_mem, rom.octree, dialect=dialect)
                export.write_manifest(new_manifest, rom, dialect=dialect, voxels=voxels, warnings=warnings)
            outputs |= {"mem": mem, "manifest": manifest}
    picture = None
    if preview is not None:
        with stage("preview"):
            camera = aim_camera(rom.octree, size)
            frame = render(rom, camera, size=size, engine=engine, threads=threads)
            picture = Picture(frame, camera, engine)
            save_picture(frame, Path(preview))
            outputs["preview"] = Path(preview)
    return BuildResult(rom, voxels, voxelization.objects, warnings, outputs, picture, seconds)


def render(
    rom: Rom,
    camera: Camera | None = None,
    *,
    size: tuple[int, int] = PREVIEW_SIZE,
    engine: sim.Engine = "rtl",
    threads: int = 0,
) -> Frame:
    """Render a memory.

    Parameters
    ----------
    rom
        The memory and its materials.
    camera
        Where from; None for a three-quarter view of the whole scene.
    size
        Width and height, pixels.
    engine
        ``"rtl"``: the verilated ray tracer, which counts its clocks; ``"model"``: the exact model. Both give the same
        pixels.
    threads
        Threads of the model, 0 for one a core.

    Raises
    ------
    SimulatorError
        The engine is not in this installation, or cannot hold the memory or the camera.
    """
    return sim.render(rom, camera or aim_camera(rom.octree, size), size, engine=engine, threads=threads)


def save_picture(frame: Frame, path: Path) -> None:
    """Write a frame as a PNG file, all of it or nothing.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    with staged((path,)) as (new,):
        sim.write_png(new, frame.colour)
