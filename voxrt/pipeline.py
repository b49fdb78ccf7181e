"""From an asset file to files for the hardware, in one call: load, fit, voxelize, build, write, preview."""

from __future__ import annotations

import os
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal

from voxrt import export, octree, sim, voxelize
from voxrt.fitting import BudgetFit, InteriorFit, find_material, fit_budget, fit_interior
from voxrt.outputs import OutputError, check_folder, uninterrupted, writing
from voxrt.viewpoint import ViewpointError, aim_camera, authored_camera, authored_lighting
from voxrt.voxelize import AssetError, SceneWarning

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.octree import Dialect, Rom
    from voxrt.sim import Camera, Engine, Frame
    from voxrt.voxelize import Grid, ObjectReport, Scene
    from voxrt.voxelize.assets import UpAxis
    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.object_proxies import Geometry

DEFAULT_DEPTH = 7
"""Levels of the octree when neither they nor the voxels' size are given."""

PREVIEW_SIZE = (640, 480)
"""Width and height of a picture when nobody says, pixels."""


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """A frame, the camera that saw it and the engine that rendered it."""

    frame: Frame
    camera: Camera
    engine: Engine


@dataclass(frozen=True, eq=False, slots=True)
class BuildResult:
    """What a build made.

    Attributes
    ----------
    rom
        The octree memory with its materials and its place in the scene.
    scene
        What the asset's file said.
    objects
        How each object was voxelized, in authored order.
    warnings
        What the asset said and was not honoured as it stands.
    outputs
        The files written, by kind: ``"mem"``, ``"manifest"``, ``"preview"``.
    preview
        The rendered picture, None when none was asked for.
    interior
        What became of hidden voxels, None when they keep their materials.
    budget
        What fitting the budget took, None when there was none.
    seconds
        Wall seconds per stage, in order: ``"load"``, ``"fit"``, ``"colour"``, ``"voxelize"``, ``"octree"``,
        ``"interior"``, ``"budget"``, ``"write"``, ``"preview"``.
    parts
        Of what some of these stages consist, in order: ``"voxelize"`` (:attr:`voxrt.voxelize.Voxelization.seconds`).
    view, lighting
        The author's camera and light; None where the author gave none.
    """

    rom: Rom
    scene: Scene
    objects: tuple[ObjectReport, ...]
    warnings: tuple[SceneWarning, ...]
    outputs: dict[str, Path] = field(default_factory=dict)
    preview: Picture | None = None
    interior: InteriorFit | None = None
    budget: BudgetFit | None = None
    seconds: dict[str, float] = field(default_factory=dict)
    parts: dict[str, dict[str, float]] = field(default_factory=dict)
    view: export.View | None = None
    lighting: export.Lighting | None = None

    @property
    def solid_voxels(self) -> int:
        """How many voxels are not empty."""
        return octree.census(self.rom.octree).solid_voxels


