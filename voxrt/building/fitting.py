"""A memory made smaller: hidden voxels that may be anything, and what a budget wants given up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt import octree, sim
from voxrt.octree.camera import PLAIN_LIGHTING
from voxrt.sim import _model
from voxrt.sim.engine_arguments import palette_of
from voxrt.views.viewpoint import aim_camera
from voxrt.voxelize import AssetError
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt.octree import Octree, Rom
    from voxrt.octree.camera import Lighting
    from voxrt.voxelize import Material


class BudgetFit(Value, frozen=True, eq=False):
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
    lossless
        Where more than a tenth of the surface was given up: the greatest depth at which the asset fits the budget
        without loss, and its words there. None if little was given up, or no depth fits.
    """

    words: int
    fit: octree.Fit
    psnr: float
    ssim: float
    lossless: tuple[int, int] | None = None


class InteriorFit(Value, frozen=True):
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


def find_material(asset: object, materials: Sequence[Material], wanted: int | str) -> int:
    """Find the id of a material of an asset that is asked for by name or by id; AssetError if none of them is it."""
    names = [material.name for material in materials]
    if wanted in names[1:]:
        return 1 + names[1:].index(str(wanted))
    number = int(wanted) if isinstance(wanted, int) or wanted.isdecimal() else 0
    if 1 <= number < len(names):
        return number
    there = ", ".join(f"{number} {name}" for number, name in enumerate(names[1:], 1))
    raise AssetError(
        asset, f"has no material {wanted!r} for its interior", fix=f"name one of: {there or 'it has none'}"
    )


def fit_interior(rom: Rom, wanted: int | str, asset: object) -> tuple[Rom, InteriorFit]:
    """Give hidden voxels the material that is asked for, or with ``"any"`` each what lets most blocks be shared.

    AssetError if the memory has no such material; `asset` is what the message calls it.
    """
    material = None if wanted == "any" else find_material(asset, rom.materials, wanted)
    whole, hidden = rom.octree, octree.hidden_voxels(rom.octree)
    tree = octree.share_hidden(whole, hidden) if material is None else octree.fill_hidden(whole, hidden, material)
    found = octree.census(hidden).solid_voxels
    return replace(rom, octree=tree), InteriorFit(material, found, len(whole.words))


def fit_budget(
    rom: Rom, words: int, size: tuple[int, int], threads: int, *, lighting: Lighting = PLAIN_LIGHTING
) -> tuple[Rom, BudgetFit]:
    """Fit `rom` to a memory of so many words; pictures of `size` pixels tell how like it is to what it was."""
    # What is given up is chosen in pictures by the angle: they show every change of the surface.
    colours = np.array([material.colour for material in rom.materials], np.uint8)
    views = Views(rom, threads, flat=lighting.flat)
    fit = octree.fit(rom.octree, words, colours=colours, choose=views.choose)
    fitted = replace(rom, octree=fit.octree)
    camera = aim_camera(rom, size)
    before, after = (
        sim.render(r, camera, size, engine="model", lighting=lighting, threads=threads).colour for r in (rom, fitted)
    )
    psnr, ssim = sim.peak_signal_to_noise(before, after), sim.structural_similarity(before, after)
    return fitted, BudgetFit(words, fit, psnr, ssim)


class Views:
    """Pictures of a scene from all around: the default view, turned about the vertical in six steps of 60 degrees."""

    def __init__(self, rom: Rom, threads: int = 0, *, flat: bool = False) -> None:
        self._views = _model.FitViews(_memory(rom.octree), palette_of(rom.materials), flat, threads)

    def likeness(self, fitted: Octree) -> tuple[float, float]:
        """Give the means over the views of the PSNR (dB) and SSIM of what is seen of `fitted`."""
        return self._views.likeness(_memory(fitted))

    def choose(self, fits: Sequence[octree.Fit]) -> octree.Fit:
        """Take the fit whose worst figure is the best, each held against that of the first fit, the coarser world.

        The figures are the surface voxels changed, the error that the PSNR stands for, and what the SSIM lacks to 1.
        """
        return fits[_model.choose_fit([(fit.changed, *self.likeness(fit.octree)) for fit in fits])]


def _memory(tree: Octree) -> _model.Memory:
    return _model.Memory(tree.words, tree.depth)
