"""Meshes: the primitives of one glTF mesh as one set of triangles, deformed by morph targets and skin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.formats.gltf.attributes import Attributes
from voxrt.voxelize.formats.gltf.deform import morphed, skinned
from voxrt.voxelize.formats.gltf.primitives import has_area, read_triangles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.deform import Pose
    from voxrt.voxelize.formats.gltf.document import Document


@dataclass(frozen=True, eq=False, slots=True)
class Span:
    """The triangles of one primitive among those of its mesh.

    Attributes
    ----------
    primitive
        Its index in the mesh.
    attributes
        Its vertices.
    start, stop
        The first of its triangles, and the one after its last.
    corners
        int32, shape (stop - start, 3): rows of the primitive's own vertices.
    """

    primitive: int
    attributes: Attributes
    start: int
    stop: int
    corners: NDArray[np.int32]


@dataclass(frozen=True, eq=False, slots=True)
class Surface:
    """The triangles of a glTF mesh, in the order of its primitives.

    Attributes
    ----------
    positions
        float32 or float64, shape (V, 3), finite; few are unused.
    triangles
        int32, shape (T, 3), counter-clockwise seen from outside.
    spans
        The primitives that they come from.
    """

    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]
    spans: tuple[Span, ...]


def read_surface(document: Document, index: int, pose: Pose) -> Surface:
    """Read mesh `index` in `pose`."""
    positions: list[NDArray[np.floating]] = []
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
        first, count = shared[same]
        corners = read_triangles(document, attributes, primitive.mode, count, place)
        triangles.append(corners + np.int32(first) if first else corners)
        spans.append(Span(at, attributes, start, start + len(corners), corners))
        start += len(corners)
    if not start:
        return Surface(np.empty((0, 3)), np.empty((0, 3), np.int32), ())
    every = positions[0] if len(positions) == 1 else np.concatenate(positions)
    return Surface(*compact(every, triangles[0] if len(triangles) == 1 else np.concatenate(triangles)), tuple(spans))


def compact(
    positions: NDArray[np.floating], triangles: NDArray[np.int32]
) -> tuple[NDArray[np.floating], NDArray[np.int32]]:
    """Drop unused vertices where there must be many: a mesh may share the vertices of the whole file."""
    if len(positions) <= triangles.size:
        return positions, triangles
    rows, corners = np.unique(triangles, return_inverse=True)
    return positions[rows], corners.reshape(-1, 3).astype(np.int32)
