"""A memory made smaller: hidden voxels that may be anything, and what a budget wants given up."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt import octree, sim
from voxrt.viewpoint import aim_camera
from voxrt.voxelize import AssetError

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.octree import Rom
    from voxrt.voxelize import Scene


@dataclass(frozen=True, eq=False, slots=True)
class BudgetFit:
    """What fitting a memory to a budget took.

    Attributes
    ----------
    words
        The budget.
    fit
        What was shared and what was given up, in words and voxels.
    psnr, ssim
        How like the whole scene's picture is to that of the unfitted memory: decibel, infinite for equal pictures;
        1 for equal pictures.
    """

    words: int
    fit: octree.Fit
    psnr: float
    ssim: float


@dataclass(frozen=True, slots=True)
class InteriorFit:
    """What became of the voxels that no ray from outside can reach.

    Attributes
    ----------
    material
        The id of the material that they have now; None where each took whatever lets most blocks be shared.
    hidden
        How many they are.
    words_before
        Words of the memory that keeps them.
    """

    material: int | None
    hidden: int
    words_before: int


def find_material(asset: Path, scene: Scene, wanted: int | str) -> int:
    """Find the id of a material that is asked for by name or by id.

    Raises
    ------
    AssetError
        The scene has none such.
    """
    names = [material.name for material in scene.materials]
    if wanted in names[1:]:
        return 1 + names[1:].index(str(wanted))
    number = int(wanted) if isinstance(wanted, int) or wanted.isdecimal() else 0
    if 1 <= number < len(names):
        return number
    there = ", ".join(f"{number} {name}" for number, name in enumerate(names[1:9], 1)) + ", ..." * (len(names) > 9)
    raise AssetError(
        asset, f"has no material {wanted!r} for its interior", fix=f"name one of: {there or 'it has none'}"
    )


def fit_interior(rom: Rom, material: int | None) -> tuple[Rom, InteriorFit]:
    """Give the hidden voxels of `rom` the material, or each what lets most blocks be shared."""
    whole, hidden = rom.octree, octree.hidden_voxels(rom.octree)
    tree = octree.share_hidden(whole, hidden) if material is None else octree.fill_hidden(whole, hidden, material)
    found = octree.census(hidden).solid_voxels
    return replace(rom, octree=tree), InteriorFit(material, found, len(whole.words))


def fit_budget(rom: Rom, words: int, size: tuple[int, int], threads: int) -> tuple[Rom, BudgetFit]:
    """Fit `rom` to a memory of so many words; pictures of `size` pixels tell how like it is to what it was."""
    colours = np.array([material.colour for material in rom.materials], np.uint8)
    fit = octree.fit(rom.octree, words, colours=colours)
    fitted = replace(rom, octree=fit.octree)
    camera = aim_camera(rom, size)
    before, after = (sim.render(r, camera, size, engine="model", threads=threads).colour for r in (rom, fitted))
    psnr, ssim = sim.peak_signal_to_noise(before, after), sim.structural_similarity(before, after)
    return fitted, BudgetFit(words, fit, psnr, ssim)
