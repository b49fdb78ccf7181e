"""Meshes: the primitives of one glTF mesh as one set of triangles, deformed by morph targets and skin."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.gltf.attributes import Attributes
from voxrt.voxelize.formats.gltf.deform import is_deformed, morphed, skinned
from voxrt.voxelize.formats.gltf.primitives import has_area, read_triangles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.deform import Pose
    from voxrt.voxelize.formats.gltf.document import Document


class Span(Struct, frozen=True, eq=False):
    """The triangles of one primitive among those of its mesh."""

    primitive: int  # its index in the mesh
    attributes: Attributes  # its vertices
    # The first of its triangles, and the one after its last.
    start: int
    stop: int
    corners: NDArray[np.int32]  # int32, shape (stop - start, 3): rows of the primitive's own vertices


class Surface(Struct, frozen=True, eq=False):
    """The triangles of a glTF mesh, in the order of its primitives."""

    positions: NDArray[np.floating]  # float32 or float64, shape (V, 3), finite; few are unused
    triangles: NDArray[np.int32]  # int32, shape (T, 3), counter-clockwise seen from outside
    spans: tuple[Span, ...]  # the primitives that they come from
    normals: CornerNormals | None = None  # the normals of vertices that no pose moves; None where the file gives none


def read_surface(document: Document, index: int, pose: Pose) -> Surface:
    """Read mesh `index` in `pose`."""
    positions: list[NDArray[np.floating]] = []
    normals: list[NDArray[np.floating] | None] = []
    triangles: list[NDArray[np.int32]] = []
    spans: list[Span] = []
    shared: dict[object, tuple[int, int]] = {}
    vertices = start = 0
    for at, primitive in enumerate(document.gltf.meshes[index].primitives):
        place = f"meshes[{index}].primitives[{at}]"
        if not has_area(document, primitive):
            continue
        attributes = Attributes(document, primitive, place)
        if "POSITION" not in attributes:
            document.log.add("no-positions", "primitives without positions were left out")
            continue
        # Primitives of one mesh often share their vertices and differ in indices and material only.
        same = tuple(primitive.attributes.items()), at if attributes.is_compressed or primitive.targets else None
        if same not in shared:
            bent = morphed(document, primitive, attributes.reals("POSITION", {"VEC3"}), pose, place)
            bent = skinned(document, attributes, bent, pose, place)
            shared[same] = vertices, len(bent)
            vertices += len(bent)
            positions.append(bent)
            normals.append(None if is_deformed(primitive, pose) else _normals(document, attributes, len(bent)))
        first, count = shared[same]
        corners = read_triangles(document, attributes, primitive.mode, count, place)
        triangles.append(corners + np.int32(first) if first else corners)
        spans.append(Span(at, attributes, start, start + len(corners), corners))
        start += len(corners)
    if not start:
        return Surface(np.empty((0, 3)), np.empty((0, 3), np.int32), ())
    every = positions[0] if len(positions) == 1 else np.concatenate(positions)
    vectors = _vectors(normals, positions)
    corners = triangles[0] if len(triangles) == 1 else np.concatenate(triangles)
    if len(every) > corners.size:  # a mesh may share the vertices of the whole file: drop those that it does not use
        rows, places = np.unique(corners, return_inverse=True)
        every, corners = every[rows], places.reshape(-1, 3).astype(np.int32)
        vectors = None if vectors is None else vectors[rows]
    corner_normals = None if vectors is None else CornerNormals(vectors, corners)
    return Surface(every, corners, tuple(spans), corner_normals)


def _normals(document: Document, attributes: Attributes, vertices: int) -> NDArray[np.floating] | None:
    """Return the normals of the vertices; None for none, with a warning where they cannot be read."""
    if "NORMAL" not in attributes:
        return None
    try:
        found = attributes.reals("NORMAL", {"VEC3"})
    except AssetError:
        found = None
    if found is None or len(found) != vertices:
        document.log.add("normals", "normals that cannot be read were ignored")
        return None
    return found


def _vectors(
    normals: list[NDArray[np.floating] | None], positions: list[NDArray[np.floating]]
) -> NDArray[np.floating] | None:
    """Join the normals of primitives, with zeros for those that have none; None where none has any."""
    if all(one is None for one in normals):
        return None
    if len(normals) == 1:
        return normals[0]
    rows = zip(normals, positions, strict=True)
    return np.concatenate([np.zeros((len(own), 3), np.float32) if one is None else one for one, own in rows])
