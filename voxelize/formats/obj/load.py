"""OBJ statements to a scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.material_table import MaterialTable
from voxrt.voxelize.colour.painted import Unfinished, finish
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.companions import Companions
from voxrt.voxelize.formats.obj.appearance import coat_of, look_at_faces
from voxrt.voxelize.formats.obj.objects import compact, split_objects
from voxrt.voxelize.formats.obj.statements import Statements, read_statements, texture_coordinates
from voxrt.voxelize.formats.obj.text import Text, read_text
from voxrt.voxelize.frames import scene_transform
from voxrt.voxelize.notes import Notes
from voxrt.voxelize.polygons import triangulate_corners
from voxrt.voxelize.scene import Scene, SceneObject

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


def load_obj(
    path: str | Path, *, up: str | None = None, unit: float | None = None, allow_outside: bool = False
) -> Scene:
    """Read a Wavefront OBJ file, its material libraries and textures.

    ``o`` statements make the objects; in a file without them ``g`` statements do, except that groups which share
    vertices are patches of one surface and stay one object. ``Kd`` and vertex colours are taken as sRGB, as most
    programs show them (the format does not say). A texture takes the place of ``Kd``, vertex colours are multiplied
    with it. A material of an opacity below a half is air. Names of materials survive a missing library.

    Parameters
    ----------
    path
        The file. Material libraries and textures are looked for in its folder and below.
    up
        The file's up axis; None means y.
    unit
        Metres per unit of the file; None means 1.
    allow_outside
        Whether material libraries and textures may stand outside the file's folder.

    Returns
    -------
    Scene
        Objects and materials in order of first use; the palette of painted surfaces after them.

    Raises
    ------
    AssetError
        The file or an image is broken, or a face cannot be honoured.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    notes = Notes()
    text = read_text(path)
    said = read_statements(text, notes)
    _refuse_unreadable_positions(text, said, notes)
    table = MaterialTable()
    companions = Companions.of(path, allow_outside=allow_outside)
    seen = look_at_faces(text, said, companions, table, notes)
    uv = None
    if any(layout is not None for layout in seen.layouts):
        uv, given = texture_coordinates(text, said)
        notes.add(
            "texture",
            "textured faces without texture coordinates took the texture's corner",
            int((~given & (seen.rows >= 0) & _textured(seen.rows, seen.layouts)).sum()),
        )
    corners, faces = triangulate_corners(said.positions, said.counts, said.corners)
    shown = (seen.materials[faces] != 0) | (seen.rows[faces] >= 0)
    if not shown.all():
        corners, faces = corners[shown], faces[shown]
    if not len(faces):
        raise AssetError(path, "has no faces that can be seen", fix="make its materials opaque or export its polygons")
    triangles = said.corners[corners].astype(np.int32)
    parts = list(split_objects(path.stem, said, triangles, faces))
    unfinished = [
        Unfinished(
            *compact(said.positions, triangles[chosen]),
            seen.materials[faces[chosen]],
            coat_of(said, seen, uv, corners[chosen], faces[chosen]),
        )
        for _, chosen in parts
    ]
    transform = scene_transform(up, unit)
    objects = tuple(
        SceneObject(name, mesh, transform)
        for (name, _), mesh in zip(parts, finish(unfinished, table, notes), strict=True)
        if len(mesh.triangles)
    )
    if not objects:
        raise AssetError(path, "has no faces that can be seen", fix="make its textures opaque")
    return Scene(path.stem, objects, table.materials(), notes.warnings())


def _textured(rows: NDArray[np.int32], layouts: Sequence[object]) -> NDArray[np.bool_]:
    """Whether each face's paint is a texture."""
    by_row = np.array([layout is not None for layout in layouts], dtype=np.bool_)
    return by_row[rows]


def _refuse_unreadable_positions(text: Text, said: Statements, notes: Notes) -> None:
    broken: NDArray[np.bool_] = np.logical_not(np.isfinite(said.positions).all(axis=1))
    if not broken.any():
        return
    at_corner = np.flatnonzero(broken[said.corners])
    if len(at_corner):
        face = int(np.searchsorted(np.cumsum(said.counts), at_corner[0], side="right"))
        raise AssetError(
            text.path,
            f"vertex {said.corners[at_corner[0]] + 1} of a face has a coordinate that is no number",
            place=text.place(int(said.face_lines[face])),
            fix="export it again",
        )
    notes.add("unused-vertex", "vertices with a coordinate that is no number are in no face", int(broken.sum()))
