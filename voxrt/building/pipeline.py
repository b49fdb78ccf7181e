"""From an asset to files for the hardware, in one call: load, fit, voxelize, build, write, preview."""

from __future__ import annotations

import os
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from voxrt import export, octree, voxelize
from voxrt.building.grid import build_grid
from voxrt.building.output_files import output_files, refuse_other_asset
from voxrt.building.result import BuildResult
from voxrt.building.view import authored_view, preview
from voxrt.building.writing import named_settings, write_build
from voxrt.options.build_options import merge_options
from voxrt.plans.blockwise import build_octree, plan_build
from voxrt.plans.stage_clock import StageClock
from voxrt.plans.tile_store import TileStore
from voxrt.sim import SimulatorError
from voxrt.sources.object_selection import crowded_out, refuse_empty, without_objects
from voxrt.sources.source import as_text, asset_label, asset_name, load_asset, refuse_warnings
from voxrt.views.viewpoint import ViewpointError, aim_camera, authored_camera, named_camera

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from voxrt.building.baking import Bake
    from voxrt.building.fitting import BudgetFit, InteriorFit
    from voxrt.octree import Octree, Rom
    from voxrt.octree.camera import Camera
    from voxrt.options.build_options import BuildOptions, Fill, UpAxis
    from voxrt.options.keywords import BuildKeywords
    from voxrt.plans.cluster import ClusterProgress
    from voxrt.plans.estimate import BuildEstimate
    from voxrt.sources.source import Asset
    from voxrt.voxelize import Grid, Scene, VoxelizationReport


_MUCH = 10
"""Percent of the surface that a budget may take without a word about it."""


def build(
    asset: Asset,
    output: str | os.PathLike[str] | None = None,
    options: BuildOptions | None = None,
    *,
    progress: Callable[[str], None] | None = None,
    estimated: Callable[[BuildEstimate], None] | None = None,
    clustered: Callable[[ClusterProgress], None] | None = None,
    **keywords: Unpack[BuildKeywords],
) -> BuildResult:
    """Build the octree memory of an asset, and write it with its manifest and its preview.

    Parameters
    ----------
    asset
        A glTF, OBJ, USD, STL or PLY file, or a scene of some (.toml); a mesh or a scene of trimesh; vertices and faces
        as arrays, ``(vertices, faces)``; a :class:`Scene`.
    output
        Folder for ``NAME.mem`` and ``NAME.json``, where NAME is the name of the file or of the scene; or the file of
        words itself, such as ``yard.mem`` or ``yard.coe``. Folders are made if they are missing. None writes neither.
    options
        How to build; None for the defaults.
    progress
        Called with the name of each stage as it begins.
    estimated
        Called with what the build will take, once the scene is loaded and its grid is known.
    clustered
        Called with how far a cluster is, as tiles are finished.
    **keywords
        The options of :class:`BuildOptions` by name. They take precedence over `options`.

    Returns
    -------
    BuildResult
        The memory, and how it came about.

    Raises
    ------
    TypeError, ValueError
        An option of the wrong type or out of range, or arrays that are not those of a mesh.
    AssetError
        The asset cannot be honoured, or only with a warning while `strict` is set.
    DoesNotFitError
        The asset is sound but too large.
    OutputError
        A file cannot be written, or the folder has files of the same name that were built from another asset. Old
        files stay as they were.
    ToolError
        The cluster that was asked for is not there, or is lost. Its finished tiles stay.
    SimulatorError
        The preview cannot be rendered. The memory and the manifest are complete by then; an older preview is removed,
        for it shows another memory.

    Examples
    --------
    >>> import voxrt
    >>> built = voxrt.build("examples/house.obj", "out", depth=5, preview=True, engine="model")
    >>> sorted(path.name for path in built.outputs.values())
    ['house.json', 'house.mem', 'house.preview.png']
    >>> options = voxrt.BuildOptions(depth=5, fill="surface")
    >>> voxrt.build("examples/house.obj", options=options).solid_voxels < built.solid_voxels
    True
    """
    options = merge_options("build", options, keywords)
    _check_cluster(asset, output, options)
    files = output_files(asset_name(asset), output, options.preview)
    source = as_text(Path(asset).name if isinstance(asset, str | os.PathLike) else files.name)
    if files.words is not None and not files.named:
        refuse_other_asset(files.words, source)
    clock = StageClock(progress)
    with clock.stage("load"):
        loaded = without_objects(asset_label(asset), load_asset(asset, options), options.ignore)
        if options.camera is not None:
            viewpoint = named_camera(asset_label(asset), loaded, options.camera)
            loaded = replace(loaded, viewpoint=viewpoint)
    refuse_warnings(asset, loaded.warnings, options)
    picture, unseen_picture = None, None
    with ExitStack() as stack:
        store = None if files.words is None else stack.enter_context(TileStore(_tiles_folder(files.words)))
        scene, grid, tree, voxelization = _voxelize(
            asset, loaded, options, clock, told=(estimated, clustered), store=store
        )
        if not options.allow_empty:
            refuse_empty(asset_label(asset), grid, voxelization.objects)
        rom = octree.Rom(files.name, tree, scene.materials, grid)
        rom, baked, interior_fit, budget_fit = _finished(rom, asset, (loaded, scene), options, clock)
        if options.lod or options.dialect == "lod":
            with clock.stage("lod"):
                rom = octree.with_means(rom)
        view, lighting, unseen = authored_view(scene, rom, options)
        warnings = scene.warnings + voxelization.warnings + crowded_out(scene, grid, options) + unseen
        refuse_warnings(asset, warnings, options)
        if files.preview is not None:
            with clock.stage("preview"):
                try:
                    picture = preview(rom, _camera(rom, view, scene, options), lighting, options)
                except (SimulatorError, ViewpointError) as error:
                    unseen_picture = error  # the memory is sound: it is written first
        result = BuildResult(
            rom,
            scene,
            voxelization.objects,
            warnings,
            {},
            picture,
            interior_fit,
            budget_fit,
            clock.seconds,
            {"voxelize": voxelization.seconds},
            view,
            lighting,
            export.Source(source, named_settings(options)),
            baked,
        )
        with clock.stage("write"):
            result.outputs.update(write_build(files, result, options))
    if picture is not None:  # what programs read keeps its order
        clock.seconds["preview"] = clock.seconds.pop("preview")
    if unseen_picture is not None:
        raise unseen_picture
    return result


