"""A memory made smaller: hidden voxels that may be anything, and what a budget wants given up."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt import octree, sim
from voxrt.octree.camera import PLAIN_LIGHTING, THREE_QUARTER
from voxrt.viewpoint import aim_camera
from voxrt.voxelize import AssetError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.octree import Octree, Rom
    from voxrt.octree.camera import Lighting
    from voxrt.voxelize import Material


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
    lossless
        Where more than a tenth of the surface was given up: the greatest depth at which the asset fits the budget
        without loss, and its words there. None if little was given up, or no depth fits.
    """

    words: int
    fit: octree.Fit
    psnr: float
    ssim: float
    lossless: tuple[int, int] | None = None


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


def find_material(asset: object, materials: Sequence[Material], wanted: int | str) -> int:
    """Find the id of a material, one of those of an asset, that is asked for by name or by id.

    Raises
    ------
    AssetError
        None of them is it.
    """
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


def fit_interior(rom: Rom, material: int | None) -> tuple[Rom, InteriorFit]:
    """Give the hidden voxels of `rom` the material, or each what lets most blocks be shared."""
    whole, hidden = rom.octree, octree.hidden_voxels(rom.octree)
    tree = octree.share_hidden(whole, hidden) if material is None else octree.fill_hidden(whole, hidden, material)
    found = octree.census(hidden).solid_voxels
    return replace(rom, octree=tree), InteriorFit(material, found, len(whole.words))


def fit_budget(
    rom: Rom, words: int, size: tuple[int, int], threads: int, *, lighting: Lighting = PLAIN_LIGHTING
) -> tuple[Rom, BudgetFit]:
    """Fit `rom` to a memory of so many words; pictures of `size` pixels tell how like it is to what it was."""
    colours = np.array([material.colour for material in rom.materials], np.uint8)
    views = Views(rom, threads, lighting)
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

    size = (320, 240)
    """Pixels."""

    def __init__(self, rom: Rom, threads: int = 0, lighting: Lighting = PLAIN_LIGHTING) -> None:
        self._rom = rom
        self._threads = threads
        self._lighting = lighting
        self._cameras = [aim_camera(rom, self.size, look=look) for look in _looks()]
        self._pictures = self._render(rom)

    def likeness(self, fitted: Octree) -> tuple[float, float]:
        """Give the means over the views of the PSNR (dB) and SSIM of what is seen of `fitted`."""
        pairs = list(zip(self._pictures, self._render(replace(self._rom, octree=fitted)), strict=True))
        return (
            float(np.mean([sim.peak_signal_to_noise(*pair) for pair in pairs])),
            float(np.mean([sim.structural_similarity(*pair) for pair in pairs])),
        )

    def choose(self, fits: Sequence[octree.Fit]) -> octree.Fit:
        """Take the fit whose worst figure is the best, each held against that of the first fit, the coarser world.

        The figures are the surface voxels changed, the error that the PSNR stands for, and what the SSIM lacks to 1.
        """
        errors = np.array([self._errors(fit) for fit in fits])
        shares = np.round(errors / np.maximum(errors[0], 1e-9), 6)  # the same choice on every machine
        return fits[min(range(len(fits)), key=lambda i: (shares[i].max(), shares[i].sum()))]

    def _errors(self, fit: octree.Fit) -> tuple[float, float, float]:
        psnr, ssim = self.likeness(fit.octree)
        return fit.changed, 10 ** (-psnr / 10), 1 - ssim

    def _render(self, rom: Rom) -> list[NDArray[np.uint8]]:
        return [
            sim.render(rom, camera, self.size, engine="model", lighting=self._lighting, threads=self._threads).colour
            for camera in self._cameras
        ]


def _looks() -> list[tuple[int, int, int]]:
    x, y, z = 1000 * np.array(THREE_QUARTER)
    angles = np.arange(6) * np.pi / 3
    turned = np.stack([x * np.cos(angles) + z * np.sin(angles), np.full(6, y), z * np.cos(angles) - x * np.sin(angles)])
    return [(int(a), int(b), int(c)) for a, b, c in np.rint(turned.T)]
