"""OBJ statements to a scene: objects, materials, triangles."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.frames import scene_transform
from voxrt.voxelize.material_table import MaterialTable
from voxrt.voxelize.notes import Notes
from voxrt.voxelize.obj.mtl import MtlMaterial, find_companion, read_mtl
from voxrt.voxelize.obj.objects import split_objects
from voxrt.voxelize.obj.statements import Statements, read_statements
from voxrt.voxelize.obj.text import Text, read_text
from voxrt.voxelize.polygons import triangulate
from voxrt.voxelize.scene import DEFAULT_COLOUR, Scene, SceneObject

if TYPE_CHECKING:
    from numpy.typing import NDArray

OPAQUE_FROM = 0.5
"""A material of lower opacity is air."""


def load_obj(path: str | Path, *, up: str | None = None, unit: float | None = None) -> Scene:
    """Read a Wavefront OBJ file and its material libraries.

    ``o`` statements make the objects; in a file without them ``g`` statements do, except that groups which share
    vertices are patches of one surface and stay one object. ``Kd`` is taken as sRGB, as most programs show it
    (the format does not say). A material less opaque than :data:`OPAQUE_FROM` is air. Names of materials survive
    a missing library.

    Parameters
    ----------
    path
        The file. Material libraries are looked for in its folder and below.
    up
        The file's up axis; None means y.
    unit
        Metres per unit of the file; None means 1.

    Returns
    -------
    Scene
        Objects and materials in order of first use.

    Raises
    ------
    AssetError
        The file cannot be read, or a face cannot be honoured.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    notes = Notes()
    text = read_text(path)
    said = read_statements(text, notes)
    notes.add("vertex-colours", "vertex colours are not honoured; materials are", said.coloured)
    _refuse_unreadable_positions(text, said, notes)
    triangles, faces = triangulate(said.positions, said.counts, said.corners)
    table = MaterialTable()
    material_of_face = _materials(text, said, table, notes)
    materials = material_of_face[faces]
    solid = materials != 0
    if not solid.all():
        triangles, faces, materials = triangles[solid], faces[solid], materials[solid]
    if not len(triangles):
        raise AssetError(path, "has no faces that can be seen", fix="make its materials opaque or export its polygons")
    transform = scene_transform(up, unit)
    objects = tuple(
        SceneObject(name, mesh, transform) for name, mesh in split_objects(path.stem, said, triangles, faces, materials)
    )
    return Scene(path.stem, objects, table.materials(), notes.warnings())


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


def _materials(text: Text, said: Statements, table: MaterialTable, notes: Notes) -> NDArray[np.uint8]:
    """Material ids, a face each; 0 where the material lets light through."""
    library = _libraries(text, said, notes)
    lines = np.array([line for line, _ in said.materials], dtype=np.int64)
    turn = np.searchsorted(lines, said.face_lines) - 1  # which usemtl each face is under; -1 before the first
    ids = np.zeros(len(said.materials) + 1, dtype=np.uint8)
    turns, faces = np.unique(turn, return_counts=True)
    for index, count in zip(turns.tolist(), faces.tolist(), strict=True):
        name = said.materials[index][1] if index >= 0 else ""
        ids[index] = _material_id(name, library, table, notes, count)
    return ids[turn]


def _material_id(name: str, library: dict[str, MtlMaterial], table: MaterialTable, notes: Notes, faces: int) -> int:
    if not name:
        return table.default(notes, faces)
    if name not in library:
        notes.add("missing-material", "materials that no library describes got the default colour", faces)
        return table.id_of(name, name, DEFAULT_COLOUR)
    material = library[name]
    if material.opacity < OPAQUE_FROM:
        notes.add("transparent", f"faces of materials less opaque than {OPAQUE_FROM} were taken as air", faces)
        return 0
    if material.texture is not None:
        notes.add("texture", "textures are not honoured; the material's own colour stands in", faces)
    if material.colour is None:
        notes.add("material-colour", "materials without Kd got the default colour", faces)
        return table.id_of(name, name, DEFAULT_COLOUR)
    red, green, blue = (round(255 * min(max(value, 0.0), 1.0)) for value in material.colour)
    return table.id_of(name, name, (red, green, blue))


def _libraries(text: Text, said: Statements, notes: Notes) -> dict[str, MtlMaterial]:
    """Return the materials of all libraries by name; the library named last wins, as if read in order."""
    library: dict[str, MtlMaterial] = {}
    seen: set[Path] = set()
    for _, argument in said.libraries:
        # One name may hold blanks, or several names may stand in one line.
        whole = find_companion(text.path.parent, argument)
        for found, name in (
            [(whole, argument)]
            if whole
            else [(find_companion(text.path.parent, word), word) for word in argument.split()]
        ):
            if found is None:
                notes.add("missing-library", f"material library {name!r} is not beside the file")
            elif found not in seen:
                seen.add(found)
                library |= read_mtl(found, notes)
    return library
