"""Checks that no page of the manual has a blank picture; ``docs/conf.py`` runs them when the manual is built.

Two checks: while an example runs, every pair of axes of its figures must show something; and of every picture of the
finished manual, enough pixels must differ from the background.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.figure import Figure

SMALLEST_PART = 0.01
"""A picture is blank when less than this part of its pixels differs from the most frequent colour."""


def drawn_part(path: Path) -> float:
    """Give the part of a picture's pixels that differ from its most frequent colour."""
    pixels = np.asarray(Image.open(path).convert("RGB")).reshape(-1, 3)
    _, counts = np.unique(pixels, axis=0, return_counts=True)
    return 1 - counts.max() / len(pixels)


def blank_pictures(folder: Path) -> list[str]:
    """Name the pictures of a folder that show next to nothing."""
    found = ((path, drawn_part(path)) for path in sorted(folder.glob("*.png")))
    return [f"{path.name}: {100 * part:.2f} % of its pixels are drawn" for path, part in found if part < SMALLEST_PART]


def empty_axes(figure: Figure) -> int:
    """Count the axes of a figure that show nothing."""
    return sum(not axes.has_data() and not axes.texts for axes in figure.axes)


def scraper(block: tuple[str, str, int], block_vars: dict[str, object], gallery_conf: dict[str, object]) -> str:
    """Collect an example's figures as Sphinx-Gallery's own scraper does, and refuse empty ones."""
    import matplotlib.pyplot as plt  # noqa: PLC0415 - only where examples run

    for number in plt.get_fignums():
        figure = plt.figure(number)
        if not figure.axes or empty_axes(figure):
            raise ValueError(f"{block_vars['src_file']}: figure {number} has {empty_axes(figure)} empty axes")
    from sphinx_gallery.scrapers import matplotlib_scraper  # noqa: PLC0415 - the tests of this file do without it

    return matplotlib_scraper(block, block_vars, gallery_conf)
