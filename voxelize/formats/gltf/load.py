"""Loading glTF files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.collider_shapes import bounding_points, collider_around
from voxrt.voxelize.formats.external_files import asset_name
from voxrt.voxelize.formats.gltf.accessors import refuse_broken_parts
from voxrt.voxelize.formats.gltf.animation import posed
from voxrt.voxelize.formats.gltf.appearance import find_variant, read_appearance
from voxrt.voxelize.formats.gltf.cameras import read_cameras
from voxrt.voxelize.formats.gltf.document import Document
from voxrt.voxelize.formats.gltf.extensions import REPLACEMENTS, SUPPORTED, WITHOUT_EFFECT
from voxrt.voxelize.formats.gltf.extras import refuse_misplaced
from voxrt.voxelize.formats.gltf.materials import number_materials
from voxrt.voxelize.formats.gltf.nodes import place_nodes
from voxrt.voxelize.formats.gltf.textures import Textures
from voxrt.voxelize.formats.gltf.visible_nodes import VisibleNodes
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.mesh import NO_TRIANGLES
from voxrt.voxelize.scene import Scene, SceneObject

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from voxrt.voxelize.formats.gltf.appearance import AppearanceKey, SurfaceMaterials
    from voxrt.voxelize.formats.gltf.materials import MaterialKey
    from voxrt.voxelize.formats.gltf.meshes import Surface
    from voxrt.voxelize.formats.gltf.visible_nodes import NodeContent, PoseKey
    from voxrt.voxelize.mesh import Mesh


def load_gltf(
    path: Path,
    *,
    time: float | None = None,
    animation: str | None = None,
    variants: tuple[str, ...] = (),
    allow_outside: bool = False,
    opaque_from: float = OPAQUE_FROM,
) -> Scene:
    """Read a ``.gltf`` or ``.glb`` file.

    Parameters
    ----------
    path
        The file.
    time
        The second of an animation at which the file is contents; None for the pose in which the file stands.
    animation
        The name of that animation, or its number counted from 0; None for the first.
    variants
        The name of the material variant to show; none for the default materials of its primitives.
    allow_outside
        Whether buffers and images may stand outside the file's folder.
    opaque_from
        Blended faces of lower opacity are left out.

    Raises
    ------
    AssetError
        The file is malformed, requires an extension that is not supported, refers to something that does not exist,
        needs more memory than a file of its size may use, or has no triangles.
    DoesNotFitError
        More than 255 materials are used.
    """
    document = Document(path, allow_outside=allow_outside, opaque_from=opaque_from)
    _check_required_extensions(document)
    refuse_misplaced(document)
    document.gltf = posed(document, time, animation)
    hierarchy = place_nodes(document)
    nodes = VisibleNodes(document, hierarchy, find_variant(document, variants))
    contents = list(nodes.contents())
    textures = Textures(document)
    mesh_keys = list(dict.fromkeys(content.mesh for content in contents if content.mesh is not None))
    surfaces = [nodes.surface(pose_key) for pose_key, _ in mesh_keys]
    surface_materials = [
        read_appearance(document, textures, surface, appearance_key)
        for surface, (_, appearance_key) in zip(surfaces, mesh_keys, strict=True)
    ]
    of_colliders = {content.material for content in contents if content.mesh is None}
    table = MaterialTable()
    used = {key for own in surface_materials for _, _, key in own.runs}
    ids = number_materials(document, table, of_colliders | used)
    loaded = [_loaded_mesh(surface, own, ids) for surface, own in zip(surfaces, surface_materials, strict=True)]
    meshes = dict(zip(mesh_keys, assign_materials(loaded, table, document.log, opaque_from), strict=True))
    objects = tuple(
        thing
        for name, content in zip(nodes.names(contents), contents, strict=True)
        for thing in _objects(document, name, content, meshes, ids)
    )
    if not objects:
        refuse_broken_parts(document)
        reasons = "; ".join(one.message for one in document.log.warnings())
        problem = "has no triangles to voxelize" + (f" ({reasons})" if reasons else "")
        raise document.error("", problem, "check that the scene shows a mesh")
    cameras = read_cameras(document, hierarchy)
    viewpoint = cameras[0] if cameras else None
    return Scene(
        asset_name(path), objects, table.materials(), document.log.warnings(), viewpoint=viewpoint, cameras=cameras
    )


def _check_required_extensions(document: Document) -> None:
    """Refuse a file that requires an unsupported extension; count unsupported ones that it only uses."""
    gltf = document.gltf
    known = SUPPORTED | WITHOUT_EFFECT
    for at, name in enumerate(gltf.extensions_required):
        if name not in known:
            fix = REPLACEMENTS.get(name, "export the file without it")
            raise document.error(f"extensionsRequired[{at}]", f"the extension {name[:60]} is not supported", fix)
    for name in dict.fromkeys(gltf.extensions_used):
        if name not in known:
            document.log.add("unknown-extension", f"the extension {name[:60]} was ignored")


def _loaded_mesh(surface: Surface, own: SurfaceMaterials, ids: Mapping[MaterialKey, int]) -> LoadedMesh:
    materials = np.zeros(len(surface.triangles), np.uint8)
    for start, stop, key in own.runs:
        materials[start:stop] = ids[key]
    return LoadedMesh(surface.positions, surface.triangles, materials, own.appearance, surface.normals)


def _objects(
    document: Document,
    name: str,
    content: NodeContent,
    meshes: Mapping[tuple[PoseKey, AppearanceKey], Mesh],
    ids: Mapping[MaterialKey, int],
) -> Iterator[SceneObject]:
    """Make the objects of a node, one per instance; none where its mesh is fully transparent."""
    if content.mesh is None:
        mesh, material = NO_TRIANGLES, ids[content.material]
    else:
        mesh = meshes[content.mesh]
        if not len(mesh.triangles):
            return
        material = int(mesh.materials[0])
    collider = content.collider
    if content.collider_kind is not None:
        try:
            collider = collider_around(content.collider_kind, mesh.positions, mesh.triangles)
        except ValueError as error:  # its size overflows
            raise document.error(f"nodes[{content.node}]", str(error)) from None
    colliders = () if collider is None else (collider,)
    if colliders and (mesh.materials != material).any():
        document.log.add("collider-material", "colliders of objects with several materials took the first of them")
    clouds = (mesh.positions, *map(bounding_points, colliders))
    farthest = max(float(max(-points.min(), points.max())) for points in clouds if len(points))
    with np.errstate(over="ignore", invalid="ignore"):
        reach = np.abs(content.transforms[:, :3, :3]).sum(axis=2) * farthest + np.abs(content.transforms[:, :3, 3])
    if not np.isfinite(reach).all():
        raise document.error(f"nodes[{content.node}]", "the transform overflows")
    for at, transform in enumerate(content.transforms):
        own = name if len(content.transforms) == 1 else f"{name} [{at}]"
        yield SceneObject(own, mesh, transform, colliders, material, rule=content.rule, fill=content.fill)
