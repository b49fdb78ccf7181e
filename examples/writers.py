"""Scenes to files: glTF binary, OBJ with its material library, USD text."""

from __future__ import annotations

import itertools
import json
import struct
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from solids import Part, Solid

Palette = dict[str, tuple[int, int, int]]


def write_glb(path: Path, parts: list[Part], palette: Palette) -> None:
    """Write a glTF 2.0 binary: a node and a mesh a part, flat base colours."""
    names = list(palette)
    buffer = bytearray()
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    meshes: list[dict[str, Any]] = []
    for part in parts:
        points, triangles = _flatten(part.solids)
        columns = list(zip(*points, strict=True))
        position = {"componentType": 5126, "type": "VEC3", "count": len(points)}
        position |= {"min": [min(column) for column in columns], "max": [max(column) for column in columns]}
        accessors.append({"bufferView": len(views), **position})
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": 12 * len(points), "target": 34962})
        buffer += b"".join(struct.pack("<3f", *point) for point in points)
        accessors.append(
            {"bufferView": len(views), "componentType": 5125, "type": "SCALAR", "count": 3 * len(triangles)}
        )
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": 12 * len(triangles), "target": 34963})
        buffer += b"".join(struct.pack("<3I", *triangle) for triangle in triangles)
        surface = {
            "attributes": {"POSITION": len(accessors) - 2},
            "indices": len(accessors) - 1,
            "material": names.index(part.material),
        }
        meshes.append({"name": part.name, "primitives": [surface]})
    document = {
        "asset": {"version": "2.0", "generator": "voxrt examples/make_scenes.py"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(parts)))}],
        "nodes": [{"name": part.name, "mesh": number} for number, part in enumerate(parts)],
        "meshes": meshes,
        "materials": [
            {
                "name": name,
                "pbrMetallicRoughness": {
                    "baseColorFactor": [*(_linear(channel) for channel in colour), 1],
                    "metallicFactor": 0,
                },
            }
            for name, colour in palette.items()
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(buffer)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(buffer))
    path.write_bytes(
        header + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    )


def write_obj(path: Path, parts: list[Part], palette: Palette) -> None:
    """Write an OBJ file of polygons, y up, and its material library beside it."""
    library = path.with_suffix(".mtl")
    lines = ["# Made by make_scenes.py: metres, y up", f"mtllib {library.name}"]
    first = 1
    for part in parts:
        lines += [f"o {part.name}", f"usemtl {part.material}"]
        for solid in part.solids:
            lines += [f"v {x:g} {y:g} {z:g}" for x, y, z in solid.points]
            lines += ["f " + " ".join(str(first + corner) for corner in face) for face in solid.faces]
            first += len(solid.points)
    path.write_text("\n".join(lines) + "\n")
    lines = ["# Made by make_scenes.py"]
    for name, colour in palette.items():
        lines += [f"newmtl {name}", "Kd " + " ".join(f"{channel / 255:.4f}" for channel in colour)]
    library.write_text("\n".join(lines) + "\n")


def write_usda(
    path: Path, boxes: list[tuple[str, str, tuple[float, ...], tuple[float, ...]]], palette: Palette
) -> None:
    """Write USD text, centimetres and z up: cubes from corner to corner, physics box colliders."""
    lines = [
        "#usda 1.0",
        "(",
        f'    defaultPrim = "{path.stem.capitalize()}"',
        "    metersPerUnit = 0.01",
        '    upAxis = "Z"',
        ")",
        "",
        f'def Xform "{path.stem.capitalize()}"',
        "{",
        '    def Scope "Looks"',
        "    {",
    ]
    for name, colour in palette.items():
        channels = ", ".join(f"{_linear(channel):g}" for channel in colour)
        shader = f"/{path.stem.capitalize()}/Looks/{name}/Surface"
        lines += [
            f'        def Material "{name}"',
            "        {",
            f"            token outputs:surface.connect = <{shader}.outputs:surface>",
            "",
            '            def Shader "Surface"',
            "            {",
            '                uniform token info:id = "UsdPreviewSurface"',
            f"                color3f inputs:diffuseColor = ({channels})",
            "                token outputs:surface",
            "            }",
            "        }",
        ]
    lines += ["    }"]
    for name, material, lowest, highest in boxes:
        centre = [(low + high) / 2 for low, high in zip(lowest, highest, strict=True)]
        size = [high - low for low, high in zip(lowest, highest, strict=True)]
        lines += [
            "",
            f'    def Cube "{name}" (',
            '        prepend apiSchemas = ["PhysicsCollisionAPI", "MaterialBindingAPI"]',
            "    )",
            "    {",
            "        double size = 1",
            f"        rel material:binding = </{path.stem.capitalize()}/Looks/{material}>",
            f"        double3 xformOp:translate = ({', '.join(f'{value:g}' for value in centre)})",
            f"        float3 xformOp:scale = ({', '.join(f'{value:g}' for value in size)})",
            '        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]',
            "    }",
        ]
    path.write_text("\n".join([*lines, "}", ""]))


def _flatten(solids: tuple[Solid, ...]) -> tuple[list[tuple[float, float, float]], list[tuple[int, int, int]]]:
    """Join solids into points and triangles; the polygons are convex."""
    points: list[tuple[float, float, float]] = []
    triangles = []
    for solid in solids:
        for face in solid.faces:
            first, *rest = (corner + len(points) for corner in face)
            triangles += [(first, a, b) for a, b in itertools.pairwise(rest)]
        points += solid.points
    return points, triangles


def _linear(channel: int) -> float:
    """Give the linear value of an sRGB channel (IEC 61966-2-1), rounded so that it comes back exactly."""
    value = channel / 255
    return round(value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4, 5)


def write_vox(path: Path, voxels: dict[tuple[int, int, int], int], palette: list[tuple[int, int, int]]) -> None:
    """Write a MagicaVoxel file of one model: the palette's entry, 1 …, by x, y, z, each 0 … 255; z is up."""
    width, depth, height = (1 + max(place[axis] for place in voxels) for axis in range(3))
    cells = b"".join(struct.pack("<4B", *place, entry) for place, entry in sorted(voxels.items()))
    colours = b"".join(struct.pack("<4B", *colour, 255) for colour in palette).ljust(1024, b"\0")
    chunks = [
        (b"SIZE", struct.pack("<3I", width, depth, height)),
        (b"XYZI", struct.pack("<I", len(voxels)) + cells),
        (b"RGBA", colours),
    ]
    content = b"".join(name + struct.pack("<2I", len(body), 0) + body for name, body in chunks)
    path.write_bytes(b"VOX " + struct.pack("<I", 150) + b"MAIN" + struct.pack("<2I", 0, len(content)) + content)
