"""A PLY file to a scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.asset_bytes import read_asset
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.ply.format import Column, ListColumn, Table, read_tables
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.formats.triangulation import triangulate
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from numpy.typing import NDArray

OPAQUE_FROM = 0.5
"""Faces of lower opacity are left out."""


def load_ply(path: str | Path, *, up: str | None = None, unit: float | None = None) -> Scene:
    """Read a PLY file: vertices and polygons, with the colours of either, read as sRGB.

    Parameters
    ----------
    path
        The file.
    up
        The file's up axis; None for y.
    unit
        Metres per unit of the file; None for 1.

    Raises
    ------
    AssetError
        The file cannot be read, contradicts its header, or has no faces.
    """
    path = Path(path)
    data = read_asset(path)
    log = WarningLog()
    tables = read_tables(path, data)
    positions, counts, corners, kept = _geometry(path, tables, log)
    triangles, faces = triangulate(positions, counts, corners)
    table = MaterialTable()
    appearance = _appearance(tables, triangles, kept[faces])
    materials = np.zeros(len(triangles), dtype=np.uint8)
    if appearance is None:
        materials[:] = table.default(log, len(counts))
    (mesh,) = assign_materials([LoadedMesh(positions, triangles, materials, appearance)], table, log)
    if not len(mesh.triangles):
        raise AssetError(path, "has no visible faces", fix="give its colours an opacity of 0.5 or more")
    one = SceneObject(path.stem, mesh, scene_transform(up, unit))
    return Scene(path.stem, (one,), table.materials(), log.warnings())


def _appearance(
    tables: dict[str, Table], triangles: NDArray[np.int32], faces: NDArray[np.int64]
) -> SurfaceAppearance | None:
    """Return the faces' colours of triangles, else their vertices'; None where the file has neither."""
    by_face, by_vertex = _colours(tables.get("face", {})), _colours(tables.get("vertex", {}))
    if "tristrips" in tables:  # strips have no colours of faces
        by_face = None
    if by_face is not None:
        colours = np.repeat(by_face[faces][:, None], 3, axis=1)
    elif by_vertex is not None:
        colours = by_vertex[triangles]
    else:
        return None
    name = "face colours" if by_face is not None else "vertex colours"
    cutoff = OPAQUE_FROM if (colours[:, :, 3] < 1.0).any() else 0.0
    rows = np.zeros(len(triangles), dtype=np.int32)
    return SurfaceAppearance(
        (Appearance(name, cutoff=cutoff),), rows, np.zeros((len(triangles), 3, 2)), colours.astype(np.float32)
    )


def _colours(table: Table) -> NDArray[np.float64] | None:
    """Return linear colour and alpha, float64, shape (N, 4), of rows whose bytes or reals are sRGB."""
    channels = [table.get(name) for name in ("red", "green", "blue")]
    if any(one is None or isinstance(one, ListColumn) for one in channels):
        return None
    alpha = table.get("alpha")
    stored = np.stack([_unit(one) for one in channels if one is not None and not isinstance(one, ListColumn)], axis=1)
    linear = LINEAR_OF_SRGB8[np.round(stored * 255.0).astype(np.uint8)]
    opacity = np.ones(len(stored)) if alpha is None or isinstance(alpha, ListColumn) else _unit(alpha)
    return np.column_stack([linear, opacity])


def _unit(column: Column) -> NDArray[np.float64]:
    """Return values of 0 … 1 from integers or reals; in ASCII files the range tells which."""
    full = {"u1": 255.0, "i1": 127.0, "u2": 65535.0, "i2": 32767.0}.get(column.dtype.str[1:], 1.0)
    values = np.nan_to_num(column.astype(np.float64), nan=0.0, posinf=1.0, neginf=0.0)
    if full == 1.0 and len(values) and values.max() > 1.0:
        full = 255.0
    return np.clip(values / full, 0.0, 1.0)


def _polygons(tables: dict[str, Table]) -> ListColumn | None:
    """Return the file's faces, then the triangles of its strips; None where it has neither."""
    faces, strips = (
        table.get("vertex_indices", table.get("vertex_index"))
        for table in (tables.get("face", {}), tables.get("tristrips", {}))
    )
    if not isinstance(strips, ListColumn):
        return faces if isinstance(faces, ListColumn) else None
    triangles = triangles_of_strips(strips)
    counts, values = np.full(len(triangles), 3, dtype=np.int64), triangles.reshape(-1)
    if isinstance(faces, ListColumn):
        counts = np.concatenate([faces.counts, counts])
        values = np.concatenate([faces.values.astype(np.float64), values])
    return ListColumn(counts, values)


def triangles_of_strips(strips: ListColumn) -> NDArray[np.float64]:
    """Return the triangles of strips, every other one turned round; -1 begins a strip anew.

    Their corners are float64, shape (T, 3), as ASCII files have them.
    """
    # One -1 after each row, so that rows are strips of their own.
    stored = np.insert(strips.values.astype(np.float64), np.cumsum(strips.counts), -1.0)
    places = np.arange(len(stored))
    breaks = stored == -1
    since = places - np.maximum.accumulate(np.where(breaks, places, -1)) - 1
    last = np.flatnonzero(~breaks & (since >= 2))
    even = (since[last] % 2 == 0)[:, None]
    first, second, third = (stored[last - back] for back in (2, 1, 0))
    triangles = np.where(even, np.stack([first, second, third], axis=1), np.stack([second, first, third], axis=1))
    a, b, c = triangles.T
    real: NDArray[np.bool_] = (a != b) & (b != c) & (a != c)
    return triangles[real]  # without those that only connect one strip to the next


def _geometry(
    path: Path, tables: dict[str, Table], log: WarningLog
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Positions, corners per face, corners, and which of the file's faces they are of."""
    vertices = tables.get("vertex", {})
    axes = [vertices.get(axis) for axis in "xyz"]
    polygons = _polygons(tables)
    if polygons is None or not len(polygons.counts):
        raise AssetError(path, "has no faces", fix="export it with its polygons; point clouds have no surface")
    if any(axis is None or isinstance(axis, ListColumn) for axis in axes):
        raise AssetError(path, "has vertices without x, y and z", fix="export it again")
    positions = np.stack([np.asarray(axis, dtype=np.float64) for axis in axes], axis=1)
    counts = polygons.counts
    # Out of range before the cast, for ASCII numbers may be anything; NaN compares false.
    wrong = np.flatnonzero(~((polygons.values >= 0) & (polygons.values < len(positions))))
    if len(wrong):
        face = int(np.searchsorted(np.cumsum(counts), wrong[0], side="right"))
        problem = f"vertex {polygons.values[wrong[0]]} does not exist: the file has {len(positions)}"
        raise AssetError(path, problem, place=f"face {face}", fix="export it again")
    corners = polygons.values.astype(np.int64)
    if not np.isfinite(positions[corners]).all():
        raise AssetError(path, "a face has a vertex whose coordinates are not numbers", fix="export it again")
    keep = counts >= 3
    log.add("degenerate-face", "faces of fewer than three corners were left out", int((~keep).sum()))
    corners, counts = corners[np.repeat(keep, counts)], counts[keep]
    if not len(counts):
        raise AssetError(path, "has no faces of three corners or more", fix="export it again")
    return positions, counts, corners, np.flatnonzero(keep)
