"""The surface of one USD prim, in its own frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from pxr import Usd, UsdGeom

from voxrt.voxelize import primitive_meshes
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.scene_frame import FARTHEST, in_range
from voxrt.voxelize.formats.triangulation import triangulate_corners
from voxrt.voxelize.formats.usd import values

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.usd.skin import Deformed
    from voxrt.voxelize.warning_log import WarningLog

# The attributes of each solid, in the order of its function's parameters.
_DIMENSIONS = {
    "Cube": ("size",),
    "Sphere": ("radius",),
    "Cylinder": ("radius", "height", "axis"),
    "Cylinder_1": ("radiusBottom", "radiusTop", "height", "axis"),
    "Cone": ("radius", "height", "axis"),
    "Capsule": ("radius", "height", "axis"),
    "Capsule_1": ("radiusBottom", "radiusTop", "height", "axis"),
    "Plane": ("width", "length", "axis"),
}
_FUNCTIONS: dict[str, Callable[..., primitive_meshes.Surface]] = {
    "Cube": primitive_meshes.cube,
    "Sphere": primitive_meshes.sphere,
    "Cylinder": lambda radius, height, axis: primitive_meshes.cylinder(radius, radius, height, axis),
    "Cylinder_1": primitive_meshes.cylinder,
    "Cone": primitive_meshes.cone,
    "Capsule": lambda radius, height, axis: primitive_meshes.capsule(radius, radius, height, axis),
    "Capsule_1": primitive_meshes.capsule,
    "Plane": primitive_meshes.plane,
}


class Surface(Struct, frozen=True, eq=False):
    """Triangles of one prim."""

    positions: NDArray[np.float64]  # float64, shape (V, 3), finite, in the prim's frame
    triangles: NDArray[np.int32]  # int32, shape (T, 3), counter-clockwise seen from outside
    faces: NDArray[np.int64]  # int64, shape (T,): the face of the prim that each triangle belongs to
    face_count: int  # the number of faces of the prim, holes included
    corners: NDArray[np.int64]  # int64, shape (T, 3): each triangle's corners, among all corners of the faces
    corner_count: int  # the number of corners of all faces; 0 for solids


def surface_of(
    prim: Usd.Prim, path: Path, time: Usd.TimeCode, log: WarningLog, deformed: Deformed | None = None
) -> Surface | None:
    """Return the surface of a Mesh or of one of the solids; None for any other prim and for a mesh without faces.

    Raise AssetError for a mesh whose topology contradicts itself, or a solid with an invalid dimension.
    """
    if prim.IsA(UsdGeom.Mesh):
        return _mesh(UsdGeom.Mesh(prim), path, time, log, deformed)
    solid = _solid(prim, path, time)
    if solid is None:
        return None
    positions, triangles = solid
    none = np.zeros_like(triangles, dtype=np.int64)
    return Surface(positions, triangles, np.zeros(len(triangles), dtype=np.int64), 1, none, 0)


def _mesh(
    mesh: UsdGeom.Mesh, path: Path, time: Usd.TimeCode, log: WarningLog, deformed: Deformed | None
) -> Surface | None:
    prim = mesh.GetPrim()
    place = str(prim.GetPath())
    positions = values.points(mesh.GetPointsAttr(), time, path) if deformed is None else deformed.positions
    counts = values.integers(mesh.GetFaceVertexCountsAttr(), time, path)
    corners = values.integers(mesh.GetFaceVertexIndicesAttr(), time, path)
    if not len(counts) or not len(positions):
        log.add("empty-mesh", "meshes without faces were left out")
        return None
    _check_topology(path, place, positions, counts, corners)
    keep = counts >= 3
    log.add("degenerate-face", "faces of fewer than three corners were left out", int((~keep).sum()))
    holes = values.integers(mesh.GetHoleIndicesAttr(), time, path)
    keep[holes[(holes >= 0) & (holes < len(counts))]] = False
    if mesh.GetSubdivisionSchemeAttr().Get() != UsdGeom.Tokens.none:
        log.add("subdivision", "subdivision surfaces were replaced by their control cage")
    kept = np.flatnonzero(keep)
    places = np.flatnonzero(np.repeat(keep, counts))
    cut, faces = triangulate_corners(positions, counts[kept], corners[places])
    if mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded:
        cut = np.ascontiguousarray(cut[:, ::-1])
    chosen = places[cut]
    return Surface(positions, corners[chosen].astype(np.int32), kept[faces], len(counts), chosen, len(corners))


def _check_topology(
    path: Path, place: str, positions: NDArray[np.float64], counts: NDArray[np.int64], corners: NDArray[np.int64]
) -> None:
    problem = ""
    if (counts < 0).any() or int(counts.sum()) != len(corners):
        problem = f"faceVertexCounts ask for {int(counts.sum())} corners and faceVertexIndices has {len(corners)}"
    elif len(corners) and (corners.min() < 0 or corners.max() >= len(positions)):
        problem = f"faceVertexIndices go from {corners.min()} to {corners.max()} and points has {len(positions)}"
    elif not in_range(positions).all():
        problem = "points has a coordinate that is not a finite number"
    if problem:
        raise AssetError(path, problem, place=place, fix="export the mesh again")


def solid_key(prim: Usd.Prim, time: Usd.TimeCode) -> str | None:
    """Return what tells a solid's surface from others': its kind and dimensions; None for prims that are no solid."""
    kind = str(prim.GetTypeName())
    if kind not in _DIMENSIONS:
        return None
    return " ".join([kind, *(str(prim.GetAttribute(name).Get(time)) for name in _DIMENSIONS[kind])])


def _solid(prim: Usd.Prim, path: Path, time: Usd.TimeCode) -> primitive_meshes.Surface | None:
    kind = str(prim.GetTypeName())
    if kind not in _DIMENSIONS:
        return None
    dimensions: list[float | str] = []
    for name in _DIMENSIONS[kind]:
        value = prim.GetAttribute(name).Get(time)
        place = str(prim.GetPath())
        if name == "axis" and value not in ("X", "Y", "Z"):
            raise AssetError(path, f"axis {str(value)!r} is not X, Y or Z", place=place, fix="use one of them")
        if name != "axis" and not (isinstance(value, (int, float)) and 0 <= value < FARTHEST):
            raise AssetError(path, f"{name} {value} is not a length", place=place, fix="use a positive number")
        dimensions.append(str(value) if name == "axis" else float(value))
    return _FUNCTIONS[kind](*dimensions)
