"""The way from a glTF file to a scene: place the nodes, dress the meshes they show, number the materials."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.material_table import MaterialTable
from voxrt.voxelize.colour.painted import Unfinished, finish
from voxrt.voxelize.formats.gltf.animation import posed
from voxrt.voxelize.formats.gltf.appearance import dress, find_variant
from voxrt.voxelize.formats.gltf.colliders import collider_around, collider_points
from voxrt.voxelize.formats.gltf.document import Document
from voxrt.voxelize.formats.gltf.extensions import check_required
from voxrt.voxelize.formats.gltf.extras import refuse_misplaced
from voxrt.voxelize.formats.gltf.materials import number_materials
from voxrt.voxelize.formats.gltf.nodes import place_nodes
from voxrt.voxelize.formats.gltf.shown import Stage
from voxrt.voxelize.formats.gltf.textures import Textures
from voxrt.voxelize.formats.gltf.unused import refuse_broken_parts
from voxrt.voxelize.scene import Mesh, Scene, SceneObject

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from voxrt.voxelize.formats.gltf.appearance import Dress, Look
    from voxrt.voxelize.formats.gltf.materials import MaterialKey
    from voxrt.voxelize.formats.gltf.meshes import Surface
    from voxrt.voxelize.formats.gltf.shown import Bend, Shown

_NO_TRIANGLES = Mesh(np.empty((0, 3)), np.empty((0, 3), np.int32), np.empty(0, np.uint8))


def load_gltf(
    path: Path,
    *,
    time: float | None = None,
    animation: str | None = None,
    variants: tuple[str, ...] = (),
    allow_outside: bool = False,
) -> Scene:
    """Read a ``.gltf`` or ``.glb`` file.

    Parameters
    ----------
    path
        The file.
    time
        The second of an animation at which the file is shown; None for the pose in which the file stands.
    animation
        The name of that animation, or its number counted from 0; None for the first.
    variants
        The name of the material variant to show; none for the materials that its primitives name first.
    allow_outside
        Whether buffers and images may stand outside the file's folder.

    Raises
    ------
    AssetError
        The file is malformed, needs an extension that is not known here, refers to what is not there, asks for more
        memory than a file of its size may use, or has no triangles.
    DoesNotFitError
        More than 255 materials are used.
    """
    document = Document(path, allow_outside=allow_outside)
    check_required(document)
    refuse_misplaced(document)
    document.gltf = posed(document, time, animation)
    stage = Stage(document, place_nodes(document), find_variant(document, variants))
    shown = list(stage.shown())
    textures = Textures(document)
    worn = list(dict.fromkeys(seen.mesh for seen in shown if seen.mesh is not None))
    dressed = [dress(document, textures, stage.surface(bend), look) for bend, look in worn]
    bare = {seen.material for seen in shown if seen.mesh is None}
    table = MaterialTable()
    used = {key for wears in dressed for _, _, key in wears.runs}
    ids = number_materials(document, table, bare | used)
    unfinished = [_unfinished(stage.surface(bend), wears, ids) for (bend, _), wears in zip(worn, dressed, strict=True)]
    meshes = dict(zip(worn, finish(unfinished, table, document.notes), strict=True))
    objects = tuple(
        thing
        for name, seen in zip(stage.names(shown), shown, strict=True)
        for thing in _objects(document, name, seen, meshes, ids)
    )
    if not objects:
        refuse_broken_parts(document)
        said = "; ".join(one.message for one in document.notes.warnings())
        problem = "has no triangles to voxelize" + (f" ({said})" if said else "")
        raise document.error("", problem, "check that the scene shows a mesh")
    return Scene(path.stem, objects, table.materials(), document.notes.warnings())


def _unfinished(surface: Surface, wears: Dress, ids: Mapping[MaterialKey, int]) -> Unfinished:
    materials = np.zeros(len(surface.triangles), np.uint8)
    for start, stop, key in wears.runs:
        materials[start:stop] = ids[key]
    return Unfinished(surface.positions, surface.triangles, materials, wears.coat)


def _objects(
    document: Document,
    name: str,
    seen: Shown,
    meshes: Mapping[tuple[Bend, Look], Mesh],
    ids: Mapping[MaterialKey, int],
) -> Iterator[SceneObject]:
    """Make the objects of what is shown, one an instance; none where it is all air."""
    if seen.mesh is None:
        mesh, material = _NO_TRIANGLES, ids[seen.material]
    else:
        mesh = meshes[seen.mesh]
        if not len(mesh.triangles):
            return
        material = int(mesh.materials[0])
    collider = collider_around(mesh, seen.around) if seen.around is not None else seen.collider
    colliders = () if collider is None else (collider,)
    if colliders and (mesh.materials != material).any():
        document.notes.add("collider-material", "colliders of objects with several materials took the first of them")
    clouds = (mesh.positions, *map(collider_points, colliders))
    farthest = max(float(max(-points.min(), points.max())) for points in clouds if len(points))
    with np.errstate(over="ignore", invalid="ignore"):
        reach = np.abs(seen.transforms[:, :3, :3]).sum(axis=2) * farthest + np.abs(seen.transforms[:, :3, 3])
    if not np.isfinite(reach).all():
        raise document.error(f"nodes[{seen.node}]", "the transform leaves the range of numbers")
    for at, transform in enumerate(seen.transforms):
        own = name if len(seen.transforms) == 1 else f"{name} [{at}]"
        yield SceneObject(own, mesh, transform, colliders, material)
