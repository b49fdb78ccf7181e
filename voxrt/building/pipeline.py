"""From an asset to files for the hardware, in one call: load, fit, voxelize, build, finish, write."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING, Unpack

from msgspec.structs import replace

from voxrt import export
from voxrt.building.memory import make_memory
from voxrt.building.output_files import output_files
from voxrt.building.view import with_view
from voxrt.building.writing import named_settings, write_result
from voxrt.options.build_options import BuildOptions
from voxrt.options.option import merge
from voxrt.plans.plan import fit_plan
from voxrt.plans.run_plan import choose_runner
from voxrt.plans.stage_clock import StageClock
from voxrt.plans.tile_store import TileStore
from voxrt.sources.source import open_source

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from voxrt.building.result import BuildResult
    from voxrt.options.build_options import Fill, UpAxis
    from voxrt.options.keywords import BuildKeywords
    from voxrt.plans.by_workers import ClusterProgress
    from voxrt.plans.estimate import BuildEstimate
    from voxrt.sources.source import Asset, Source


def build(
    asset: Asset,
    output: str | os.PathLike[str] | None = None,
    options: BuildOptions | None = None,
    *,
    progress: Callable[[str], None] | None = None,
    estimated: Callable[[BuildEstimate], None] | None = None,
    clustered: Callable[[ClusterProgress], None] | None = None,
    rendered: Callable[[int, int], None] | None = None,
    **keywords: Unpack[BuildKeywords],
) -> BuildResult:
    """Build the octree memory of an asset, and write it with its manifest and its preview.

    Parameters
    ----------
    asset
        A glTF, Blender, OBJ, USD, STL or PLY file, or a scene of some (.toml); a mesh or a scene of trimesh; vertices
        and faces as arrays, ``(vertices, faces)``; a :class:`Scene`.
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
    rendered
        Called with the rows of the preview that are done, and with all of them.
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
    options = merge("build", BuildOptions, options, keywords)
    source = open_source(asset, options)
    _check_workers(source, output)
    files = output_files(source.name, source.file_name, output, options.preview)
    clock = StageClock(progress)
    with clock.stage("load"):
        scene = source.with_camera(source.load())
    source.refuse_warnings(scene.warnings)
    with nullcontext() if files.tiles is None else TileStore(files.tiles) as store:
        plan = fit_plan(scene, options, clock, on_disk=store is not None)
        if estimated is not None:
            estimated(plan.estimate)
        run = choose_runner(source, store, clustered)
        result = make_memory(scene, plan, options, clock, run, name=files.name, label=source.label)
        result = with_view(result, options)
        source.refuse_warnings(result.warnings)
        result = replace(result, source=export.Source(files.source, named_settings(options)))
        result, error = write_result(files, result, options, clock, rendered)
    if error is not None:
        raise error
    if result.preview is not None:  # what programs read keeps its order
        clock.seconds["preview"] = clock.seconds.pop("preview")
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
    from voxrt.voxelize.from_arrays import mesh_scene  # noqa: PLC0415 - most builds are of files

    scene = mesh_scene(vertices, faces, colours=colours, face_colours=face_colours, up=up, unit=unit)
    return build(scene, depth=depth, voxel_size=voxel_size, fill=fill, threads=threads)


def _check_workers(source: Source, output: str | os.PathLike[str] | None) -> None:
    """Refuse a build by workers that has nowhere to put its tiles, or whose workers could not open the asset."""
    if source.options.scheduler is None and source.options.workers is None:
        return
    if output is None:
        raise ValueError("a cluster writes its tiles beside the output: name an output")
    if source.file is None:
        raise TypeError(
            f"the workers of a cluster open the asset's file: give its path, not {type(source.value).__name__}"
        )
