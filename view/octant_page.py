"""Octants as one HTML file that needs nothing else: any browser with WebGL 2 turns them, offline."""

from __future__ import annotations

import base64
import html
import json
import zlib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.atomic import write_atomically

if TYPE_CHECKING:
    import pyvista

    from voxrt.octree import Rom

_PAGE = Path(__file__).with_suffix(".html")


def write_page(path: Path, rom: Rom, grid: pyvista.UnstructuredGrid) -> None:
    """Write octants as a self-contained page; a click on an octant shows its address, word, level, bounds, material.

    Parameters
    ----------
    path
        The file.
    rom
        The memory and its materials.
    grid
        Some of its octants, by :func:`voxrt.view.octants`.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    corners = np.asarray(grid.cells, np.int64).reshape(-1, 9)
    points = np.asarray(grid.points).reshape(-1, 3)
    packed = b"".join(
        np.ascontiguousarray(values, kind).tobytes()
        for values, kind in (
            (grid.cell_data["address"], "<u4"),
            (points[corners[:, 1]], "<u2"),
            (points[corners[:, 8]] - 1, "<u2"),
            (grid.cell_data["material"], "u1"),
            (grid.cell_data["level"], "u1"),
        )
    )
    scene = {
        "title": f"{rom.name}: {grid.n_cells:,} octants shown, {int(grid.field_data['hidden'][0]):,} hidden",
        "depth": rom.octree.depth,
        "count": grid.n_cells,
        "materials": [{"name": material.name, "colour": material.colour} for material in rom.materials],
        "octants": base64.b64encode(zlib.compress(packed, 9)).decode(),
    }
    red, green, blue = rom.materials[0].colour
    page = _PAGE.read_text(encoding="utf-8")
    for name, text in (
        ("title", html.escape(rom.name)),
        ("background", f"rgb({red}, {green}, {blue})"),
        ("scene", json.dumps(scene).replace("<", "\\u003c")),
    ):
        page = page.replace("{{" + name + "}}", text)
    write_atomically(path, page.encode())
