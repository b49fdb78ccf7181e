"""Meshes: triangles and their materials."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.colour.appearance import SurfaceAppearance
from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.materials import MATERIAL_LIMIT
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MOST_CELLS_PER_SIDE = 1 << 16


class MaterialMap(Value, frozen=True, eq=False):
    """Materials that vary over triangles, made for one grid by :func:`voxrt.voxelize.assign_colours`.

    Each mapped triangle lies in a raster of material ids. A point of the triangle has raster coordinates (column, row),
    interpolated between those of the corners, and takes the id of the cell floor(column), floor(row).

    Attributes
    ----------
    sizes
        int32, shape (T, 2): columns and rows of each triangle's raster, 1 … 65536; 0 and 0 for a triangle with one
        material.
    corners
        float32 or float64, shape (T, 3, 2): raster coordinates (column, row) of the corners of each triangle.
    materials
        uint8, shape (sum of columns times rows,): material ids, raster by raster, row by row; 0 where the surface is
        cut away.

    Raises
    ------
    TypeError, ValueError
        An array of another kind, shape or range.

    Examples
    --------
    One triangle of which the left half has material 1 and the right half material 2:

    >>> MaterialMap([[2, 1]], [[[0, 0], [2, 0], [0, 1]]], [1, 2])
    MaterialMap(triangles=1, cells=2)
    """

    sizes: NDArray[np.int32]
    corners: NDArray[np.floating]
    materials: NDArray[np.uint8]

    def __post_init__(self) -> None:
        sizes = arguments.whole_array(
            "MaterialMap.sizes", self.sizes, ("T", 2), np.int32, low=0, high=_MOST_CELLS_PER_SIDE
        )
        if ((sizes == 0).any(axis=1) != (sizes == 0).all(axis=1)).any():
            raise ValueError("MaterialMap.sizes must be 0 in both columns of a row, or in neither")
        corners = arguments.real_array("MaterialMap.corners", self.corners, (len(sizes), 3, 2), finite=False)
        cells = int(np.prod(sizes, axis=1, dtype=np.int64).sum())
        materials = arguments.whole_array(
            "MaterialMap.materials", self.materials, (cells,), np.uint8, low=0, high=MATERIAL_LIMIT
        )
        force_setattr(self, "sizes", sizes)
        force_setattr(self, "corners", corners)
        force_setattr(self, "materials", materials)

    def __repr__(self) -> str:
        return f"MaterialMap(triangles={len(self.sizes)}, cells={len(self.materials)})"


class Mesh(Value, frozen=True, eq=False):
    """Triangles in their object's frame. Instances share one mesh.

    Attributes
    ----------
    positions
        float32 or float64, shape (V, 3): vertices, finite where a triangle uses them. Other numbers become float64.
    triangles
        int32, shape (T, 3): rows of `positions`, counter-clockwise seen from outside.
    materials
        uint8, shape (T,): material ids, 1 … 255. A triangle with an appearance of its own has its base material.
    appearance
        Textures and vertex colours of the triangles; None where `materials` alone give the colour.
    material_map
        Materials that vary over triangles, which the voxelizer prefers to `materials`; None before
        :func:`voxrt.voxelize.assign_colours`.
    normals
        The normals that the author gave; None for none. Baked light uses them.

    Raises
    ------
    TypeError, ValueError
        An array of another kind, shape or range; a vertex of a triangle that is not finite.

    Examples
    --------
    >>> Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [1])
    Mesh(vertices=3, triangles=1)
    >>> Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]], [1])
    Traceback (most recent call last):
        ...
    ValueError: Mesh.triangles[0, 2] must be an integer 0 … 2, not 3
    """

    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]
    materials: NDArray[np.uint8]
    appearance: SurfaceAppearance | None = None
    material_map: MaterialMap | None = None
    normals: CornerNormals | None = None

    def __post_init__(self) -> None:
        positions, triangles = checked_surface("Mesh", self.positions, self.triangles)
        count = len(triangles)
        force_setattr(self, "positions", positions)
        force_setattr(self, "triangles", triangles)
        force_setattr(
            self,
            "materials",
            arguments.whole_array("Mesh.materials", self.materials, (count,), np.uint8, low=1, high=MATERIAL_LIMIT),
        )
        if self.appearance is not None:
            appearance = arguments.instance("Mesh.appearance", self.appearance, SurfaceAppearance)
            _same_length("Mesh.appearance", len(appearance.rows), count)
        if self.material_map is not None:
            material_map = arguments.instance("Mesh.material_map", self.material_map, MaterialMap)
            _same_length("Mesh.material_map", len(material_map.sizes), count)
        if self.normals is not None:
            normals = arguments.instance("Mesh.normals", self.normals, CornerNormals)
            _same_length("Mesh.normals", len(normals.rows), count)

    def __repr__(self) -> str:
        parts = [f"vertices={len(self.positions)}", f"triangles={len(self.triangles)}"]
        parts += [f"appearance={self.appearance!r}"] * (self.appearance is not None)
        parts += [f"material_map={self.material_map!r}"] * (self.material_map is not None)
        parts += [f"normals={self.normals!r}"] * (self.normals is not None)
        return f"Mesh({', '.join(parts)})"


def checked_surface(owner: str, positions: object, triangles: object) -> tuple[NDArray[np.floating], NDArray[np.int32]]:
    """Return the vertices and triangles of a surface, checked as :class:`Mesh` says.

    `owner` is the class, for errors.
    """
    vertices = arguments.real_array(f"{owner}.positions", positions, ("V", 3), finite=False)
    rows = arguments.whole_array(
        f"{owner}.triangles", triangles, ("T", 3), np.int32, low=0, high=max(len(vertices) - 1, 0)
    )
    if len(rows) and not len(vertices):
        raise ValueError(f"{owner}.triangles has {len(rows)} rows, and {owner}.positions has no vertices")
    if not np.isfinite(vertices).all():
        used = np.zeros(len(vertices), np.bool_)
        used[rows.reshape(-1)] = True
        wrong = np.flatnonzero(used & ~np.isfinite(vertices).all(axis=1))
        if len(wrong):
            first = int(wrong[0])
            raise ValueError(f"{owner}.positions[{first}] must be finite, not {vertices[first].tolist()}")
    return vertices, rows


def _same_length(name: str, has: int, triangles: int) -> None:
    if has != triangles:
        raise ValueError(f"{name} is for {has} triangles, and the mesh has {triangles}")


NO_TRIANGLES = Mesh(np.empty((0, 3)), np.empty((0, 3), np.int32), np.empty(0, np.uint8))
"""The mesh of an object that consists of colliders alone."""
