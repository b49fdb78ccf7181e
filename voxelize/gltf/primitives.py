"""Primitives to triangles: the modes that have area, indexed or not.

Source: Khronos, glTF 2.0 specification, section 3.7.2.1 (primitive topology).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.gltf.accessors import read_accessor
from voxrt.voxelize.gltf.schema import TRIANGLE_FAN, TRIANGLE_STRIP, TRIANGLES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.gltf.document import Document
    from voxrt.voxelize.gltf.schema import Primitive

_AREALESS = ("points", "lines", "line loops", "line strips")


def has_area(document: Document, primitive: Primitive) -> bool:
    """Tell whether `primitive` is made of triangles; note that it is left out where it is not."""
    if primitive.mode >= TRIANGLES:
        return True
    document.warn("no-area", f"{_AREALESS[primitive.mode]} were left out: they have no area to voxelize")
    return False


def read_triangles(document: Document, primitive: Primitive, vertices: int, place: str) -> NDArray[np.int32]:
    """Read the corners of the triangles of `primitive`, which has `vertices` vertices.

    Returns
    -------
    triangles
        int32, shape (T, 3), counter-clockwise seen from outside.

    Raises
    ------
    AssetError
        An index is out of range or restarts the primitive, which glTF does not allow.
    """
    if primitive.indices is None:
        document.charge(vertices * 4, place)
        corners = np.arange(vertices, dtype=np.int32)
    else:
        corners = _read_indices(document, primitive.indices, vertices, f"{place}.indices")
    return assemble(document, corners, primitive.mode, place)


def assemble(document: Document, corners: NDArray[np.int32], mode: int, place: str) -> NDArray[np.int32]:
    """Make triangles, int32, shape (T, 3), of `corners`, int32, shape (N,), in the order of primitive mode `mode`."""
    if mode == TRIANGLES:
        whole = len(corners) // 3
        if whole * 3 != len(corners):
            document.warn("incomplete-triangle", "corners after the last whole triangle of a primitive were left out")
        return corners[: whole * 3].reshape(whole, 3)
    if len(corners) < 3:
        document.warn("incomplete-triangle", "corners after the last whole triangle of a primitive were left out")
        return np.empty((0, 3), np.int32)
    document.charge(len(corners) * 12, place)
    if mode == TRIANGLE_STRIP:
        triangles = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        triangles[1::2] = triangles[1::2][:, [0, 2, 1]]
    else:
        assert mode == TRIANGLE_FAN
        triangles = np.stack([corners[1:-1], corners[2:], np.full(len(corners) - 2, corners[0])], axis=1)
    # Triangles that use a corner twice only join one strip to the next.
    a, b, c = triangles.T
    return np.ascontiguousarray(triangles[(a != b) & (b != c) & (a != c)])


def _read_indices(document: Document, accessor: int, vertices: int, place: str) -> NDArray[np.int32]:
    stored = read_accessor(document, accessor, place, {"SCALAR"})[:, 0]
    if stored.dtype.kind != "u":
        raise document.error(place, f"indices of type {stored.dtype.name}, they must be unsigned integers")
    highest = int(stored.max())
    if highest >= vertices:
        if highest == np.iinfo(stored.dtype).max:
            raise document.error(place, "a primitive restart, which glTF does not allow")
        at = int(np.argmax(stored >= vertices))
        raise document.error(place, f"index {int(stored[at])} at {at} is out of range: there are {vertices} vertices")
    document.charge(stored.size * 4, place)
    return stored.astype(np.int32)
