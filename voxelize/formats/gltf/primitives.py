"""Primitives to triangles: the modes that have area, indexed or not.

Source: Khronos, glTF 2.0 specification, section 3.7.2.1 (primitive topology).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.formats.gltf.schema import TRIANGLE_FAN, TRIANGLE_STRIP, TRIANGLES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.attributes import Attributes
    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import Primitive

_WITHOUT_AREA = ("points", "lines", "line loops", "line strips")


def has_area(document: Document, primitive: Primitive) -> bool:
    """Tell whether `primitive` is made of triangles; count it in the log where it is not."""
    if primitive.mode >= TRIANGLES:
        return True
    document.log.add("no-area", f"{_WITHOUT_AREA[primitive.mode]} were left out: they have no area to voxelize")
    return False


def read_triangles(
    document: Document, attributes: Attributes, mode: int, vertices: int, place: str
) -> NDArray[np.int32]:
    """Read the triangles of a primitive of `mode` that has `vertices` vertices and is at `place`.

    Return int32, shape (T, 3), counter-clockwise seen from outside. Raise AssetError where an index is out of range, or
    restarts the primitive, which glTF forbids.
    """
    stored = attributes.corners()
    document.charge((vertices if stored is None else len(stored)) * 4, place)
    if stored is None:
        corners = np.arange(vertices, dtype=np.int32)
    else:
        highest = int(stored.max(initial=0))
        if highest >= vertices:
            if highest == np.iinfo(stored.dtype).max:
                raise document.error(f"{place}.indices", "a primitive restart, which glTF does not allow")
            at = int(np.argmax(stored >= vertices))
            problem = f"index {int(stored[at])} at {at} is out of range: there are {vertices} vertices"
            raise document.error(f"{place}.indices", problem)
        # Indices in range read the same as signed numbers of their size.
        corners = np.ascontiguousarray(stored.view("<i4") if stored.itemsize == 4 else stored, np.int32)
    document.charge(len(corners) * 12, place)
    return _assembled(document, corners, TRIANGLES if attributes.is_compressed else mode)


def _assembled(document: Document, corners: NDArray[np.int32], mode: int) -> NDArray[np.int32]:
    """Make triangles, shape (T, 3), of `corners`, shape (N,), in the order of primitive mode `mode`."""
    if mode == TRIANGLES:
        whole = len(corners) // 3
        if whole * 3 != len(corners):
            document.log.add(
                "incomplete-triangle", "corners after the last whole triangle of a primitive were left out"
            )
        return corners[: whole * 3].reshape(whole, 3)
    if len(corners) < 3:
        document.log.add("incomplete-triangle", "corners after the last whole triangle of a primitive were left out")
        return np.empty((0, 3), np.int32)
    if mode == TRIANGLE_STRIP:
        triangles = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        triangles[1::2] = triangles[1::2][:, [0, 2, 1]]
    else:
        assert mode == TRIANGLE_FAN
        triangles = np.stack([corners[1:-1], corners[2:], np.full(len(corners) - 2, corners[0])], axis=1)
    # Triangles that use a corner twice only connect one strip to the next.
    a, b, c = triangles.T
    return np.ascontiguousarray(triangles[(a != b) & (b != c) & (a != c)])
