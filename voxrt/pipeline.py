"""From an asset to files for the hardware, in one call: load, fit, voxelize, build, write, preview.

What only some builds do is imported where it is done: a small build takes less time than those imports.
"""

from __future__ import annotations

import os
from contextlib import ExitStack, contextmanager
from dataclasses import fields, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Unpack

from voxrt import export, octree, voxelize
from voxrt.asset_source import as_text, asset_label, asset_name, load_asset
from voxrt.build_options import DEFAULT_DEPTH, PREVIEW_SIZE, BuildOptions
from voxrt.build_result import BuildResult
from voxrt.export.atomic import write_together
from voxrt.object_selection import crowded_out, refuse_empty, without_objects
from voxrt.output_files import OutputFiles, output_files, refuse_other_asset
from voxrt.outputs import writing
from voxrt.voxelize import AssetError, Scene, SceneWarning
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import ArrayLike

    from voxrt.asset_source import Asset
    from voxrt.baking import Bake
    from voxrt.build_options import BuildKeywords, Fill, UpAxis
    from voxrt.estimate import BuildEstimate
    from voxrt.fitting import BudgetFit, InteriorFit
    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.pictures import Picture
    from voxrt.voxelize import Grid, Viewpoint, Voxelization


_MUCH = 10
"""Percent of the surface that a budget may take without a word about it."""


def build(
    asset: Asset,
    output: str | os.PathLike[str] | None = None,
    options: BuildOptions | None = None,
    *,
    progress: Callable[[str], None] | None = None,
    estimated: Callable[[BuildEstimate], None] | None = None,
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
    options = instance("options", BuildOptions() if options is None else options, BuildOptions)
    names = [field.name for field in fields(BuildOptions)]
    if unknown := sorted(set(keywords) - set(names)):
        raise TypeError(f"build() has no option {unknown[0]!r}; it has {', '.join(names)}")
    if keywords:
        options = replace(options, **keywords)
    files = output_files(asset_name(asset), output, options.preview)
    source = as_text(Path(asset).name if isinstance(asset, str | os.PathLike) else files.name)
    if files.words is not None and not files.named:
        refuse_other_asset(files.words, source)
    clock = _Clock(progress)
    with clock.stage("load"):
        loaded = without_objects(asset_label(asset), load_asset(asset, options), options.ignore)
        if options.camera is not None:
            from voxrt.viewpoint import named_camera  # noqa: PLC0415 - as above

            viewpoint = named_camera(asset_label(asset), loaded, options.camera)
            loaded = replace(loaded, viewpoint=viewpoint)
    _refuse_warnings(asset, loaded.warnings, options)
    scene, grid, voxelization = _voxelize(loaded, options, clock, estimated)
    if not options.allow_empty:
        refuse_empty(asset_label(asset), grid, voxelization)
    with clock.stage("octree"):
        tree = octree.build(voxelization.voxels, threads=options.threads)
        rom = octree.Rom(files.name, tree, scene.materials, grid)
    rom, baked, interior_fit, budget_fit = _finished(rom, asset, (loaded, scene), options, clock)
    view, lighting, unseen = _authored(scene, rom, options)
    warnings = scene.warnings + voxelization.warnings + crowded_out(scene, grid, options) + unseen
    _refuse_warnings(asset, warnings, options)
    picture, unseen_picture = None, None
    if files.preview is not None:
        with clock.stage("preview"):
            from voxrt.sim import SimulatorError  # noqa: PLC0415 - as above
            from voxrt.viewpoint import ViewpointError  # noqa: PLC0415

            try:
                picture = _picture(rom, None if view is None else scene.viewpoint, lighting, options)
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
        export.Source(source, _settings(options)),
        baked,
    )
    with clock.stage("write"):
        result.outputs.update(_write(files, result, options))
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
    from voxrt.from_arrays import mesh_scene  # noqa: PLC0415 - as above

    scene = mesh_scene(vertices, faces, colours=colours, face_colours=face_colours, up=up, unit=unit)
    return build(scene, depth=depth, voxel_size=voxel_size, fill=fill, threads=threads)


class _Clock:
    """The stages of a build and the seconds that each took."""

    def __init__(self, progress: Callable[[str], None] | None) -> None:
        self._progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        if self._progress is not None:
            self._progress(name)
        start = perf_counter()
        yield
        self.seconds[name] = perf_counter() - start


def _voxelize(
    scene: Scene, options: BuildOptions, clock: _Clock, estimated: Callable[[BuildEstimate], None] | None
) -> tuple[Scene, Grid, Voxelization]:
    """Fit a grid, reduce colours to materials, voxelize."""
    depth = DEFAULT_DEPTH if options.depth is None and options.voxel_size is None else options.depth
    geometry, pow2 = options.geometry, options.pow2
    with clock.stage("fit"):
        corners = None if options.bounds is None else (options.bounds[:3], options.bounds[3:])
        grid = voxelize.fit_grid(
            scene, depth=depth, voxel_size=options.voxel_size, geometry=geometry, pow2=pow2, bounds=corners
        )
    if estimated is not None:
        from voxrt.estimate import estimate_build  # noqa: PLC0415 - as above

        estimated(estimate_build(scene, grid, options))
    with clock.stage("colour"):
        scene = voxelize.assign_colours(scene, grid, colours=options.colours, geometry=geometry)
    with clock.stage("voxelize"):
        voxelization = voxelize.voxelize(
            scene, grid, fill=options.fill, geometry=geometry, pow2=pow2, threads=options.threads
        )
    return scene, grid, voxelization


