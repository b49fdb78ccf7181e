"""Octants drawn: PyVista grids and pictures, windows, turntables, pages, notebook cards, a ray's table."""

from voxrt.view.cells import octants, open_sides
from voxrt.view.errors import ViewerError
from voxrt.view.pane import DrawnRay, Pane, Preview
from voxrt.view.pictures import picture, plot, turntable
from voxrt.view.window import Window

__all__ = [
    "DrawnRay",
    "Pane",
    "Preview",
    "ViewerError",
    "Window",
    "octants",
    "open_sides",
    "picture",
    "plot",
    "turntable",
]