def voxelize_mesh(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    depth: int | None = None,
    voxel_size: float | None = None,
    colours: ArrayLike | None = None,
    face_colours: ArrayLike | None = None,
    fill: Fill = "auto",
    up: UpAxis | None = None,
    unit: float | None = None,
    threads: int = 0,
) -> BuildResult:
    """Voxelize a mesh given as arrays. It is ``build(mesh_scene(vertices, faces, ...))`` without files.

    Parameters
    ----------
    vertices, faces, colours, face_colours, up, unit
        The mesh, as :func:`mesh_scene` takes it.
    depth, voxel_size, fill, threads
        As in :class:`BuildOptions`.

    Returns
    -------
    BuildResult
        ``coordinates`` has the solid voxels, ``to_dense()`` the whole grid, ``octree`` the memory, ``rom.grid`` the
        place of the voxels.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong type, shape or range.
    AssetError
        There are no triangles.
    DoesNotFitError
        The mesh needs more than 2**16 voxels per side.

    Examples
    --------
    >>> import voxrt
    >>> corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    >>> quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    >>> faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    >>> cube = voxrt.voxelize_mesh(corners, faces, depth=3, colours=(0, 128, 255))
    >>> cube.coordinates.shape
    (512, 3)
    """
    from voxrt.sources.from_arrays import mesh_scene  # noqa: PLC0415 - most builds are of files

    scene = mesh_scene(vertices, faces, colours=colours, face_colours=face_colours, up=up, unit=unit)
    return build(scene, depth=depth, voxel_size=voxel_size, fill=fill, threads=threads)


def _tiles_folder(words: Path) -> Path:
    return words.with_name(f"{words.stem}.tiles")


def _check_cluster(asset: Asset, output: str | os.PathLike[str] | None, options: BuildOptions) -> None:
    """Refuse a build on a cluster that has nowhere to put its tiles, or whose workers could not open the asset."""
    if options.scheduler is None and options.workers is None:
        return
    if output is None:
        raise ValueError("a cluster writes its tiles beside the output: name an output")
    if not isinstance(asset, str | os.PathLike):
        raise TypeError(f"the workers of a cluster open the asset's file: give its path, not {type(asset).__name__}")


