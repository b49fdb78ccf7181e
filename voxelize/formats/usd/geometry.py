"""The surface of one USD prim, in its own frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom

from voxrt.voxelize import primitives
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.usd import values
from voxrt.voxelize.polygons import triangulate_corners

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.usd.skin import Deformed
    from voxrt.voxelize.notes import Notes

# Positions USD calls legal and no scene has: beyond it, squares overflow.
_FARTHEST = 1e150


# The attributes of each solid, in the order of what makes it.
_MEASURES = {
    "Cube": ("size",),
    "Sphere": ("radius",),
    "Cylinder": ("radius", "height", "axis"),
    "Cylinder_1": ("radiusBottom", "radiusTop", "height", "axis"),
    "Cone": ("radius", "height", "axis"),
    "Capsule": ("radius", "height", "axis"),
    "Capsule_1": ("radiusBottom", "radiusTop", "height", "axis"),
    "Plane": ("width", "length", "axis"),
}
_MAKERS: dict[str, Callable[..., primitives.Surface]] = {
    "Cube": primitives.cube,
    "Sphere": primitives.sphere,
    "Cylinder": lambda radius, height, axis: primitives.cylinder(radius, radius, height, axis),
    "Cylinder_1": primitives.cylinder,
    "Cone": primitives.cone,
    "Capsule": lambda radius, height, axis: primitives.capsule(radius, radius, height, axis),
    "Capsule_1": primitives.capsule,
    "Plane": primitives.plane,
}


@dataclass(frozen=True, eq=False, slots=True)
class Surface:
    """Triangles of one prim.

    Attributes
    ----------
    positions
        float64, shape (V, 3), finite, in the prim's frame.
    triangles
        int32, shape (T, 3), counter-clockwise seen from outside.
    faces
        int64, shape (T,): the prim's own face that each triangle is of.
    face_count
        How many faces the prim has, holes included.
    corners
        int64, shape (T, 3): the corners of its faces that each triangle has, among all of them.
    corner_count
        How many corners its faces have; 0 for solids.
    """

    positions: NDArray[np.float64]
    triangles: NDArray[np.int32]
    faces: NDArray[np.int64]
    face_count: int
    corners: NDArray[np.int64]
    corner_count: int


def surface_of(
    prim: Usd.Prim, path: Path, time: Usd.TimeCode, notes: Notes, deformed: Deformed | None = None
) -> Surface | None:
    """Return the surface of a Mesh or of one of the solids; None for any other prim and for a mesh without faces.

    Raises
    ------
    AssetError
        A mesh whose topology contradicts itself, or a solid whose measures are no lengths.
    """
    if prim.IsA(UsdGeom.Mesh):
        return _mesh(UsdGeom.Mesh(prim), path, time, notes, deformed)
    solid = _solid(prim, path, time)
    if solid is None:
        return None
    positions, triangles = solid
    none = np.zeros_like(triangles, dtype=np.int64)
    return Surface(positions, triangles, np.zeros(len(triangles), dtype=np.int64), 1, none, 0)


def _mesh(
    mesh: UsdGeom.Mesh, path: Path, time: Usd.TimeCode, notes: Notes, deformed: Deformed | None
) -> Surface | None:
    prim = mesh.GetPrim()
    place = str(prim.GetPath())
    positions = values.points(mesh.GetPointsAttr(), time, path) if deformed is None else deformed.positions
    counts = values.integers(mesh.GetFaceVertexCountsAttr(), time, path)
    corners = values.integers(mesh.GetFaceVertexIndicesAttr(), time, path)
    if not len(counts) or not len(positions):
        notes.add("empty-mesh", "meshes without faces were left out")
        return None
    _check_topology(path, place, positions, counts, corners)
    keep = counts >= 3
    notes.add("degenerate-face", "faces of fewer than three corners were left out", int((~keep).sum()))
    holes = values.integers(mesh.GetHoleIndicesAttr(), time, path)
    keep[holes[(holes >= 0) & (holes < len(counts))]] = False
    if mesh.GetSubdivisionSchemeAttr().Get() != UsdGeom.Tokens.none:
        notes.add("subdivision", "subdivision surfaces were taken as their control cage")
    kept = np.flatnonzero(keep)
    places = np.flatnonzero(np.repeat(keep, counts))
    cut, faces = triangulate_corners(positions, counts[kept], corners[places])
    if mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded:
        cut = np.ascontiguousarray(cut[:, ::-1])
    chosen = places[cut]
    return Surface(positions, corners[chosen].astype(np.int32), kept[faces], len(counts), chosen, len(corners))


def _check_topology(
    path: Path,
    place: str,
    positions: NDArray[np.float64],
    counts: NDArray[np.int64],
    corners: NDArray[np.int64],
) -> None:
    problem = ""
    if (counts < 0).any() or int(counts.sum()) != len(corners):
        problem = f"faceVertexCounts ask for {int(counts.sum())} corners and faceVertexIndices has {len(corners)}"
    elif len(corners) and (corners.min() < 0 or corners.max() >= len(positions)):
        problem = f"faceVertexIndices go from {corners.min()} to {corners.max()} and points has {len(positions)}"
    elif not (np.abs(positions) < _FARTHEST).all():
        problem = "points has a coordinate that is no number"
    if problem:
        raise AssetError(path, problem, place=place, fix="export the mesh again")


def solid_key(prim: Usd.Prim, time: Usd.TimeCode) -> str | None:
    """Return what tells a solid's surface from others': its kind and measures; None for prims that are no solid."""
    kind = str(prim.GetTypeName())
    if kind not in _MEASURES:
        return None
    return " ".join([kind, *(str(prim.GetAttribute(name).Get(time)) for name in _MEASURES[kind])])


def _solid(prim: Usd.Prim, path: Path, time: Usd.TimeCode) -> primitives.Surface | None:
    kind = str(prim.GetTypeName())
    if kind not in _MEASURES:
        return None
    measures: list[float | str] = []
    for name in _MEASURES[kind]:
        value = prim.GetAttribute(name).Get(time)
        place = str(prim.GetPath())
        if name == "axis" and value not in ("X", "Y", "Z"):
            raise AssetError(path, f"axis {str(value)!r} is none of X, Y, Z", place=place, fix="give one")
        if name != "axis" and not (isinstance(value, (int, float)) and 0 <= value < _FARTHEST):
            raise AssetError(path, f"{name} {value} is no length", place=place, fix="give a positive one")
        measures.append(str(value) if name == "axis" else float(value))
    return _MAKERS[kind](*measures)
