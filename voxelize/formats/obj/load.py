"""Loading OBJ files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.coordinate_range import FARTHEST, in_range
from voxrt.voxelize.formats.external_files import ExternalFiles
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.obj.appearance import appearance_of_faces, surface_appearance
from voxrt.voxelize.formats.obj.normals import read_normals
from voxrt.voxelize.formats.obj.objects import compact, split_objects
from voxrt.voxelize.formats.obj.statements import Statements, read_statements, texture_coordinates
from voxrt.voxelize.formats.obj.text import Text, read_text
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.formats.triangulation import triangulate_corners
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


def load_obj(
    path: str | Path, *, up: str | None = None, unit: float | None = None, allow_outside: bool = False
) -> Scene:
    """Read a Wavefront OBJ file, its material libraries and textures.

    Each ``o`` starts an object. In a file without ``o``, each ``g`` does; groups that share vertices are parts of one
    surface and stay one object. ``Kd`` and vertex colours are read as sRGB, as most programs do (the format does not
    define it). A texture replaces ``Kd``; vertex colours are multiplied with ``Kd``. Faces of materials with an opacity
    below 0.5 are left out. Names of materials survive a missing library.

    Parameters
    ----------
    path
        The file. Material libraries and textures are searched in its folder and below.
    up
        The file's up axis; None for y.
    unit
        Metres per unit of the file; None for 1.
    allow_outside
        Whether material libraries and textures may stand outside the file's folder.

    Returns
    -------
    Scene
        Objects, and materials in order of first use; those of textures and vertex colours last.

    Raises
    ------
    AssetError
        The file or an image is broken, or a face is invalid.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    log = WarningLog()
    text = read_text(path)
    statements = read_statements(text, log)
    _refuse_unreadable_positions(text, statements, log)
    table = MaterialTable()
    external_files = ExternalFiles.of(path, allow_outside=allow_outside)
    appearance = appearance_of_faces(text, statements, external_files, table, log)
    uv = None
    if any(placement is not None for placement in appearance.image_placements):
        uv, has_coordinates = texture_coordinates(text, statements)
        log.add(
            "texture",
            "textured faces without texture coordinates took the colour of the texture's corner",
            int(
                (
                    ~has_coordinates & (appearance.rows >= 0) & _textured(appearance.rows, appearance.image_placements)
                ).sum()
            ),
        )
    corners, faces = triangulate_corners(statements.positions, statements.counts, statements.corners)
    visible = (appearance.materials[faces] != 0) | (appearance.rows[faces] >= 0)
    if not visible.all():
        corners, faces = corners[visible], faces[visible]
    if not len(faces):
        raise AssetError(path, "has no visible faces", fix="make its materials opaque or export its polygons")
    triangles = statements.corners[corners].astype(np.int32)
    normals = read_normals(text, statements, log)
    parts = list(split_objects(path.stem, statements, triangles, faces))
    loaded = [
        LoadedMesh(
            *compact(statements.positions, triangles[chosen]),
            appearance.materials[faces[chosen]],
            surface_appearance(statements, appearance, uv, corners[chosen], faces[chosen]),
            None if normals is None else CornerNormals(normals[0], normals[1][corners[chosen]]),
        )
        for _, chosen in parts
    ]
    transform = scene_transform(up, unit)
    objects = tuple(
        SceneObject(name, mesh, transform)
        for (name, _), mesh in zip(parts, assign_materials(loaded, table, log), strict=True)
        if len(mesh.triangles)
    )
    if not objects:
        raise AssetError(path, "has no visible faces", fix="make its textures opaque")
    return Scene(path.stem, objects, table.materials(), log.warnings())


def _textured(rows: NDArray[np.int32], image_placements: Sequence[object]) -> NDArray[np.bool_]:
    """Tell which faces have a texture."""
    by_row = np.array([placement is not None for placement in image_placements], dtype=np.bool_)
    return by_row[rows]


def _refuse_unreadable_positions(text: Text, statements: Statements, log: WarningLog) -> None:
    broken = ~in_range(statements.positions)
    if not broken.any():
        return
    at_corner = np.flatnonzero(broken[statements.corners])
    if len(at_corner):
        face = int(np.searchsorted(np.cumsum(statements.counts), at_corner[0], side="right"))
        vertex = statements.corners[at_corner[0]] + 1
        raise AssetError(
            text.path,
            f"vertex {vertex} of a face has a coordinate that is not a number below {FARTHEST:g}",
            place=text.place(int(statements.face_lines[face])),
            fix="export it again",
        )
    log.add("unused-vertex", "unused vertices with a coordinate that is not a number were ignored", int(broken.sum()))