def _voxelize(
    asset: Asset,
    scene: Scene,
    options: BuildOptions,
    clock: StageClock,
    *,
    told: tuple[Callable[[BuildEstimate], None] | None, Callable[[ClusterProgress], None] | None],
    store: TileStore | None,
) -> tuple[Scene, Grid, Octree, VoxelizationReport]:
    """Fit a grid, reduce colours to materials, voxelize, build the octree."""
    estimated, clustered = told
    with clock.stage("fit"):
        grid = build_grid(scene, options)
        plan = plan_build(scene, grid, options, on_disk=store is not None)
    if estimated is not None:
        estimated(plan.estimate)
    with clock.stage("colour"):
        scene = voxelize.assign_colours(scene, grid, colours=options.colours, geometry=options.geometry)
    if (
        store is None
        or not isinstance(asset, str | os.PathLike)
        or (options.scheduler, options.workers) == (None, None)
    ):
        return scene, grid, *build_octree(scene, grid, options, clock, plan=plan, store=store)
    from voxrt.plans.cluster import build_on_cluster  # noqa: PLC0415 - few builds do this

    return scene, grid, *build_on_cluster(asset, scene, grid, options, clock, plan=plan, store=store, told=clustered)


def _camera(rom: Rom, view: Camera | None, scene: Scene, options: BuildOptions) -> Camera:
    """Return the camera of the preview: the author's if it can be used."""
    if view is not None and scene.viewpoint is not None and rom.grid is not None:
        return authored_camera(scene.viewpoint, rom.grid, options.size)
    return aim_camera(rom, options.size)


def _finished(
    rom: Rom, asset: Asset, scenes: tuple[Scene, Scene], options: BuildOptions, clock: StageClock
) -> tuple[Rom, Bake | None, InteriorFit | None, BudgetFit | None]:
    """Give hidden voxels their material, bake light and fit the budget, if that is asked for.

    `scenes`: as it was loaded, and with its colours reduced to materials.
    """
    loaded, scene = scenes
    light, baked, interior_fit, budget_fit = None, None, None, None
    interior, budget = options.interior, options.budget
    if interior == "keep" and budget is None and not options.bake:
        return rom, None, None, None
    from voxrt.building.baking import bake, fit_baked  # noqa: PLC0415 - slow to import, and few builds do this
    from voxrt.building.fitting import find_material, fit_budget, fit_interior  # noqa: PLC0415

    if interior not in ("keep", "any"):
        with clock.stage("interior"):
            material = find_material(asset_label(asset), rom.materials, interior)
            rom, interior_fit = fit_interior(rom, material)
    if options.bake:
        with clock.stage("bake"):
            rom, light, baked = bake(rom, scene, options)
    if interior == "any":  # what hidden voxels may share depends on the colours of all others
        with clock.stage("interior"):
            rom, interior_fit = fit_interior(rom, None)
    if budget is not None:
        with clock.stage("budget"):
            words = octree.BOARDS[budget] if isinstance(budget, str) else budget
            if light is None or baked is None:
                rom, budget_fit = fit_budget(rom, words, options.size, options.threads)
            else:
                rom, budget_fit, baked = fit_baked(rom, light, baked, words, options)
            if budget_fit.fit.percent_changed > _MUCH:
                budget_fit = replace(budget_fit, lossless=_lossless_depth(loaded, options, rom.octree.depth, words))
    return rom, baked, interior_fit, budget_fit


def _lossless_depth(loaded: Scene, options: BuildOptions, depth: int, words: int) -> tuple[int, int] | None:
    """Find the greatest lesser depth at which a scene fits so many words, and its words there; None if none does."""
    for lesser in range(depth - 1, 0, -1):
        whole = replace(options, depth=lesser, voxel_size=None, budget=None, preview=False, strict=False)
        whole = replace(whole, ignore=(), allow_empty=True, scheduler=None, workers=None)  # done by now
        size = len(build(loaded, options=whole).octree.words)
        if size <= words:
            return lesser, size
    return None
