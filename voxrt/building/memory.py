"""From a planned scene to a memory: colours, voxels, octree, and what the options ask to be done with them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from voxrt import octree, voxelize
from voxrt.building.result import BuildResult
from voxrt.plans.plan import fit_plan
from voxrt.plans.run_plan import run_plan
from voxrt.plans.stage_clock import StageClock
from voxrt.sources.object_selection import crowded_out, refuse_empty
from voxrt.sources.source import open_source

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from voxrt.octree import Rom
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.by_workers import ClusterProgress
    from voxrt.plans.plan import BuildPlan
    from voxrt.plans.tile_store import TileStore
    from voxrt.sources.source import Source
    from voxrt.voxelize import Scene

_MUCH = 10
"""Percent of the surface that a budget may take without a word about it."""


def make_memory(
    name: str,
    loaded: Scene,
    plan: BuildPlan,
    source: Source,
    clock: StageClock,
    *,
    store: TileStore | None = None,
    clustered: Callable[[ClusterProgress], None] | None = None,
) -> BuildResult:
    """Voxelize a scene as it was loaded, build its octree, and finish the memory as the options of its source ask.

    Raises
    ------
    AssetError
        The scene has no such material for its interior.
    DoesNotFitError
        No object has a voxel, or the budget is too small.
    OutputError, ToolError
        As :func:`voxrt.plans.run_plan.run_plan`.
    """
    options = source.options
    with clock.stage("colour"):
        scene = voxelize.assign_colours(loaded, plan.grid, colours=options.colours, geometry=options.geometry)
    tree, report = run_plan(plan, scene, source, clock, store=store, clustered=clustered)
    if not options.allow_empty:
        refuse_empty(source.label, plan.grid, report.objects)
    warnings = scene.warnings + report.warnings + crowded_out(scene, plan.grid, options)
    rom = octree.Rom(name, tree, scene.materials, plan.grid)
    result = BuildResult(
        rom, scene, report.objects, warnings, seconds=clock.seconds, parts={"voxelize": report.seconds}
    )
    if options.interior != "keep" or options.bake or options.budget is not None:
        result = _finished(result, loaded, source, clock)
    return replace(result, rom=with_means(result.rom, options, clock))


def with_means(rom: Rom, options: BuildOptions, clock: StageClock, roots: Sequence[int] = (0,)) -> Rom:
    """Give a memory its mean materials, if the options ask for levels of detail, in the stage "lod"."""
    if not options.lod and options.dialect != "lod":
        return rom
    with clock.stage("lod"):
        return octree.with_means(rom, roots)


def _finished(result: BuildResult, loaded: Scene, source: Source, clock: StageClock) -> BuildResult:
    """Give hidden voxels their material, bake light and fit the budget, if that is asked for."""
    from voxrt.building.baking import bake, fit_baked  # noqa: PLC0415 - slow to import, and few builds do this
    from voxrt.building.fitting import fit_budget, fit_interior  # noqa: PLC0415

    options, rom = source.options, result.rom
    light, baked, interior, budget = None, None, None, None
    if options.interior not in ("keep", "any"):
        with clock.stage("interior"):
            rom, interior = fit_interior(rom, options.interior, source.label)
    if options.bake:
        with clock.stage("bake"):
            rom, light, baked = bake(rom, result.scene, options)
    if options.interior == "any":  # what hidden voxels may share depends on the colours of all others
        with clock.stage("interior"):
            rom, interior = fit_interior(rom, options.interior, source.label)
    if options.budget is not None:
        with clock.stage("budget"):
            words = octree.BOARDS[options.budget] if isinstance(options.budget, str) else options.budget
            if light is None or baked is None:
                rom, budget = fit_budget(rom, words, options.size, options.threads)
            else:
                rom, budget, baked = fit_baked(rom, light, baked, words, options)
            if budget.fit.percent_changed > _MUCH:
                budget = replace(budget, lossless=_lossless_depth(loaded, options, rom.octree.depth, words))
    return replace(result, rom=rom, bake=baked, interior=interior, budget=budget)


def _lossless_depth(loaded: Scene, options: BuildOptions, depth: int, words: int) -> tuple[int, int] | None:
    """Find the greatest lesser depth at which a scene fits so many words, and its words there; None if none does."""
    for lesser in range(depth - 1, 0, -1):
        whole = replace(options, depth=lesser, voxel_size=None, budget=None, allow_empty=True)
        source, clock = open_source(loaded, whole), StageClock(None)
        plan = fit_plan(loaded, whole, clock, on_disk=False)
        size = len(make_memory(source.name, loaded, plan, source, clock).octree.words)
        if size <= words:
            return lesser, size
    return None
