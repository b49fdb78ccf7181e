"""Meshes and scenes of trimesh to ours, with their colours and textures.

trimesh is not imported here: who has one of its values has imported it.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np

from voxrt.voxelize.arguments import real_array
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.from_arrays import appearance_of_corners, triangles_of
from voxrt.voxelize.materials import DEFAULT_COLOUR
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    import trimesh
    from numpy.typing import NDArray

    from voxrt.voxelize.assets import UpAxis

_OPAQUE_WHITE = (1.0, 1.0, 1.0, 1.0)


def is_trimesh(value: object) -> TypeGuard[trimesh.Trimesh | trimesh.Scene]:
    """Tell whether a value is a mesh or a scene of trimesh.

    Examples
    --------
    >>> is_trimesh("house.obj")
    False
    """
    module = sys.modules.get("trimesh")
    return module is not None and isinstance(value, (module.Trimesh, module.Scene))


def trimesh_scene(
    value: trimesh.Trimesh | trimesh.Scene,
    *,
    name: str = "mesh",
    up: UpAxis | None = None,
    unit: float | None = None,
    opaque_from: float = OPAQUE_FROM,
) -> Scene:
    """Make a scene of a mesh or a scene of trimesh: an object per instance, in the order of the graph's nodes.

    Instances of one geometry share its mesh. Vertex colours, face colours, textures with their coordinates, and the
    base colours of materials are honoured. A ``baseColorFactor`` is linear, as in glTF; other colours are sRGB. What a
    scene holds besides triangles is left out, with a warning, and so are faces of an opacity below `opaque_from`.
    `name`, `up` and `unit` are as for :func:`mesh_scene`.

    ValueError for a vertex that is not finite, or a face that names no vertex; DoesNotFitError for more than 255
    materials.

    Examples
    --------
    >>> import trimesh
    >>> ball = trimesh.creation.icosphere()
    >>> ball.visual.face_colors = (200, 30, 30, 255)
    >>> trimesh_scene(ball, name="ball").materials[1].colour
    (200, 30, 30)
    """
    frame = scene_transform(up, unit)
    table, log = MaterialTable(), WarningLog()
    placed = _placed(value, name, log)
    geometries = {key: geometry for key, _, geometry, _ in placed}
    loaded = [_loaded_mesh(key or name, geometry, table, opaque_from) for key, geometry in geometries.items()]
    meshes = dict(zip(geometries, assign_materials(loaded, table, log, opaque_from), strict=True))
    objects = tuple(SceneObject(node, meshes[key], frame @ transform) for key, node, _, transform in placed)
    return Scene(name, objects, table.materials(), log.warnings())


def _placed(
    value: trimesh.Trimesh | trimesh.Scene, name: str, log: WarningLog
) -> list[tuple[str, str, trimesh.Trimesh, NDArray[np.float64]]]:
    """Return the instances: the geometry's key, the node's name, the geometry, where it stands (shape (4, 4))."""
    mesh_type = sys.modules["trimesh"].Trimesh
    if isinstance(value, mesh_type):
        return [("", name, value, np.eye(4))]
    scene: Any = value
    placed = []
    for node in scene.graph.nodes_geometry:
        transform, key = scene.graph[node]
        geometry = scene.geometry[key]
        if not isinstance(geometry, mesh_type):
            log.add("no-triangles", "geometry of trimesh other than triangle meshes was left out")
            continue
        placed.append((str(key), str(node), geometry, real_array("transform", transform, (4, 4)).astype(np.float64)))
    return placed


def _loaded_mesh(name: str, mesh: trimesh.Trimesh, table: MaterialTable, opaque_from: float) -> LoadedMesh:
    positions = real_array("vertices", mesh.vertices, ("V", 3))
    triangles = triangles_of("faces", mesh.faces, len(positions))
    materials = np.zeros(len(triangles), np.uint8)
    appearance = _surface_appearance(name, mesh.visual, triangles, opaque_from)
    if appearance is None:
        materials[:] = table.id_of(None, "default", DEFAULT_COLOUR, authored=False)
    return LoadedMesh(positions, triangles, materials, appearance)


def _surface_appearance(
    name: str,
    visual: Any,  # noqa: ANN401 - has no types
    triangles: NDArray[np.int32],
    opaque_from: float,
) -> SurfaceAppearance | None:
    if visual is None or not len(triangles) or not getattr(visual, "defined", False):
        return None
    if visual.kind == "vertex":
        return appearance_of_corners(
            "vertex colours", np.asarray(visual.vertex_colors, np.uint8)[triangles], opaque_from
        )
    if visual.kind == "face":
        by_face = np.asarray(visual.face_colors, np.uint8)
        kind = name if (by_face == by_face[0]).all() else "face colours"
        return appearance_of_corners(kind, np.repeat(by_face[:, None], 3, axis=1), opaque_from)
    if visual.kind != "texture":
        return None
    several = getattr(visual.material, "materials", None)
    appearances = tuple(_appearance(name, material, opaque_from) for material in (several or [visual.material]))
    rows = np.zeros(len(triangles), np.int32)
    if several and getattr(visual, "face_materials", None) is not None:
        rows = np.asarray(visual.face_materials).astype(np.int32)
    uv = np.zeros((len(triangles), 3, 2))
    if visual.uv is not None:
        uv = np.asarray(visual.uv, np.float64)[:, :2][triangles]
        uv[:, :, 1] = 1.0 - uv[:, :, 1]  # theirs counts from the bottom, a texture's rows from the top
    return SurfaceAppearance(appearances, rows, uv, np.ones((len(triangles), 3, 4), np.float32))


def _appearance(name: str, material: Any, opaque_from: float) -> Appearance:  # noqa: ANN401 - has no types
    name = str(getattr(material, "name", None) or name)
    physical = hasattr(material, "baseColorFactor")
    image = material.baseColorTexture if physical else getattr(material, "image", None)
    texture = None if image is None else Texture(np.array(image.convert("RGBA")))
    factor = _OPAQUE_WHITE
    if physical and material.baseColorFactor is not None:
        red, green, blue, alpha = (np.asarray(material.baseColorFactor, np.float64) / 255).tolist()
        factor = (red, green, blue, alpha)
    elif not physical and image is None:  # as in MTL files, a texture stands in place of the colour
        rgba = np.asarray(material.diffuse, np.uint8)
        red, green, blue = LINEAR_OF_SRGB8[rgba[:3]].tolist()
        factor = (red, green, blue, float(rgba[3] / 255))
    cutoff = 0.0
    if physical and material.alphaMode in {"MASK", "BLEND"}:
        own = material.alphaCutoff if material.alphaMode == "MASK" else None
        cutoff = opaque_from if own is None else float(own)
    elif not physical and factor[3] < 1:
        cutoff = opaque_from
    return Appearance(name, factor, texture, cutoff)
