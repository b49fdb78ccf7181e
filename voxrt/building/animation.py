"""Animation: the frames of an asset, or several assets as frames, to one memory with many roots.

All frames have one grid and one palette, so that equal parts of them are equal blocks of the memory, stored once.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from voxrt import export, octree, voxelize
from voxrt.building.animation_takes import takes_of
from voxrt.building.fitting import find_material, fit_interior
from voxrt.building.grid import build_grid
from voxrt.building.output_files import output_files, refuse_other_asset
from voxrt.building.result import BuildResult
from voxrt.building.view import authored_view, preview
from voxrt.building.writing import named_settings, write_build
from voxrt.octree import Animation, AnimationFrame
from voxrt.options.build_options import DEFAULT_DEPTH, merge_options
from voxrt.plans.blockwise import build_octree, plan_build
from voxrt.plans.stage_clock import StageClock
from voxrt.sim import SimulatorError, frame_animation
from voxrt.sources.object_selection import crowded_out, refuse_empty, without_objects
from voxrt.sources.source import as_text, asset_label, load_asset, refuse_warnings
from voxrt.views.viewpoint import ViewpointError, authored_camera, named_camera
from voxrt.voxelize import AssetError
from voxrt.voxelize.scene_frames import merge_warnings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from voxrt.building.animation_takes import Take
    from voxrt.octree import Octree
    from voxrt.options.build_options import BuildOptions
    from voxrt.options.keywords import BuildKeywords
    from voxrt.plans.estimate import BuildEstimate
    from voxrt.sources.source import Asset
    from voxrt.views.pictures import Picture
    from voxrt.voxelize import Grid, ObjectReport, SceneFrames, SceneWarning


def build_animation(
    assets: Asset | Sequence[Asset],
    output: str | os.PathLike[str] | None = None,
    options: BuildOptions | None = None,
    *,
    times: Sequence[float] | None = None,
    progress: Callable[[str], None] | None = None,
    estimated: Callable[[BuildEstimate], None] | None = None,
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
    progress, estimated, **keywords
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
    options = merge_options("build_animation", options, keywords)
    _refuse_options(options)
    name, takes = takes_of(assets, options, times)
    if options.voxel_size is None:
        octree.check_frame_count(options.depth or DEFAULT_DEPTH, len(takes))
    files = output_files(name, output, options.preview)
    source = as_text(Path(assets).name if isinstance(assets, str | os.PathLike) else files.name)
    if files.words is not None and not files.named:
        refuse_other_asset(files.words, source)
    clock = StageClock(progress)
    scenes = _load(takes, options, clock)
    with clock.stage("fit"):
        grid = build_grid(scenes.union, options)
        octree.check_frame_count(grid.depth, len(takes))
    if estimated is not None:
        estimated(plan_build(scenes.union, grid, options, on_disk=False).estimate)
    with clock.stage("colour"):
        scenes = scenes.coloured(grid, colours=options.colours, geometry=options.geometry)
    made = _Frames(scenes, grid, options, asset_label(takes[0].asset), clock)
    with clock.stage("octree"):
        tree, roots = octree.join_frames(made.octrees())
    rom = octree.Rom(files.name, tree, scenes.union.materials, grid)
    if options.lod or options.dialect == "lod":
        with clock.stage("lod"):
            rom = octree.with_means(rom, roots)
    animation = Animation(
        tuple(
            AnimationFrame(root, words, take.options.time, take.name)
            for root, words, take in zip(roots, made.words, takes, strict=True)
        )
    )
    view, lighting, unseen = authored_view(scenes.union, rom, options)
    crowded = crowded_out(scenes.scene(0), grid, options)
    warnings = merge_warnings((*scenes.union.warnings, *made.warnings, *crowded, *unseen))
    refuse_warnings(takes[0].asset, warnings, options)
    result = BuildResult(
        rom,
        scenes.union,
        made.reports,
        warnings,
        seconds=clock.seconds,
        view=view,
        lighting=lighting,
        source=export.Source(source, {**named_settings(options), "frames": len(takes)}),
        animation=animation,
    )
    unseen_picture = None
    if files.preview is not None:
        with clock.stage("preview"):
            try:
                result = replace(result, preview=_preview(result, options))
            except (SimulatorError, ViewpointError) as error:
                unseen_picture = error  # the memory is sound: it is written first
    with clock.stage("write"):
        result.outputs.update(write_build(files, result, options))
    if unseen_picture is not None:
        raise unseen_picture
    return result


def _refuse_options(options: BuildOptions) -> None:
    if options.scheduler is not None or options.workers is not None:
        raise ValueError("an animation is built on one machine: leave scheduler and workers out")
    if options.bake:
        raise ValueError("light is not baked into animations: leave bake out")
    if options.budget is not None:
        raise ValueError("an animation is not fitted to a budget: leave it out, and choose a smaller depth")


def _load(takes: tuple[Take, ...], options: BuildOptions, clock: StageClock) -> SceneFrames:
    """Load the scenes of all frames; each is released when the next one is loaded."""
    label = asset_label(takes[0].asset)
    with clock.stage("load"):
        scenes = voxelize.join_scenes(
            without_objects(asset_label(take.asset), load_asset(take.asset, take.options), options.ignore)
            for take in takes
        )
    if len(takes) > 1 and not scenes.moves:
        raise AssetError(
            label, f"nothing moves: all {len(takes)} frames are equal", fix="choose other times, or another asset"
        )
    if options.camera is not None:
        viewpoint = named_camera(label, scenes.union, options.camera)
        scenes = replace(scenes, union=replace(scenes.union, viewpoint=viewpoint))
    refuse_warnings(takes[0].asset, scenes.union.warnings, options)
    return scenes


def _preview(result: BuildResult, options: BuildOptions) -> Picture:
    """Render the first frame, with the author's camera or one that sees all frames."""
    viewpoint, grid = result.scene.viewpoint, result.rom.grid
    assert grid is not None
    assert result.animation is not None
    if result.view is not None and viewpoint is not None:
        camera = authored_camera(viewpoint, grid, options.size)
    else:
        camera = frame_animation(result.rom, result.animation.roots, options.size)
    return preview(result.rom, camera, result.lighting, options)


