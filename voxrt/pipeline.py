"""From an asset to files for the hardware, in one call: load, fit, voxelize, build, write, preview."""

from __future__ import annotations

import os
from contextlib import contextmanager
from dataclasses import fields, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Unpack

from voxrt import export, octree, voxelize
from voxrt.asset_source import as_text, asset_name, load_asset
from voxrt.build_options import DEFAULT_DEPTH, PREVIEW_SIZE, BuildOptions
from voxrt.build_result import BuildResult
from voxrt.fitting import find_material, fit_budget, fit_interior
from voxrt.from_arrays import mesh_scene
from voxrt.outputs import check_folder, uninterrupted, writing
from voxrt.pictures import Picture, render, save_picture
from voxrt.viewpoint import ViewpointError, aim_camera, authored_camera, authored_lighting
from voxrt.voxelize import AssetError, Scene, SceneWarning
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import ArrayLike

    from voxrt.asset_source import Asset
    from voxrt.build_options import BuildKeywords, Fill, UpAxis
    from voxrt.fitting import BudgetFit, InteriorFit
    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.voxelize import Grid, Voxelization


def build(
    asset: Asset,
    output: str | os.PathLike[str] | None = None,
    options: BuildOptions | None = None,
    *,
    progress: Callable[[str], None] | None = None,
    **keywords: Unpack[BuildKeywords],
) -> BuildResult:
    """Build the octree memory of an asset, and write it with its manifest and its preview.

    Parameters
    ----------
    asset
        A glTF, OBJ, USD, STL or PLY file, or a scene of some (.toml); a mesh or a scene of trimesh; vertices and faces
        as arrays, ``(vertices, faces)``; a :class:`Scene`.
    output
        Folder for ``NAME.mem`` and ``NAME.json``. It is made if it is missing. None writes neither. NAME is the name
        of the file or of the scene.
    options
        How to build; None for the defaults.
    progress
        Called with the name of each stage as it begins.
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
        A file cannot be written. Old files stay as they were.
    SimulatorError
        The preview cannot be rendered. The memory and the manifest are complete by then.

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
    name = asset_name(asset)
    picture_file = _picture_file(name, output, options)
    clock = _Clock(progress)
    with clock.stage("load"):
        scene = load_asset(asset, options)
    _refuse_warnings(asset, scene, scene.warnings, options)
    scene, grid, voxelization = _voxelize(scene, options, clock)
    with clock.stage("octree"):
        tree = octree.build(voxelization.voxels, threads=options.threads)
        rom = octree.Rom(name, tree, scene.materials, grid)
    rom, interior_fit, budget_fit = _made_smaller(rom, asset, scene, options, clock)
    view, lighting, unseen = _authored(scene, grid)
    warnings = scene.warnings + voxelization.warnings + unseen
    _refuse_warnings(asset, scene, warnings, options)
    outputs: dict[str, Path] = {}
    if output is not None:
        source = asset if isinstance(asset, str | os.PathLike) else name
        with clock.stage("write"), writing(Path(output)), uninterrupted():
            files = export.write_rom(
                Path(output),
                rom,
                dialect=options.dialect,
                objects=voxelization.objects,
                warnings=warnings,
                seconds=clock.seconds,
                source=export.Source(as_text(Path(source).name), _settings(options)),
                view=view,
                lighting=lighting,
            )
        outputs |= {"mem": files.mem, "manifest": files.manifest}
    picture = None
    if picture_file is not None:
        with clock.stage("preview"):
            picture = _picture(rom, scene, lighting, options)
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
        clock.seconds,
        {"voxelize": voxelization.seconds},
        view,
        lighting,
    )


def voxelize_mesh(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    depth: int | None = None,
    voxel_size: float | None = None,
    colours: ArrayLike | None = None,
    face_colours: ArrayLike | None = None,
    fill: Fill = "solid",
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


def _voxelize(scene: Scene, options: BuildOptions, clock: _Clock) -> tuple[Scene, Grid, Voxelization]:
    """Fit a grid, reduce colours to materials, voxelize."""
    depth = DEFAULT_DEPTH if options.depth is None and options.voxel_size is None else options.depth
    geometry, pow2 = options.geometry, options.pow2
    with clock.stage("fit"):
        grid = voxelize.fit_grid(scene, depth=depth, voxel_size=options.voxel_size, geometry=geometry, pow2=pow2)
    with clock.stage("colour"):
        scene = voxelize.assign_colours(scene, grid, colours=options.colours, geometry=geometry)
    with clock.stage("voxelize"):
        voxelization = voxelize.voxelize(
            scene, grid, fill=options.fill, geometry=geometry, pow2=pow2, threads=options.threads
        )
    return scene, grid, voxelization


def _made_smaller(
    rom: Rom, asset: Asset, scene: Scene, options: BuildOptions, clock: _Clock
) -> tuple[Rom, InteriorFit | None, BudgetFit | None]:
    """Give hidden voxels their material and fit the budget, if that is asked for."""
    interior_fit, budget_fit = None, None
    interior, budget = options.interior, options.budget
    if interior != "keep":
        with clock.stage("interior"):
            material = None if interior == "any" else find_material(_label(asset, scene), scene, interior)
            rom, interior_fit = fit_interior(rom, material)
    if budget is not None:
        with clock.stage("budget"):
            words = octree.BOARDS[budget] if isinstance(budget, str) else budget
            rom, budget_fit = fit_budget(rom, words, options.size, options.threads)
    return rom, interior_fit, budget_fit


def _settings(options: BuildOptions) -> dict[str, str | int | float | bool | None]:
    """Return the options that the manifest names."""
    return {
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
    }


def _picture_file(name: str, output: str | os.PathLike[str] | None, options: BuildOptions) -> Path | None:
    """Check that the folders can be written to, and return the file of the preview; None for none."""
    if output is not None:
        check_folder(Path(output))
    if not options.preview:
        return None
    file = Path(output or ".") / f"{name}.preview.png" if options.preview is True else Path(options.preview)
    check_folder(file.parent)
    return file


def _picture(rom: Rom, scene: Scene, lighting: Lighting | None, options: BuildOptions) -> Picture:
    if scene.viewpoint is not None and rom.grid is not None:
        camera = authored_camera(scene.viewpoint, rom.grid, options.size)
    else:
        camera = aim_camera(rom, options.size)
    frame = render(
        rom,
        camera,
        size=options.size,
        engine=options.engine,
        config="lit" if lighting is not None and lighting.features else "tiny",
        lighting=lighting,
        threads=options.threads,
    )
    return Picture(frame, camera, options.engine)


def _authored(scene: Scene, grid: Grid) -> tuple[Camera | None, Lighting | None, tuple[SceneWarning, ...]]:
    """Return the author's camera and lighting for this grid, and a warning for each that the registers cannot hold."""
    view, lighting, unseen = None, None, []
    if scene.viewpoint is not None:
        try:
            view = authored_camera(scene.viewpoint, grid, PREVIEW_SIZE)
        except ViewpointError as error:
            unseen.append(SceneWarning("camera", str(error)))
    try:
        lighting = authored_lighting(scene, grid)
    except ViewpointError as error:
        unseen.append(SceneWarning("light", str(error)))
    return view, lighting, tuple(unseen)


def _label(asset: Asset, scene: Scene) -> str:
    """Return what errors call an asset: the file's path, else the scene's name."""
    return os.fspath(asset) if isinstance(asset, str | os.PathLike) else scene.name


def _refuse_warnings(asset: Asset, scene: Scene, warnings: tuple[SceneWarning, ...], options: BuildOptions) -> None:
    """Raise AssetError for the first warning of a build that is strict."""
    if warnings and options.strict:
        first, *others = warnings
        kinds = sorted({warning.kind for warning in others})
        more = f"; and {len(others)} more ({', '.join(kinds)})" if others else ""
        raise AssetError(
            _label(asset, scene), f"{first.message}{more}", fix="correct the asset, or build without strict"
        )
