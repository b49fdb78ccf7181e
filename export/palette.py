"""Colours for memories that have none."""

from __future__ import annotations

import colorsys

from voxrt.voxelize import EMPTY, Material
from voxrt.voxelize.arguments import whole

_ORIGINAL = ((255, 255, 255), (0, 255, 0), (0, 0, 255), (255, 0, 0), (255, 255, 0))
"""Materials 1 … 5 as the report of the original lists them (appendix, ``material_table``)."""

_GOLDEN_TURN = 0.6180339887498949


def default_materials(highest: int) -> tuple[Material, ...]:
    """Make a material table whose neighbours are easy to tell apart.

    Ids 1 … 5 have the colours of the original's report. The hues of the rest lie a golden section of the colour circle
    apart, in three brightnesses.

    Parameters
    ----------
    highest
        The highest id, 0 … 255.

    Raises
    ------
    TypeError, ValueError
        It is none of these.

    Examples
    --------
    >>> [material.colour for material in default_materials(2)[1:]]
    [(255, 255, 255), (0, 255, 0)]
    """
    highest = whole("highest", highest, 0, 255)
    return (EMPTY, *(Material(f"material {i}", _colour(i), authored=False) for i in range(1, highest + 1)))


def _colour(material: int) -> tuple[int, int, int]:
    if material <= len(_ORIGINAL):
        return _ORIGINAL[material - 1]
    turn = (material - len(_ORIGINAL) - 1) * _GOLDEN_TURN
    red, green, blue = colorsys.hsv_to_rgb(
        (0.08 + turn) % 1, (0.85, 0.55)[material % 2], (1.0, 0.75, 0.5)[material % 3]
    )
    return round(255 * red), round(255 * green), round(255 * blue)
