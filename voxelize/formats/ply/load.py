"""A PLY file to a scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ExternalFiles, asset_name, read_asset
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.ply.colours import linear_colours
from voxrt.voxelize.formats.ply.format import ListColumn, Table, read_ply
from voxrt.voxelize.formats.ply.painting import image_of_faces, read_textures, surface_appearance, texture_coordinates
from voxrt.voxelize.formats.ply.points import load_points, places
from voxrt.voxelize.formats.scene_frame import FARTHEST, hint_up_axis, in_range, scene_transform
from voxrt.voxelize.formats.triangulation import triangulate_corners
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from numpy.typing import NDArray


def load_ply(
    path: str | Path,
    *,
    up: str | None = None,
    unit: float | None = None,
    allow_outside: bool = False,
    opaque_from: float = OPAQUE_FROM,
    points: int | None = None,
) -> Scene:
    """Read a PLY file: vertices and polygons, with a texture, or with the colours of either, read as sRGB.

    A file without polygons is a point cloud; one of Gaussians, a cloud of their centres.

    Parameters
    ----------
    path
        The file.
    up
        The file's up axis; None for y.
    unit
        Metres per unit of the file; None for 1.
    allow_outside
        Whether textures may stand outside the file's folder.
    opaque_from
        Faces, points and Gaussians of lower opacity are left out.
    points
        How many points of a point cloud make a voxel solid; None for 1.

    Raises
    ------
    AssetError
        The file cannot be read, contradicts its header, has neither faces nor points, or a broken texture.
    """
    path = Path(path)
    data = read_asset(path)
    log = WarningLog()
    ply = read_ply(path, data)
    tables = ply.tables
    vertices, polygons = tables.get("vertex", {}), _polygons(tables)
    if polygons is None:
        return load_points(path, vertices, up, unit, log, opaque_from=opaque_from, least=points)
    if points is not None:
        log.add("ignored-option", "--points was ignored: the file has faces")
    positions, counts, corners, kept = _geometry(path, vertices, polygons, log)
    cut, faces = triangulate_corners(positions, counts, corners)
    triangles = corners.reshape(-1, 3) if (counts == 3).all() else corners[cut]
    table = MaterialTable()
    by_colour = _colours_of_corners(tables, triangles, kept[faces], log)
    textures = read_textures(path, ExternalFiles.of(path, allow_outside=allow_outside), ply.textures, log)
    coordinates = texture_coordinates(tables, corners, kept, counts, log) if textures else None
    if textures and coordinates is None:
        log.add("texture", "the file names a texture and has no texture coordinates: the texture was not used")
    appearance = surface_appearance(
        textures, coordinates, image_of_faces(tables, kept[faces]), by_colour, cut, opaque_from=opaque_from
    )
    materials = np.zeros(len(triangles), dtype=np.uint8)
    bare = np.ones(len(triangles), dtype=np.bool_) if appearance is None else appearance.rows < 0
    if bare.any():
        count = int(np.count_nonzero(np.bincount(faces[bare])))
        materials[bare] = table.default(None if appearance is None else log, count)
    loaded = LoadedMesh(positions, triangles, materials, appearance, _normals(vertices, triangles))
    (mesh,) = assign_materials([loaded], table, log, opaque_from)
    if not len(mesh.triangles):
        raise AssetError(
            path, "has no visible faces", fix="make its colours opaque, or build with a lower --opaque-from"
        )
    hint_up_axis(up, mesh.positions, mesh.triangles, log)
    one = SceneObject(asset_name(path), mesh, scene_transform(up, unit))
    return Scene(asset_name(path), (one,), table.materials(), log.warnings())


def _normals(vertices: Table, triangles: NDArray[np.int32]) -> CornerNormals | None:
    """Return the normals of the vertices; None for none."""
    axes = [vertices.get(axis) for axis in ("nx", "ny", "nz")]
    if any(axis is None or isinstance(axis, ListColumn) for axis in axes):
        return None
    return CornerNormals(np.stack([np.asarray(axis, dtype=np.float64) for axis in axes], axis=1), triangles)


def _colours_of_corners(
    tables: dict[str, Table], triangles: NDArray[np.int32], faces: NDArray[np.int64], log: WarningLog
) -> tuple[str, NDArray[np.float64]] | None:
    """Return the faces' colours of triangles' corners, else their vertices', and what they are; None for neither."""
    by_face, by_vertex = (linear_colours(tables.get(element, {}), log) for element in ("face", "vertex"))
    if by_face is not None and "tristrips" not in tables:  # strips have no colours of faces
        return "face colours", np.repeat(by_face[faces][:, None], 3, axis=1)
    return None if by_vertex is None else ("vertex colours", by_vertex[triangles])


def _polygons(tables: dict[str, Table]) -> ListColumn | None:
    """Return the file's faces, then the triangles of its strips; None where it has no rows of either."""
    faces, strips = (
        table.get("vertex_indices", table.get("vertex_index"))
        for table in (tables.get("face", {}), tables.get("tristrips", {}))
    )
    if not any(isinstance(rows, ListColumn) and len(rows.counts) for rows in (faces, strips)):
        return None
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
    path: Path, vertices: Table, polygons: ListColumn, log: WarningLog
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int32], NDArray[np.int64]]:
    """Positions, corners per face, corners, and which of the file's faces they are of."""
    positions = places(path, vertices).astype(np.float64)
    counts = polygons.counts
    # Out of range before the cast, for ASCII numbers may be anything; NaN compares false.
    if len(polygons.values) and not (polygons.values.min() >= 0 and polygons.values.max() < len(positions)):
        wrong = np.flatnonzero(~((polygons.values >= 0) & (polygons.values < len(positions))))
        face = int(np.searchsorted(np.cumsum(counts), wrong[0], side="right"))
        problem = f"vertex {polygons.values[wrong[0]]} does not exist: the file has {len(positions)}"
        raise AssetError(path, problem, place=f"face {face}", fix="export it again")
    corners = polygons.values.astype(np.int32)
    if not (usable := in_range(positions)).all() and not usable[corners].all():
        problem = f"a face has a vertex whose coordinates are not numbers below {FARTHEST:g}"
        raise AssetError(path, problem, fix="export it again")
    keep = counts >= 3
    log.add("degenerate-face", "faces of fewer than three corners were left out", int((~keep).sum()))
    if not keep.all():
        corners, counts = corners[np.repeat(keep, counts)], counts[keep]
    if not len(counts):
        raise AssetError(path, "has no faces of three corners or more", fix="export it again")
    return positions, counts, corners, np.flatnonzero(keep)
