"""Normals that a file gives to the corners of triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray


class CornerNormals(Value, frozen=True, eq=False):
    """The normals that the author gave to the corners of a mesh's triangles.

    Attributes
    ----------
    vectors
        float32 or float64, shape (N, 3): directions in the mesh's frame, of any length. One that is zero or not finite
        counts as none.
    rows
        int32, shape (T, 3): the row of `vectors` for each corner of each triangle; -1 for a corner without a normal.

    Raises
    ------
    TypeError, ValueError
        An array of another kind, shape or range.

    Examples
    --------
    >>> normals = CornerNormals([[0, 0, 2], [0, 1, 0]], [[0, 1, -1]])
    >>> normals.of_corners()[0].tolist()
    [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]
    """

    vectors: NDArray[np.floating]
    rows: NDArray[np.int32]

    def __post_init__(self) -> None:
        vectors = arguments.real_array("CornerNormals.vectors", self.vectors, ("N", 3), finite=False)
        rows = arguments.whole_array(
            "CornerNormals.rows", self.rows, ("T", 3), np.int32, low=-1, high=max(len(vectors) - 1, -1)
        )
        force_setattr(self, "vectors", vectors)
        force_setattr(self, "rows", rows)

    def __repr__(self) -> str:
        return f"CornerNormals(triangles={len(self.rows)}, vectors={len(self.vectors)})"

    def of_triangles(self, chosen: NDArray[np.bool_]) -> CornerNormals:
        """Return the normals of some triangles: bool, shape (T,)."""
        return CornerNormals(self.vectors, self.rows[chosen])

    def of_corners(self) -> NDArray[np.float64]:
        """Return unit normals, float64, shape (T, 3, 3); zeros where a corner has none."""
        found = np.concatenate([self.vectors.astype(np.float64), np.zeros((1, 3))])
        largest = np.abs(found).max(axis=1, keepdims=True)
        usable = np.isfinite(largest) & (largest > 0)
        found = np.where(usable, found / np.where(usable, largest, 1.0), 0.0)  # no square overflows or vanishes
        found /= np.where(usable, np.linalg.norm(found, axis=1, keepdims=True), 1.0)
        return found[self.rows]
