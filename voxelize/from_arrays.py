"""Arrays of vertices and faces to a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.arguments import real_array, text, whole_array
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.materials import DEFAULT_COLOUR
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from voxrt.voxelize.assets import UpAxis

_MOST = (1 << 31) - 1


def mesh_scene(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    colours: ArrayLike | None = None,
    face_colours: ArrayLike | None = None,
    name: str = "mesh",
    up: UpAxis | None = None,
    unit: float | None = None,
) -> Scene:
    """Make a scene of one mesh.

    Parameters
    ----------
    vertices
        Real numbers, shape (V, 3), finite.
    faces
        Integers, shape (F, 3): triangles, rows of `vertices`, counter-clockwise seen from outside.
    colours
        Integers 0 … 255, sRGB or sRGB and opacity: one colour (shape (3,) or (4,)) for the whole mesh, or one per
        vertex (shape (V, 3) or (V, 4)), mixed across faces in linear light. Faces of an opacity below a half are left
        out.
    face_colours
        The same, one per face (shape (F, 3) or (F, 4)).
    name
        The name of the scene, which names its files.
    up
        The up axis of the vertices. The default is y.
    unit
        Metres per unit of the vertices. The default is 1.

    Returns
    -------
    Scene
        One object. Without colours its material is the default one, a light grey.

    Raises
    ------
    TypeError, ValueError
        An array of another type or shape, a face that names no vertex, a colour out of range, or both kinds of colours.

    Examples
    --------
    >>> import voxrt
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> scene = voxrt.mesh_scene(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], colours=(255, 0, 0))
    >>> scene.materials[1]
    Material(name='mesh', colour=(255, 0, 0), mirror=False, authored=True)
    """
    positions = real_array("vertices", vertices, ("V", 3))
    triangles = triangles_of("faces", faces, len(positions))
    transform = scene_transform(up, unit)
    table, log = MaterialTable(), WarningLog()
    appearance = _surface_appearance(text("name", name), positions, triangles, colours, face_colours)
    materials = np.zeros(len(triangles), np.uint8)
    if appearance is None:
        materials[:] = table.id_of(name, "default", DEFAULT_COLOUR, authored=False)
    (mesh,) = assign_materials([LoadedMesh(positions, triangles, materials, appearance)], table, log)
    return Scene(name, (SceneObject(name, mesh, transform),), table.materials(), log.warnings())


def triangles_of(name: str, faces: ArrayLike, vertices: int) -> NDArray[np.int32]:
    """Return faces as int32, shape (F, 3); ValueError where one names none of so many vertices."""
    found = whole_array(name, faces, ("F", 3), np.int32, low=0, high=_MOST)
    if len(found) and int(found.max()) >= vertices:
        row = int(np.argmax(found.max(axis=1)))
        raise ValueError(f"{name}[{row}] names vertex {int(found[row].max())}, and there are {vertices} vertices")
    return found


def appearance_of_corners(name: str, corners: NDArray[np.uint8], opaque_from: float = OPAQUE_FROM) -> SurfaceAppearance:
    """Return the appearance of triangles whose corners have colours: uint8, shape (F, 3, 4), sRGB and opacity."""
    linear = LINEAR_OF_SRGB8.astype(np.float32)[corners]
    linear[:, :, 3] = corners[:, :, 3] / np.float32(255)
    cutoff = opaque_from if (corners[:, :, 3] < 255).any() else 0.0
    rows = np.zeros(len(corners), np.int32)
    return SurfaceAppearance((Appearance(name, cutoff=cutoff),), rows, np.zeros((len(corners), 3, 2)), linear)


def _surface_appearance(
    name: str,
    positions: NDArray[np.floating],
    triangles: NDArray[np.int32],
    colours: ArrayLike | None,
    face_colours: ArrayLike | None,
) -> SurfaceAppearance | None:
    if colours is not None and face_colours is not None:
        raise ValueError("colours and face_colours exclude each other; give one of them")
    if face_colours is not None:
        by_face = _rgba("face_colours", face_colours, len(triangles), "faces")
        return appearance_of_corners("face colours", np.repeat(by_face[:, None], 3, axis=1))
    if colours is None:
        return None
    if np.ndim(colours) == 1:
        alike = _rgba("colours", np.asarray(colours)[None], 1, "colours")
        return appearance_of_corners(name, np.broadcast_to(alike[0], (len(triangles), 3, 4)))
    by_vertex = _rgba("colours", colours, len(positions), "vertices (face_colours are per face)")
    return appearance_of_corners("vertex colours", by_vertex[triangles])


def _rgba(name: str, colours: ArrayLike, count: int, what: str) -> NDArray[np.uint8]:
    """Return colours as uint8, shape (N, 4), opaque where they do not say."""
    rows = np.asarray(colours)
    if rows.dtype.kind == "f":  # 1.0 may mean the darkest or the brightest
        raise TypeError(f"{name} must be integers 0 … 255, not floats: multiply by 255 and round")
    channels = rows.shape[-1] if rows.ndim == 2 and rows.shape[-1] == 4 else 3
    found = whole_array(name, rows, ("N", channels), np.uint8, low=0, high=255)
    if len(found) != count:
        raise ValueError(f"{name} has {len(found)} rows, and there are {count} {what}")
    return found if channels == 4 else np.column_stack([found, np.full(count, 255, np.uint8)])
