"""The way from a glTF file to a scene: place the nodes, read each mesh once a pose, dress it, number the materials."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.gltf.animation import posed
from voxrt.voxelize.gltf.appearance import Look, dress, find_variant
from voxrt.voxelize.gltf.colliders import collider_around
from voxrt.voxelize.gltf.deform import Pose
from voxrt.voxelize.gltf.document import Document
from voxrt.voxelize.gltf.extensions import check_required
from voxrt.voxelize.gltf.extras import NodeExtras, node_extras
from voxrt.voxelize.gltf.instances import read_instances
from voxrt.voxelize.gltf.materials import material_named
from voxrt.voxelize.gltf.meshes import Surface, read_surface
from voxrt.voxelize.gltf.nodes import place_nodes
from voxrt.voxelize.gltf.skins import joint_matrices
from voxrt.voxelize.gltf.table import finish_meshes
from voxrt.voxelize.gltf.textures import Textures
from voxrt.voxelize.scene import Mesh, Scene, SceneObject

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.gltf.nodes import Hierarchy


@dataclass(frozen=True, slots=True)
class _Bend:
    """What tells the poses of a mesh apart: its morph weights, and the node whose skin carries it."""

    mesh: int
    weights: tuple[float, ...]
    skinned_by: int | None


@dataclass(frozen=True, eq=False, slots=True)
class _Shown:
    """A node that shows a mesh: how, and with which transforms, one an instance."""

    node: int
    bend: _Bend
    look: Look
    authored: NodeExtras
    transforms: NDArray[np.float64]


def load_gltf(path: Path, *, time: float | None = None, variants: tuple[str, ...] = ()) -> Scene:
    """Read a ``.gltf`` or ``.glb`` file.

    Parameters
    ----------
    path
        The file.
    time
        The second of the file's first animation at which it is shown; None for the pose in which the file stands.
    variants
        The name of the material variant to show; none for the materials that its primitives name first.

    Raises
    ------
    AssetError
        The file is malformed, needs an extension that is not known here, refers to what is not there, asks for more
        memory than a file of its size may use, or has no triangles.
    DoesNotFitError
        More than 255 materials are used.
    """
    document = Document(path)
    check_required(document)
    document.gltf = posed(document, time)
    hierarchy = place_nodes(document)
    number = find_variant(document, variants)
    surfaces: dict[_Bend, Surface] = {}
    shown: list[_Shown] = []
    for node in hierarchy.shown:
        seen = _look_at(document, hierarchy, node, number)
        if seen is None:
            continue
        if seen.bend not in surfaces:
            pose = _pose(document, hierarchy, seen.bend)
            surfaces[seen.bend] = read_surface(document, seen.bend.mesh, pose)
        if len(surfaces[seen.bend].triangles):
            shown.append(seen)
    textures = Textures(document)
    worn = dict.fromkeys((seen.bend, seen.look) for seen in shown)
    dressed = [(surfaces[bend], dress(document, textures, surfaces[bend], look)) for bend, look in worn]
    made, materials = finish_meshes(document, dressed)
    meshes = dict(zip(worn, made, strict=True))
    objects = _objects(document, shown, meshes)
    if not objects:
        raise document.error("", "has no triangles to voxelize", "check that the scene shows a mesh")
    return Scene(path.stem, objects, materials, document.warnings)


def _look_at(document: Document, hierarchy: Hierarchy, index: int, variant: int | None) -> _Shown | None:
    """Return how node `index` shows its mesh, or None where it has none."""
    node = document.gltf.nodes[index]
    authored = node_extras(document, index)
    if node.mesh is None:
        if authored.voxrt_collider is not None:
            place = f"nodes[{index}].extras.voxrt_collider"
            raise document.error(place, "the node has no mesh", "put the property on the node with the mesh")
        return None
    mesh = document.item(document.gltf.meshes, node.mesh, f"nodes[{index}].mesh", "mesh")
    override = None
    if authored.voxrt_material is not None:
        place = f"nodes[{index}].extras.voxrt_material"
        override = material_named(document, authored.voxrt_material, place)
    weights = tuple(node.weights or mesh.weights)
    bend = _Bend(node.mesh, weights if any(weights) else (), index if node.skin is not None else None)
    look = Look(node.mesh, override, bool(authored.voxrt_reflect), variant)
    # A skin carries its mesh to the scene frame by itself.
    frame = np.eye(4) if bend.skinned_by is not None else hierarchy.transforms[index]
    instances = read_instances(document, index)
    with np.errstate(over="ignore", invalid="ignore"):
        transforms = frame[None] if instances is None else frame @ instances
    return _Shown(index, bend, look, authored, transforms)


def _pose(document: Document, hierarchy: Hierarchy, bend: _Bend) -> Pose:
    if bend.skinned_by is None:
        return Pose(bend.weights)
    skin = document.gltf.nodes[bend.skinned_by].skin
    assert skin is not None
    return Pose(bend.weights, joint_matrices(document, skin, hierarchy.transforms, f"nodes[{bend.skinned_by}].skin"))


def _objects(
    document: Document, shown: list[_Shown], meshes: dict[tuple[_Bend, Look], Mesh]
) -> tuple[SceneObject, ...]:
    """Return the objects of the scene, one an instance; those whose mesh is all air are left out."""
    objects = []
    names = _names(document, shown)
    for name, seen in zip(names, shown, strict=True):
        mesh = meshes[seen.bend, seen.look]
        if not len(mesh.triangles):
            continue
        _check_range(document, seen, mesh)
        kind = seen.authored.voxrt_collider
        colliders = (collider_around(mesh, kind),) if kind else ()
        for at, transform in enumerate(seen.transforms):
            own = name if len(seen.transforms) == 1 else f"{name} [{at}]"
            objects.append(SceneObject(own, mesh, transform, colliders, int(mesh.materials[0])))
    return tuple(objects)


def _names(document: Document, shown: list[_Shown]) -> list[str]:
    """Name objects after their nodes, else their meshes; where a name repeats, say which node is meant."""
    nodes, meshes = document.gltf.nodes, document.gltf.meshes
    plain = [nodes[seen.node].name or meshes[seen.look.mesh].name or f"nodes[{seen.node}]" for seen in shown]
    repeats = Counter(plain)
    return [
        name if repeats[name] == 1 else f"{name} (nodes[{seen.node}])" for name, seen in zip(plain, shown, strict=True)
    ]


def _check_range(document: Document, seen: _Shown, mesh: Mesh) -> None:
    """Refuse transforms that take the mesh out of the range of numbers."""
    with np.errstate(over="ignore", invalid="ignore"):
        reach = np.abs(seen.transforms[:, :3, :3]) @ np.abs(mesh.positions).max(axis=0)
        reach += np.abs(seen.transforms[:, :3, 3])
    if not np.isfinite(reach).all():
        raise document.error(f"nodes[{seen.node}]", "the transform leaves the range of numbers")
