"""Meshes: the primitives of one glTF mesh as one set of triangles, each with the material the file gives it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.gltf.accessors import read_floats
from voxrt.voxelize.gltf.materials import NO_MATERIAL
from voxrt.voxelize.gltf.primitives import has_area, read_triangles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.gltf.document import Document


@dataclass(frozen=True, eq=False, slots=True)
class Surface:
    """The triangles of a glTF mesh.

    Attributes
    ----------
    positions
        float64, shape (V, 3), finite; every vertex is used.
    triangles
        int32, shape (T, 3), counter-clockwise seen from outside.
    materials
        int32, shape (T,): indices into the file's materials, or NO_MATERIAL.
    """

    positions: NDArray[np.float64]
    triangles: NDArray[np.int32]
    materials: NDArray[np.int32]


def read_surface(document: Document, index: int) -> Surface:
    """Read mesh `index`; its triangles stand in the order of its primitives."""
    positions: list[NDArray[np.float64]] = []
    triangles: list[NDArray[np.int32]] = []
    materials: list[NDArray[np.int32]] = []
    first_vertex: dict[int, int] = {}
    counts: dict[int, int] = {}
    vertices = 0
    for at, primitive in enumerate(document.gltf.meshes[index].primitives):
        place = f"meshes[{index}].primitives[{at}]"
        if not has_area(document, primitive):
            continue
        accessor = primitive.attributes.get("POSITION")
        if accessor is None:
            document.warn("no-positions", "primitives without positions were left out")
            continue
        if "COLOR_0" in primitive.attributes:
            document.warn("vertex-colour", "primitives with vertex colours took the colour of their material alone")
        # Primitives of one mesh often share their vertices and differ in indices and material only.
        if accessor not in first_vertex:
            corners = read_floats(document, accessor, f"{place}.attributes.POSITION", {"VEC3"})
            first_vertex[accessor], counts[accessor] = vertices, len(corners)
            vertices += len(corners)
            positions.append(corners)
        read = read_triangles(document, primitive, counts[accessor], place)
        if primitive.material is not None:
            document.item(document.gltf.materials, primitive.material, f"{place}.material", "material")
        document.charge(len(read) * 16, place)
        triangles.append(read + np.int32(first_vertex[accessor]))
        material = NO_MATERIAL if primitive.material is None else primitive.material
        materials.append(np.full(len(read), material, np.int32))
    if not triangles:
        return Surface(np.empty((0, 3)), np.empty((0, 3), np.int32), np.empty(0, np.int32))
    return _compact(np.concatenate(positions), np.concatenate(triangles), np.concatenate(materials))


def _compact(positions: NDArray[np.float64], triangles: NDArray[np.int32], materials: NDArray[np.int32]) -> Surface:
    """Leave out the vertices that no triangle uses: they must not stretch the bounds of the scene."""
    used = np.zeros(len(positions), np.bool_)
    used[triangles] = True
    if used.all():
        return Surface(positions, triangles, materials)
    rows = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return Surface(positions[used], rows[triangles], materials)
