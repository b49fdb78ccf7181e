"""From a planned scene to a memory: colours, voxels, octree, and what the options ask to be done with them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt import octree
from voxrt.building.result import BuildResult
from voxrt.plans.plan import fit_plan
from voxrt.plans.run_plan import run_here
from voxrt.plans.stage_clock import StageClock
from voxrt.plans.tile_tasks import scene_on_grid
from voxrt.sources.object_selection import crowded_out, refuse_empty
from voxrt.voxelize.formats.external_files import as_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt.octree import Rom
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.plan import BuildPlan
    from voxrt.plans.run_plan import RunPlan
    from voxrt.voxelize import Scene

_MUCH = 10
"""Percent of the surface that a budget may take without a word about it."""


def make_memory(
    loaded: Scene, plan: BuildPlan, options: BuildOptions, clock: StageClock, run: RunPlan, *, name: str, label: str
) -> BuildResult:
    """Voxelize a scene as it was loaded, build its octree by `run`, and finish the memory as the options ask.

    `name` is that of the memory, `label` what errors call the asset. AssetError if the scene has no such material for
    its interior, DoesNotFitError if no object has a voxel or the budget is too small; and the errors of `run`.
    """
    with clock.stage("colour"):
        scene = scene_on_grid(loaded, plan.grid, options)
    tree, report = run(plan, scene, clock)
    if not options.allow_empty:
        refuse_empty(label, plan.grid, report.objects, options.points)
    warnings = scene.warnings + report.warnings + crowded_out(scene, plan.grid, options)
    parts = {"voxelize": report.seconds}
    rom = octree.Rom(name, tree, scene.materials, plan.grid)
    result = BuildResult(rom, scene, report.objects, warnings, seconds=clock.seconds, parts=parts)
    if options.interior != "keep" or options.bake or options.budget is not None:
        result = _finished(result, options, clock, label)
        if result.budget is not None and result.budget.fit.percent_changed > _MUCH:
            with clock.stage("budget"):
                lossless = _lossless_depth(loaded, options, tree.depth, result.budget.words)
            result = replace(result, budget=replace(result.budget, lossless=lossless))
    return replace(result, rom=with_means(result.rom, options, clock))


def with_means(rom: Rom, options: BuildOptions, clock: StageClock, roots: Sequence[int] = (0,)) -> Rom:
    """Give a memory its mean materials, if the options ask for levels of detail, in the stage "lod"."""
    if not options.lod and options.dialect != "lod":
        return rom
    with clock.stage("lod"):
        return octree.with_means(rom, roots)


def _finished(result: BuildResult, options: BuildOptions, clock: StageClock, label: str) -> BuildResult:
    """Give hidden voxels their material, bake light and fit the budget, if that is asked for."""
    from voxrt.building.baking import bake, fit_baked  # noqa: PLC0415 - slow to import, and few builds do this
    from voxrt.building.fitting import fit_budget, fit_interior  # noqa: PLC0415

    rom, light, baked, interior, budget = result.rom, None, None, None, None
    if options.interior not in ("keep", "any"):
        with clock.stage("interior"):
            rom, interior = fit_interior(rom, options.interior, label)
    if options.bake:
        with clock.stage("bake"):
            rom, light, baked = bake(rom, result.scene, options)
    if options.interior == "any":  # what hidden voxels may share depends on the colours of all others
        with clock.stage("interior"):
            rom, interior = fit_interior(rom, options.interior, label)
    if options.budget is not None:
        with clock.stage("budget"):
            words = octree.BOARDS[options.budget] if isinstance(options.budget, str) else options.budget
            if light is None or baked is None:
                rom, budget = fit_budget(rom, words, options.size, options.threads)
            else:
                rom, budget, baked = fit_baked(rom, light, baked, words, options)
    return replace(result, rom=rom, bake=baked, interior=interior, budget=budget)


def _lossless_depth(loaded: Scene, options: BuildOptions, depth: int, words: int) -> tuple[int, int] | None:
    """Find the greatest lesser depth at which a scene fits so many words, and its words there; None if none does."""
    for lesser in range(depth - 1, 0, -1):
        whole = replace(options, depth=lesser, voxel_size=None, budget=None, allow_empty=True)
        clock, run, name = StageClock(None), partial(run_here, options=whole), as_text(loaded.name)
        plan = fit_plan(loaded, whole, clock, on_disk=False)
        size = len(make_memory(loaded, plan, whole, clock, run, name=name, label=name).octree.words)
        if size <= words:
            return lesser, size
    return None