class _Frames:
    """The frames of an animation, voxelized one after another.

    Attributes
    ----------
    words
        Words of each frame alone.
    reports
        How each object of the first was voxelized.
    warnings
        Those of all.
    """

    def __init__(self, scenes: SceneFrames, grid: Grid, options: BuildOptions, label: str, clock: StageClock) -> None:
        self._scenes, self._grid, self._options, self._label, self._clock = scenes, grid, options, label, clock
        self.words: list[int] = []
        self.reports: tuple[ObjectReport, ...] = ()
        self.warnings: list[SceneWarning] = []

    def octrees(self) -> Iterator[Octree]:
        """Voxelize the frames; their voxels are released frame by frame.

        Raises
        ------
        DoesNotFitError
            All frames are empty.
        """
        options, solid = self._options, False
        for number in range(len(self._scenes.counts)):
            tree, made = build_octree(self._scenes.scene(number), self._grid, options, self._clock)
            self.reports = made.objects if number == 0 else self.reports
            self.warnings += made.warnings
            solid = solid or any(report.voxels for report in made.objects)
            tree = self._with_interior(tree)
            self.words.append(len(tree.words))
            yield tree
        if not solid and not options.allow_empty:
            refuse_empty(self._label, self._grid, made.objects)

    def _with_interior(self, tree: Octree) -> Octree:
        """Give hidden voxels the material that is asked for."""
        wanted, materials = self._options.interior, self._scenes.union.materials
        if wanted == "keep":
            return tree
        with self._clock.stage("interior"):
            material = None if wanted == "any" else find_material(self._label, materials, wanted)
            return fit_interior(octree.Rom("", tree, materials), material)[0].octree
