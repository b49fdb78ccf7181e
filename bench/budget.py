"""Benchmark of fitting to a budget: ours against a coarser world of the same size, on scenes and generated bodies.

Usage: ``python bench/budget.py [--write]``. ``--write`` puts the table into ``bench/results/budget.md`` as well. For
each scene the budgets are the sizes of the worlds coarser by one and by two levels. Both are measured against the whole
octree: percent of the surface voxels that changed, voxels that appeared, and how like pictures of the whole scene are
to those of the whole octree (PSNR in dB and SSIM, means over six views all around it, the default one among them).
"""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from msgspec.structs import replace
from report import ASSETS, ROOT, options_of, publish, table

import voxrt
from voxrt import export, octree
from voxrt.building.fitting import Views, fit_budget

sys.path.append(str(ROOT / "tests"))
from oracles.worlds import lumps

if TYPE_CHECKING:
    from collections.abc import Iterator

NOTE = "PSNR (dB) and SSIM are means over six views all around the scene."
FIGURES = ("changed", "appeared", "PSNR", "SSIM")
HEAD = ("scene", "words", "budget", *(f"{name}: {figure}" for name in ("coarser", "ours") for figure in FIGURES))
HEAD = (*HEAD, "ours: words", "seconds")


def scenes() -> Iterator[octree.Rom]:
    """Give the project's own scenes, MagicaVoxel scenes where they are there, and two bodies with rough skins."""
    for path in sorted((ROOT / "examples").glob("*.glb")):
        yield voxrt.build(path, depth=8).rom
    for path in sorted(ASSETS.glob("vox/*/vox/scene_*.vox")):
        yield export.read_vox(path)[0]
    for materials in (1, 3):
        colours = ((0, 0, 0), (200, 80, 60), (70, 160, 90), (80, 110, 200))[: materials + 1]
        table = tuple(voxrt.Material(f"material {number}", colour) for number, colour in enumerate(colours))
        yield octree.Rom(f"rough bodies, {materials} materials", octree.from_dense(lumps(7, materials)), table)


def compare(rom: octree.Rom) -> Iterator[tuple[str, ...]]:
    whole = replace(rom, octree=octree.share(rom.octree))
    for level in (1, 2):
        plain = octree.coarsen(whole.octree, level)
        start = time.perf_counter()
        ours = fit_budget(whole, len(plain.words), (320, 240), 0)[0].octree
        seconds = time.perf_counter() - start
        views = Views(whole)
        yield (
            rom.name,
            f"{len(whole.octree.words):,}",
            f"{len(plain.words):,}",
            *figures(whole, plain, views),
            *figures(whole, ours, views),
            f"{len(ours.words):,}",
            f"{seconds:.1f}",
        )


def figures(whole: octree.Rom, fitted: octree.Octree, views: Views) -> tuple[str, ...]:
    psnr, ssim = views.likeness(fitted)
    return (
        f"{octree.surface_change(whole.octree, fitted).percent:.1f} %",
        f"{octree.diff(whole.octree, fitted).appeared:,}",
        f"{psnr:.2f}",
        f"{ssim:.3f}",
    )


def main() -> None:
    parser = options_of(__doc__)
    options = parser.parse_args()
    text = table(HEAD, (row for rom in scenes() for row in compare(rom)))
    publish("budget.md", f"# Fitting a budget\n\n{NOTE}\n\n{text}", write=options.write)


if __name__ == "__main__":
    main()
