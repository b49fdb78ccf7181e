"""Octants drawn: PyVista grids and pictures, windows, turntables, pages, notebook cards, a ray's table."""

from voxrt.exports import exports_of

__getattr__, __dir__ = exports_of(__name__)
