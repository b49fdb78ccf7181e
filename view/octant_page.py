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
from voxrt.octree.camera import FACES
from voxrt.octree.words import EMPTY

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.octree.camera import Faces
    from voxrt.view.octant_mesh import OctantMesh

_PAGE = Path(__file__).with_suffix(".html")


def write_page(path: Path, rom: Rom, mesh: OctantMesh, faces: Faces = FACES) -> None:
    """Write octants as a page that needs no other file. A click shows an octant's address, word, level and material.

    `faces` is the brightness of the sides.
    """
    points = mesh.points
    packed = b"".join(
        np.ascontiguousarray(values, kind).tobytes()
        for values, kind in (
            (mesh.addresses, "<u4"),
            (points[mesh.corners[:, 0]], "<u2"),
            (points[mesh.corners[:, 7]] - 1, "<u2"),
            (mesh.materials, "u1"),
            (mesh.levels, "u1"),
        )
    )
    scene = {
        "title": f"{rom.name}: {len(mesh.levels):,} octants shown, {mesh.hidden:,} hidden",
        "depth": rom.octree.depth,
        "empty": EMPTY,
        "count": len(mesh.levels),
        "materials": [{"name": material.name, "colour": material.colour} for material in rom.materials],
        "octants": base64.b64encode(zlib.compress(packed, 9)).decode(),
    }
    red, green, blue = rom.materials[0].colour
    page = _PAGE.read_text(encoding="utf-8")
    for name, text in (
        ("title", html.escape(rom.name)),
        ("background", f"rgb({red}, {green}, {blue})"),
        ("faces", ", ".join(f"{brightness}.0" for brightness in faces)),
        ("scene", json.dumps(scene).replace("<", "\\u003c")),
    ):
        page = page.replace("{{" + name + "}}", text)
    write_atomically(path, page.encode())