def _finished(
    rom: Rom, asset: Asset, scenes: tuple[Scene, Scene], options: BuildOptions, clock: _Clock
) -> tuple[Rom, Bake | None, InteriorFit | None, BudgetFit | None]:
    """Give hidden voxels their material, bake light and fit the budget, if that is asked for.

    `scenes`: as it was loaded, and with its colours reduced to materials.
    """
    loaded, scene = scenes
    light, baked, interior_fit, budget_fit = None, None, None, None
    interior, budget = options.interior, options.budget
    if interior == "keep" and budget is None and not options.bake:
        return rom, None, None, None
    from voxrt.baking import bake, fit_baked  # noqa: PLC0415 - as above
    from voxrt.fitting import find_material, fit_budget, fit_interior  # noqa: PLC0415

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
        whole = replace(whole, ignore=(), allow_empty=True)  # done by now
        size = len(build(loaded, options=whole).octree.words)
        if size <= words:
            return lesser, size
    return None


def _settings(options: BuildOptions) -> dict[str, str | int | float | bool | None]:
    """Return the options that the manifest names."""
    settings: dict[str, str | int | float | bool | None] = {
        "fill": options.fill,
        "interior": options.interior,
        "geometry": options.geometry,
        "pow2": options.pow2,
        "up": options.up,
        "unit": options.unit,
        "time": options.time,
        "animation": options.animation,
        "variants": ", ".join(options.variants) or None,
        "colours": options.colours,
        "bake": options.bake,
    }
    if options.ignore:
        settings["ignore"] = ", ".join(options.ignore)
    if options.bounds is not None:
        settings["bounds"] = ", ".join(f"{value:g}" for value in options.bounds)
    return settings


def _write(files: OutputFiles, result: BuildResult, options: BuildOptions) -> dict[str, Path]:
    """Write the set of files, all of it or nothing, and return the files by kind."""
    pictures: dict[Path, bytes | None] = {}
    if files.preview is not None:
        from voxrt.sim.image import encode_png  # noqa: PLC0415 - as above

        pictures[files.preview] = None if result.preview is None else encode_png(result.preview.frame.colour)
    outputs: dict[str, Path] = {}
    with ExitStack() as stack:
        for path in (*pictures, files.words):
            if path is not None:
                stack.enter_context(writing(path))
        if files.words is None:
            if result.preview is not None:
                write_together(pictures)
        else:
            written = export.write_rom(
                files.words.parent,
                result.rom,
                stem=files.words.stem,
                suffix=files.words.suffix,
                dialect=options.dialect,
                objects=result.objects,
                warnings=result.warnings,
                seconds=result.seconds,
                source=result.source,
                view=result.view,
                lighting=result.lighting,
                baked=result.baked,
                beside=pictures,
            )
            outputs = {"mem": written.mem, "manifest": written.manifest}
    if files.preview is not None and result.preview is not None:
        outputs["preview"] = files.preview
    return outputs


def _picture(rom: Rom, viewpoint: Viewpoint | None, lighting: Lighting | None, options: BuildOptions) -> Picture:
    from voxrt.pictures import Picture, render  # noqa: PLC0415 - as above
    from voxrt.viewpoint import aim_camera, authored_camera  # noqa: PLC0415

    if viewpoint is not None and rom.grid is not None:
        camera = authored_camera(viewpoint, rom.grid, options.size)
    else:
        camera = aim_camera(rom, options.size)
    frame = render(
        rom,
        camera,
        size=options.size,
        engine=options.engine,
        config="lit" if lighting is not None and lighting.features else "tiny",
        lighting=lighting,
        samples=options.samples,
        background=options.background,
        threads=options.threads,
    )
    return Picture(frame, camera, options.engine)


def _authored(
    scene: Scene, rom: Rom, options: BuildOptions
) -> tuple[Camera | None, Lighting | None, tuple[SceneWarning, ...]]:
    """Return the author's camera and lighting for this memory, and a warning for each that cannot be used.

    A memory with baked light is shown flat, and its author's light is not used.
    """
    mirrors = any(material.mirror for material in scene.materials)
    if scene.viewpoint is None and scene.light is None and not mirrors and not options.bake:
        return None, None, ()
    from voxrt.baking import FLAT  # noqa: PLC0415 - as above
    from voxrt.viewpoint import (  # noqa: PLC0415
        ViewpointError,
        authored_camera,
        authored_lighting,
        stands_inside,
    )

    view, lighting, unseen = None, None, []
    grid = rom.grid
    assert grid is not None
    if scene.viewpoint is not None:
        try:
            view = authored_camera(scene.viewpoint, grid, PREVIEW_SIZE)
        except ViewpointError as error:
            unseen.append(SceneWarning("camera", str(error)))
    if view is not None and stands_inside(rom, view):
        unseen.append(
            SceneWarning("camera", "the scene's camera stands inside a solid; pictures show the whole scene instead")
        )
        view = None
    try:
        lighting = authored_lighting(scene, grid)
    except ViewpointError as error:
        unseen.append(SceneWarning("light", str(error)))
    if options.bake:
        if lighting is not None and lighting.on:
            unseen.append(SceneWarning("light", "the scene's light is not used: the sun and the sky were baked"))
        lighting = FLAT if lighting is None else replace(FLAT, bounces=lighting.bounces)
    return view, lighting, tuple(unseen)


def _refuse_warnings(asset: Asset, warnings: tuple[SceneWarning, ...], options: BuildOptions) -> None:
    """Raise AssetError for the first warning of a build that is strict."""
    if warnings and options.strict:
        first, *others = warnings
        kinds = sorted({warning.kind for warning in others})
        more = f"; and {len(others)} more ({', '.join(kinds)})" if others else ""
        raise AssetError(asset_label(asset), f"{first.message}{more}", fix="correct the asset, or build without strict")
