"""Small animated assets: a slab that stays, and a box above it that goes up and down within two seconds."""

from __future__ import annotations

import json
import struct
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], np.float32)
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
TRIANGLES = np.array([face for a, b, c, d in QUADS for face in ((a, b, c), (a, c, d))], np.uint16)


def write_lift_glb(path: Path) -> Path:
    """glTF: the translation of the box's node is animated."""
    times = np.array([0, 1, 2], np.float32)
    places = np.array([[1, 1, 1], [1, 4, 1], [1, 1, 1]], np.float32)
    arrays, blob, views = (CORNERS, TRIANGLES, times, places), b"", []
    for array in arrays:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": array.nbytes})
        blob += array.tobytes()
    kinds = ((5126, "VEC3", 8), (5123, "SCALAR", 36), (5126, "SCALAR", 3), (5126, "VEC3", 3))
    accessors = [
        {"bufferView": row, "componentType": component, "count": count, "type": kind}
        for row, (component, kind, count) in enumerate(kinds)
    ]
    accessors[0] |= {"min": [0, 0, 0], "max": [1, 1, 1]}
    accessors[2] |= {"min": [0], "max": [2]}
    colours = {"stone": [0.5, 0.5, 0.5, 1], "red": [0.8, 0.1, 0.1, 1]}
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"mesh": 0, "name": "slab", "scale": [8, 1, 8]},
            {"mesh": 1, "name": "box", "scale": [2, 2, 2], "translation": [1, 1, 1]},
        ],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": row}]} for row in range(2)
        ],
        "materials": [
            {"name": name, "pbrMetallicRoughness": {"baseColorFactor": colour}} for name, colour in colours.items()
        ],
        "animations": [
            {
                "name": "lift",
                "samplers": [{"input": 2, "output": 3}],
                "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
            }
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(blob)}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path


def write_lift_usda(path: Path) -> Path:
    """USD: the translation of the box has time samples, 24 per second."""
    points = ", ".join(f"({x:g}, {y:g}, {z:g})" for x, y, z in CORNERS)
    counts, indices = ", ".join(["3"] * 12), ", ".join(map(str, TRIANGLES.ravel()))

    def mesh(name: str, colour: str, scale: str, place: str) -> str:
        return f"""
def Mesh "{name}" {{
    point3f[] points = [{points}]
    int[] faceVertexCounts = [{counts}]
    int[] faceVertexIndices = [{indices}]
    uniform token subdivisionScheme = "none"
    color3f[] primvars:displayColor = [{colour}]
    double3 xformOp:translate{place}
    double3 xformOp:scale = {scale}
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
}}
"""

    moving = ".timeSamples = { 0: (1, 1, 1), 24: (1, 4, 1), 48: (1, 1, 1) }"
    head = "#usda 1.0\n(\n    startTimeCode = 0\n    endTimeCode = 48\n    timeCodesPerSecond = 24\n"
    head += '    metersPerUnit = 1\n    upAxis = "Y"\n)\n'
    slab = mesh("slab", "(0.5, 0.5, 0.5)", "(8, 1, 8)", " = (0, 0, 0)")
    path.write_text(head + slab + mesh("box", "(0.8, 0.1, 0.1)", "(2, 2, 2)", moving))
    return path


def write_still_obj(path: Path, height: float) -> Path:
    """OBJ: the slab and the box at a height, without animation."""
    lines = []
    for scale, place in (((8, 1, 8), (0, 0, 0)), ((2, 2, 2), (1, height, 1))):
        lines += ["v {:g} {:g} {:g}".format(*row) for row in CORNERS * scale + place]
    lines += ["f {} {} {}".format(*(row + 1)) for row in TRIANGLES.astype(int)]
    lines += ["f {} {} {}".format(*(row + 9)) for row in TRIANGLES.astype(int)]
    path.write_text("\n".join(lines) + "\n")
    return path
