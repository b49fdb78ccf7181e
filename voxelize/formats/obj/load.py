"""Loading OBJ files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ExternalFiles, asset_name
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.obj.appearance import appearance_of_faces, surface_appearance
from voxrt.voxelize.formats.obj.objects import compact, split_objects
from voxrt.voxelize.formats.obj.statements import Statements, read_normals, read_statements, texture_coordinates
from voxrt.voxelize.formats.obj.text import Text, read_text
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.scene_frame import FARTHEST, hint_up_axis, in_range, scene_transform
from voxrt.voxelize.formats.triangulation import triangulate_corners
from voxrt.voxelize.formats.written_numbers import is_number, not_a_number
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.obj.mtl import MtlMaterial


def load_obj(
    path: str | Path,
    *,
    up: str | None = None,
    unit: float | None = None,
    allow_outside: bool = False,
    opaque_from: float = OPAQUE_FROM,
) -> Scene:
    """Read a Wavefront OBJ file, its material libraries and textures.

    Each ``o`` starts an object. In a file without ``o``, each ``g`` does; groups that share vertices are parts of
    one surface and stay one object. ``Kd`` and vertex colours are read as sRGB, as most programs do (the format
    does not define it). A texture replaces ``Kd``; vertex colours are multiplied with ``Kd``. Names of materials
    survive a missing library.

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
    opaque_from
        Faces of lower opacity are left out.

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
    appearance = appearance_of_faces(text, statements, external_files, table, log, opaque_from=opaque_from)
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
        raise _nothing_visible(path, appearance.left_out.values(), opaque_from)
    triangles = statements.corners[corners].astype(np.int32)
    normals = read_normals(text, statements, log)
    parts = list(split_objects(asset_name(path), statements, triangles, faces))
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
    hint_up_axis(up, statements.positions, triangles, log)
    objects = tuple(
        SceneObject(name, mesh, transform)
        for (name, _), mesh in zip(parts, assign_materials(loaded, table, log, opaque_from), strict=True)
        if len(mesh.triangles)
    )
    if not objects:
        raise AssetError(
            path, "has no visible faces", fix="make its textures opaque, or build with a lower --opaque-from"
        )
    return Scene(asset_name(path), objects, table.materials(), log.warnings())


def _nothing_visible(path: Path, left_out: Iterable[MtlMaterial], opaque_from: float) -> AssetError:
    """Return the error for a file of which no face is opaque enough."""
    first = next(iter(left_out), None)
    if first is None:
        return AssetError(path, "has no faces of three corners or more", fix="export it with its polygons")
    problem = f"no face is as opaque as {opaque_from:g}: material {first.name!r} has {first.opacity_statement!r}"
    opaque = "Tr 0" if first.opacity_statement.lower().startswith("tr") else "d 1"
    return AssetError(
        path, problem, fix=f"write {opaque!r} in its place, or build with --opaque-from {first.opacity:g}"
    )


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
        vertex = int(statements.corners[at_corner[0]])
        line = int(np.flatnonzero(text.is_statement("v "))[vertex])
        wrong = next((word for word in text.value_words(line)[:3] if not is_number(word)), None)
        if wrong is not None:
            raise not_a_number(text.path, wrong, text.place(line))
        raise AssetError(
            text.path,
            f"vertex {vertex + 1} of a face has a coordinate that is not a number below {FARTHEST:g}",
            place=text.place(int(statements.face_lines[face])),
            fix="export it again",
        )
    log.add("unused-vertex", "unused vertices with a coordinate that is not a number were ignored", int(broken.sum()))
