"""Animation: the frames of an asset, or several assets as frames, to one memory with many roots.

All frames have one grid and one palette, so that equal parts of them are equal blocks of the memory, stored once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

from msgspec.structs import replace

from voxrt import export, octree, voxelize
from voxrt.building.fitting import fit_interior
from voxrt.building.memory import with_means
from voxrt.building.output_files import output_files
from voxrt.building.result import BuildResult
from voxrt.building.view import with_view
from voxrt.building.writing import named_settings, write_result
from voxrt.octree import Animation, AnimationFrame
from voxrt.options.build_options import DEFAULT_DEPTH, BuildOptions
from voxrt.options.option import merge
from voxrt.plans.plan import fit_plan, plan_build
from voxrt.plans.run_plan import run_here
from voxrt.plans.stage_clock import StageClock
from voxrt.sources.frames import open_frames
from voxrt.sources.object_selection import crowded_out, refuse_empty
from voxrt.voxelize import AssetError
from voxrt.voxelize.scene_frames import merge_warnings

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterator, Sequence

    from voxrt.octree import Octree
    from voxrt.options.keywords import BuildKeywords
    from voxrt.plans.estimate import BuildEstimate
    from voxrt.sources.frames import FrameSources
    from voxrt.sources.source import Asset
    from voxrt.voxelize import Grid, ObjectReport, SceneFrames


def build_animation(
    assets: Asset | Sequence[Asset],
    output: str | os.PathLike[str] | None = None,
    options: BuildOptions | None = None,
    *,
    times: Sequence[float] | None = None,
    progress: Callable[[str], None] | None = None,
    estimated: Callable[[BuildEstimate], None] | None = None,
    rendered: Callable[[int, int], None] | None = None,
    **keywords: Unpack[BuildKeywords],
) -> BuildResult:
    """Build one memory of all frames of an animation: each frame is a root of it.

    Parameters
    ----------
    assets
        With `times`, the file whose animation is built. Without, the frames: files or scenes, as :func:`voxrt.build`
        takes them, or a folder, whose assets are the frames in the natural order of their names.
    output
        As for :func:`voxrt.build`.
    options
        As for :func:`voxrt.build`. A budget and baked light are not for animations, and `time` is what `times` says.
    times
        The second of the animation at which each frame is built: see :func:`frame_times`.
    progress, estimated, rendered, **keywords
        As for :func:`voxrt.build`.

    Returns
    -------
    BuildResult
        ``animation`` has the roots. ``blob.frame(k)`` is the memory as frame k shows it.

    Raises
    ------
    TypeError, ValueError
        An option of the wrong type or out of range, or one that is not for animations; no frame.
    AssetError
        An asset cannot be honoured, or nothing of it moves.
    DoesNotFitError
        The frames are too many for their depth, or have too many materials together.
    OutputError, SimulatorError
        As :func:`voxrt.build`.

    Examples
    --------
    >>> import voxrt
    >>> built = voxrt.build_animation(["examples/house.obj", "examples/dog.usda"], depth=5)
    >>> [frame.name for frame in built.animation.frames]
    ['house.obj', 'dog.usda']
    >>> built.animation.roots
    (1, 2)
    """
    options = merge("build_animation", BuildOptions, options, keywords)
    _refuse_options(options)
    frames = open_frames(assets, options, times)
    first, count = frames.sources[0], len(frames.sources)
    if options.voxel_size is None:
        octree.check_frame_count(options.depth or DEFAULT_DEPTH, count)
    files = output_files(frames.name, frames.file_name, output, options.preview)
    clock = StageClock(progress)
    with clock.stage("load"):
        scenes = voxelize.join_scenes(source.load() for source in frames.sources)
    if count > 1 and not scenes.moves:
        raise AssetError(
            first.label, f"nothing moves: all {count} frames are equal", fix="choose other times, or another asset"
        )
    scenes = replace(scenes, union=first.with_camera(scenes.union))
    first.refuse_warnings(scenes.union.warnings)
    plan = fit_plan(scenes.union, options, clock, on_disk=False)
    octree.check_frame_count(plan.grid.depth, count)
    if estimated is not None:
        estimated(plan.estimate)
    with clock.stage("colour"):
        placed = voxelize.place_points(
            scenes.union, plan.grid, colours=options.colours, fill=options.fill_per_object, geometry=options.geometry
        )
        scenes = replace(scenes, union=placed).coloured(plan.grid, colours=options.colours, geometry=options.geometry)
    result = with_view(_join_frames(files.name, frames, scenes, plan.grid, clock), options)
    result = replace(result, warnings=merge_warnings(result.warnings))
    first.refuse_warnings(result.warnings)
    settings = {**named_settings(options), "frames": count}
    result = replace(result, source=export.Source(files.source, settings))
    result, error = write_result(files, result, options, clock, rendered)
    if error is not None:
        raise error
    return result


def _refuse_options(options: BuildOptions) -> None:
    if options.scheduler is not None or options.workers is not None:
        raise ValueError("an animation is built on one machine: leave scheduler and workers out")
    if options.bake:
        raise ValueError("light is not baked into animations: leave bake out")
    if options.budget is not None:
        raise ValueError("an animation is not fitted to a budget: leave it out, and choose a smaller depth")


def _join_frames(name: str, frames: FrameSources, scenes: SceneFrames, grid: Grid, clock: StageClock) -> BuildResult:
    """Build the memory of all frames, whose voxels are released frame by frame; DoesNotFitError if all are empty."""
    first, options, union = frames.sources[0], frames.sources[0].options, scenes.union
    words: list[int] = []  # of each frame alone
    objects: list[ObjectReport] = []  # of the first frame
    warnings = list(union.warnings)
    solid = False

    def octrees() -> Iterator[Octree]:
        nonlocal solid
        for number in range(len(frames.sources)):
            scene = scenes.scene(number)
            tree, report = run_here(plan_build(scene, grid, options, on_disk=False), scene, clock, options=options)
            if options.interior != "keep":
                with clock.stage("interior"):
                    rom = octree.Rom("", tree, union.materials)
                    tree = fit_interior(rom, options.interior, first.label)[0].octree
            words.append(len(tree.words))
            objects.extend(report.objects if number == 0 else ())
            warnings.extend(report.warnings)
            solid = solid or any(one.voxels for one in report.objects)
            yield tree
        if not solid and not options.allow_empty:
            refuse_empty(first.label, grid, ())

    with clock.stage("octree"):
        tree, roots = octree.join_frames(octrees())
    frame_rows = zip(roots, words, frames.sources, frames.names, strict=True)
    animation = Animation(
        tuple(AnimationFrame(root, size, one.options.time, frame) for root, size, one, frame in frame_rows)
    )
    warnings += crowded_out(scenes.scene(0), grid, options)
    rom = with_means(octree.Rom(name, tree, union.materials, grid), options, clock, roots)
    return BuildResult(rom, union, tuple(objects), tuple(warnings), seconds=clock.seconds, animation=animation)
