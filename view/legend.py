"""Legends: names beside squares of colour, in a part of the picture that is kept free for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.view.cells import import_pyvista
from voxrt.view.plotter import TEXT

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista

    Entry = tuple[str, Sequence[int] | None]
    """A name, and its colour: sRGB. A title has none."""

LINE = 18
"""Pixels from one entry to the next."""

_LETTERS = 12
_COLUMN = 0.58  # width of a letter, as a part of the letters' size
_WIDTH = 150


def legend_width(plotter: pyvista.Plotter) -> float:
    """Return the part of the current subplot's width that a legend takes."""
    return min(0.4, _WIDTH / _pane_size(plotter)[0])


def draw_legend(
    plotter: pyvista.Plotter, name: str, entries: Sequence[Entry], *, left: float, top: float, bottom: float = 0.02
) -> None:
    """Draw a legend in the current subplot, in place of the one of that name.

    Entries that do not fit between `top` and `bottom` are counted in the last line. Names that do not fit between
    `left` and the subplot's edge are cut. All three are parts of the subplot's width and height, from its lower left.
    """
    pv = import_pyvista()
    from vtkmodules.vtkRenderingCore import vtkActor2D, vtkCoordinate, vtkPolyDataMapper2D  # noqa: PLC0415 - optional

    width, height = _pane_size(plotter)
    line, square = LINE / height, 0.6 * LINE / height
    fitting = max(1, int((top - bottom) / line))
    if len(entries) > fitting:
        entries = [*entries[: fitting - 1], (f"and {len(entries) - fitting + 1} more", None)]
    letters = max(1, int(((0.99 - left) * width - LINE) / (_COLUMN * _LETTERS)))
    points, colours = [], []
    remove_legend(plotter, name)
    for row, (label, colour) in enumerate(entries):
        low = top - (row + 1) * line + (line - square) / 2
        if colour is not None:
            right = left + square * height / width
            points += [(left, low, 0), (right, low, 0), (right, low + square, 0), (left, low + square, 0)]
            colours.append(colour)
        shown = label if len(label) <= letters else f"{label[: max(1, letters - 2)]}.."
        text = pv.Text(shown)
        style = text.GetTextProperty()
        style.SetFontSize(_LETTERS)
        style.SetColor(*(channel / 255 for channel in TEXT))
        style.SetVerticalJustificationToCentered()
        text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        text.position = (left + (LINE / width if colour is not None else 0), low + square / 2)
        plotter.add_actor(text, name=f"{name} {row}", reset_camera=False)
    if not colours:
        return
    squares = pv.PolyData(
        np.array(points, np.float32), np.insert(np.arange(len(points)).reshape(-1, 4), 0, 4, 1).ravel()
    )
    squares.cell_data["colour"] = np.array(colours, np.uint8)
    mapper, place = vtkPolyDataMapper2D(), vtkCoordinate()
    place.SetCoordinateSystemToNormalizedViewport()
    mapper.SetTransformCoordinate(place)
    mapper.SetInputData(squares)
    mapper.SetScalarModeToUseCellFieldData()
    mapper.ColorByArrayComponent("colour", 0)
    mapper.SetColorModeToDirectScalars()
    actor = vtkActor2D()
    actor.SetMapper(mapper)
    plotter.add_actor(actor, name=f"{name} squares", reset_camera=False)


def remove_legend(plotter: pyvista.Plotter, name: str) -> None:
    """Remove a legend from the current subplot."""
    for actor in [actor for actor in plotter.renderer.actors if actor.startswith(f"{name} ")]:
        plotter.remove_actor(actor)


def _pane_size(plotter: pyvista.Plotter) -> tuple[float, float]:
    left, bottom, right, top = plotter.renderer.viewport
    return (right - left) * plotter.window_size[0], (top - bottom) * plotter.window_size[1]