def build(
    asset: str | os.PathLike[str],
    output: str | os.PathLike[str] | None = None,
    *,
    depth: int | None = None,
    voxel_size: float | None = None,
    fill: Literal["solid", "surface"] = "solid",
    interior: int | str = "keep",
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
    up: UpAxis | None = None,
    unit: float | None = None,
    time: float | None = None,
    animation: str | None = None,
    variants: tuple[str, ...] = (),
    allow_outside: bool = False,
    colours: int = voxelize.DEFAULT_COLOURS,
    budget: int | str | None = None,
    dialect: Dialect = "report",
    preview: str | os.PathLike[str] | bool = False,
    size: tuple[int, int] = PREVIEW_SIZE,
    engine: Engine = "rtl",
    strict: bool = False,
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
    interior
        What becomes of voxels that no ray from outside can reach: ``"keep"`` leaves them their object's material, a
        material's id or name gives them that one, ``"any"`` gives each whatever lets most blocks be shared.
    geometry
        ``"auto"`` takes an object's colliders where it has some, else its triangles; ``"render"`` always the
        triangles; ``"collider"`` always colliders, the bounding box where an object has none.
    pow2
        ``"box"`` rounds box colliders up to powers of two voxels, ``"none"`` never.
    up, unit
        The up axis and the metres per unit, for formats that do not say.
    time
        The second of its animation at which the asset is shown.
    animation
        Which of its animations, by name or by number counted from 0 (glTF).
    variants
        What to show of an asset that can be shown in several ways, as :func:`voxrt.voxelize.load` takes it.
    allow_outside
        Whether files that the asset names may stand outside its folder and the folders in it.
    colours
        The most materials that textures and vertex colours are reduced to, 1 … 254; uniform materials keep theirs.
    budget
        Words that the memory may take, or the name of a board that knows (:data:`voxrt.octree.BOARDS`): what is seen
        least is given up until it fits.
    dialect
        How the memory's words spell a material.
    preview
        PNG file for a picture of the whole scene, `size` pixels wide and high, rendered by `engine`; True for
        ``NAME.preview.png`` in `output`. A light of the scene's own is cast.
    strict
        Refuse an asset of which something is not honoured as it stands, where it would be a warning.
    threads
        Threads for the native stages, 0 for one a core. The result does not depend on it.
    progress
        Called with each stage's name as it begins.

    Raises
    ------
    AssetError
        The asset cannot be honoured, or not to the letter and `strict` is set.
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
        start = perf_counter()
        yield
        seconds[name] = perf_counter() - start

    name = _text(asset.stem)
    picture_file = _picture_file(name, output, preview)
    with stage("load"):
        scene = voxelize.load(
            asset,
            up=up,
            unit=unit,
            time=time,
            animation=animation,
            variants=variants,
            allow_outside=allow_outside,
        )
    _refuse(asset, scene.warnings if strict else ())
    with stage("fit"):
        if depth is None and voxel_size is None:
            depth = DEFAULT_DEPTH
        grid = voxelize.fit_grid(scene, depth=depth, voxel_size=voxel_size, geometry=geometry, pow2=pow2)
    with stage("colour"):
        scene = voxelize.assign_colours(scene, grid, colours=colours, geometry=geometry)
    with stage("voxelize"):
        voxelization = voxelize.voxelize(scene, grid, fill=fill, geometry=geometry, pow2=pow2, threads=threads)
    with stage("octree"):
        rom = octree.Rom(name, octree.build(voxelization.voxels, threads=threads), scene.materials, grid)
    interior_fit, budget_fit = None, None
    if interior != "keep":
        with stage("interior"):
            rom, interior_fit = fit_interior(rom, None if interior == "any" else find_material(asset, scene, interior))
    if budget is not None:
        with stage("budget"):
            words = octree.BOARDS[budget] if isinstance(budget, str) else budget
            rom, budget_fit = fit_budget(rom, words, size, threads)
    view, lighting, unseen = _authored(scene, grid)
    warnings = scene.warnings + voxelization.warnings + unseen
    _refuse(asset, warnings if strict else ())
    outputs: dict[str, Path] = {}
    if output is not None:
        settings: dict[str, str | int | float | bool | None] = {
            "fill": fill,
            "interior": interior,
            "geometry": geometry,
            "pow2": pow2,
            "up": up,
            "unit": unit,
            "time": time,
            "animation": animation,
            "variants": ", ".join(variants) or None,
            "colours": colours,
        }
        with stage("write"), writing(Path(output)), uninterrupted():
            files = export.write_rom(
                Path(output),
                rom,
                dialect=dialect,
                objects=voxelization.objects,
                warnings=warnings,
                seconds=seconds,
                source=export.Source(_text(asset.name), settings),
                view=view,
                lighting=lighting,
            )
        outputs |= {"mem": files.mem, "manifest": files.manifest}
    picture = None
    if picture_file is not None:
        with stage("preview"):
            picture = _picture(rom, scene, lighting, size, engine=engine, threads=threads)
            save_picture(picture.frame.colour, picture_file)
            outputs["preview"] = picture_file
    return BuildResult(
        rom,
        scene,
        voxelization.objects,
        warnings,
        outputs,
        picture,
        interior_fit,
        budget_fit,
        seconds,
        {"voxelize": voxelization.seconds},
        view,
        lighting,
    )


def _picture_file(
    name: str, output: str | os.PathLike[str] | None, preview: str | os.PathLike[str] | bool
) -> Path | None:
    """Check that the folders can be written to, and return where the preview goes; None for none."""
    if output is not None:
        check_folder(Path(output))
    if not preview:
        return None
    file = Path(output or ".") / f"{name}.preview.png" if preview is True else Path(preview)
    check_folder(file.parent)
    return file


def _picture(
    rom: Rom,
    scene: Scene,
    lighting: export.Lighting | None,
    size: tuple[int, int],
    *,
    engine: Engine,
    threads: int,
) -> Picture:
    if scene.viewpoint is not None and rom.grid is not None:
        camera = authored_camera(scene.viewpoint, rom.grid, size)
    else:
        camera = aim_camera(rom, size)
    config = "tiny" if lighting is None else "lit"
    frame = render(rom, camera, size=size, engine=engine, config=config, lighting=lighting, threads=threads)
    return Picture(frame, camera, engine)


def _authored(scene: Scene, grid: Grid) -> tuple[export.View | None, export.Lighting | None, tuple[SceneWarning, ...]]:
    """Return how the scene's author wants it seen, and what of that cannot be."""
    view, lighting, unseen = None, None, []
    if scene.viewpoint is not None:
        try:
            camera = authored_camera(scene.viewpoint, grid, PREVIEW_SIZE)
            view = export.View(camera.position, camera.look, camera.right, camera.up)
        except ViewpointError as error:
            unseen.append(SceneWarning("camera", str(error)))
    try:
        lighting = authored_lighting(scene, grid)
    except ViewpointError as error:
        unseen.append(SceneWarning("light", str(error)))
    return view, lighting, tuple(unseen)


def _refuse(asset: Path, warnings: tuple[SceneWarning, ...]) -> None:
    if warnings:
        first, *others = warnings
        kinds = sorted({warning.kind for warning in others})
        more = f"; and {len(others)} more ({', '.join(kinds)})" if others else ""
        raise AssetError(asset, f"{first.message}{more}", fix="mend the asset, or build without strict")


def _text(name: str) -> str:
    """Give a file's name as text that can name other files: what is no text, or a backslash, becomes ``_``."""
    text = os.fsencode(name).decode("utf-8", "replace")
    return text.translate({0xFFFD: "_", ord("\\"): "_"})


def render(
    rom: Rom,
    camera: Camera | None = None,
    *,
    size: tuple[int, int] = PREVIEW_SIZE,
    engine: Engine = "rtl",
    config: str = "tiny",
    lighting: export.Lighting | None = None,
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
    config
        The configuration of the ray tracer that ``"rtl"`` runs.
    lighting
        Light, mirrors and flat colours, for which the ray tracer needs a configuration that has them built in; None
        for a light in the camera.
    threads
        Threads of the model, 0 for one a core.

    Raises
    ------
    SimulatorError
        The engine is not in this installation, cannot hold the memory or the camera, or has no such shading.
    """
    return sim.render(
        rom,
        camera or aim_camera(rom, size),
        size,
        engine=engine,
        shading=sim.Shading.of(lighting),
        config=config,
        threads=threads,
    )


def save_picture(colour: NDArray[np.uint8], path: Path) -> None:
    """Write a picture (uint8, shape (H, W, 3), sRGB) as a PNG file, all of it or nothing.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    check_folder(path.parent)
    if path.is_dir():
        raise OutputError(f"{path}: is a folder; name a file")
    with writing(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        sim.write_png(path, colour)
