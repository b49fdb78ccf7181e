"""Baked light in a build: what it took, and the palette that a budget affords."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import msgspec
from msgspec.structs import replace

from voxrt import sim
from voxrt.building.fitting import fit_budget
from voxrt.export import BakedLight
from voxrt.octree.camera import Lighting
from voxrt.sim.baking.bake import MOST_COLOURS, bake_light
from voxrt.sim.baking.daylight import Daylight, sky_light
from voxrt.views.viewpoint import aim_camera

if TYPE_CHECKING:
    from voxrt.building.fitting import BudgetFit
    from voxrt.octree import Rom
    from voxrt.options.build_options import BuildOptions
    from voxrt.sim.baking.bake import BakedLight as Light
    from voxrt.voxelize import Scene

Bake: TypeAlias = BakedLight
"""What was baked, and what it took: what the manifest says of it."""

FLAT = Lighting(flat=True)
"""The lighting of memories with baked light."""

_PALETTES = (MOST_COLOURS, 64, 16)
"""Colours that are tried where a memory does not fit its budget with all of them."""


def bake(rom: Rom, scene: Scene, options: BuildOptions) -> tuple[Rom, Light, Bake]:
    """Bake the light that `options` describe into the colours of `rom`."""
    daylight = Daylight(options.sun, sky_light(options.sky), options.bake_samples)
    light = bake_light(rom, scene, daylight, geometry=options.geometry, threads=options.threads)
    baked = light.memory(threads=options.threads)
    words_before, words = len(rom.octree.words), len(baked.octree.words)
    voxels = len(light.voxels)
    return baked, light, Bake(daylight.sun, daylight.sky, daylight.samples, voxels, MOST_COLOURS, words_before, words)


def fit_baked(baked: Rom, light: Light, made: Bake, words: int, options: BuildOptions) -> tuple[Rom, BudgetFit, Bake]:
    """Fit a memory with baked light to a budget: with all its colours, or with fewer where that looks more alike.

    Fewer colours let more blocks be shared, so less detail is given up. Likeness is the PSNR of the default picture,
    held against that of the memory with all colours.
    """
    camera = aim_camera(baked, options.size)

    def picture(rom: Rom) -> sim.Frame:
        return sim.render(rom, camera, options.size, engine="model", lighting=FLAT, threads=options.threads)

    whole = picture(baked)
    found = []
    for colours in _PALETTES:
        rom = baked if colours == MOST_COLOURS else light.memory(colours, threads=options.threads)
        fitted, fit = fit_budget(rom, words, options.size, options.threads, lighting=FLAT)
        shown = picture(fitted).colour
        psnr = sim.peak_signal_to_noise(whole.colour, shown)
        ssim = sim.structural_similarity(whole.colour, shown)
        found.append((psnr, fitted, replace(fit, psnr=psnr, ssim=ssim), msgspec.structs.replace(made, colours=colours)))
        if not fit.fit.changed:
            break
    _, fitted, fit, described = max(found, key=lambda one: one[0])
    return fitted, fit, described
