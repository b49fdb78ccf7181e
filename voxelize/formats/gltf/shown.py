"""What the nodes of the scene show: which mesh in which pose and look, where, and what collides in its place."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.formats.gltf.appearance import Look
from voxrt.voxelize.formats.gltf.deform import Pose
from voxrt.voxelize.formats.gltf.extras import node_extras
from voxrt.voxelize.formats.gltf.instances import read_instances
from voxrt.voxelize.formats.gltf.materials import NO_MATERIAL, MaterialKey, material_names
from voxrt.voxelize.formats.gltf.meshes import read_surface
from voxrt.voxelize.formats.gltf.physics import physics_collider, read_shapes
from voxrt.voxelize.formats.gltf.skins import joint_matrices

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.extras import ColliderKind, NodeExtras
    from voxrt.voxelize.formats.gltf.meshes import Surface
    from voxrt.voxelize.formats.gltf.nodes import Hierarchy
    from voxrt.voxelize.scene import Collider


@dataclass(frozen=True, slots=True)
class Bend:
    """What tells the poses of a mesh apart: its morph weights, and the node whose skin carries it."""

    mesh: int
    weights: tuple[float, ...] = ()
    skinned_by: int | None = None


@dataclass(frozen=True, eq=False, slots=True)
class Shown:
    """A mesh that a node shows, or a collider without mesh.

    Attributes
    ----------
    node
        The node's index in the file.
    mesh
        The mesh in its pose and look, or None.
    material
        What a collider without mesh is filled with.
    around
        The kind of collider that its author wants around the mesh, or None.
    collider
        The collider that the node has of its own, in its frame, or None.
    transforms
        float64, shape (N, 4, 4): to the scene frame, one an instance.
    """

    node: int
    mesh: tuple[Bend, Look] | None
    material: MaterialKey
    around: ColliderKind | None
    collider: Collider | None
    transforms: NDArray[np.float64]


class Stage:
    """The nodes of a placed file, and its meshes, each read once a pose.

    Parameters
    ----------
    document
        The open asset.
    hierarchy
        Where its nodes stand.
    variant
        The material variant to show, or None.
    """

    def __init__(self, document: Document, hierarchy: Hierarchy, variant: int | None) -> None:
        self._document = document
        self._hierarchy = hierarchy
        self._variant = variant
        self._surfaces: dict[Bend, Surface] = {}
        self._shapes = read_shapes(document)
        self._named: dict[str, int] | None = None

    def shown(self) -> Iterator[Shown]:
        """Go through what the scene shows, in authored order; meshes without triangles are left out."""
        for node in self._hierarchy.shown:
            authored = node_extras(self._document, node)
            override = self._override(node, authored)
            material = MaterialKey(NO_MATERIAL if override is None else override, bool(authored.voxrt_reflect))
            collider = physics_collider(self._document, node, self._shapes, self._mesh_as_authored)
            frame = self._hierarchy.transforms[node]
            mesh = self._mesh(node, override, authored)
            if mesh is not None:
                # A skin carries its mesh to the scene frame by itself, and leaves the node's collider behind.
                skinned = mesh[0].skinned_by is not None
                placed = self._placed(node, np.eye(4) if skinned else frame)
                yield Shown(node, mesh, material, authored.voxrt_collider, None if skinned else collider, placed)
                if not skinned:
                    continue
            elif authored.voxrt_collider is not None:
                place = f"nodes[{node}].extras.voxrt_collider"
                raise self._document.error(place, "the node shows no triangles", "put it on the node with the mesh")
            if collider is not None:
                if override is None:
                    message = "colliders without a mesh or a material got the default one"
                    self._document.notes.add("default-material", message)
                yield Shown(node, None, material, None, collider, frame[None])

    def surface(self, bend: Bend) -> Surface:
        """Return the triangles of a mesh in a pose."""
        if bend not in self._surfaces:
            self._surfaces[bend] = read_surface(self._document, bend.mesh, self._pose(bend))
        return self._surfaces[bend]

    def names(self, shown: list[Shown]) -> list[str]:
        """Name what is shown after its node, else its mesh; where a name repeats, say which node is meant."""
        nodes, meshes = self._document.gltf.nodes, self._document.gltf.meshes
        plain = []
        for seen in shown:
            node = nodes[seen.node]
            name = node.name or (meshes[node.mesh].name if node.mesh is not None else "") or f"nodes[{seen.node}]"
            plain.append(f"{name} collider" if node.mesh is not None and seen.mesh is None else name)
        repeats = Counter(plain)
        return [
            name if repeats[name] == 1 else f"{name} (nodes[{seen.node}])"
            for name, seen in zip(plain, shown, strict=True)
        ]

    def _mesh(self, index: int, override: int | None, authored: NodeExtras) -> tuple[Bend, Look] | None:
        node = self._document.gltf.nodes[index]
        if node.mesh is None:
            return None
        mesh = self._document.item(self._document.gltf.meshes, node.mesh, f"nodes[{index}].mesh", "mesh")
        weights = tuple(node.weights or mesh.weights)
        bend = Bend(node.mesh, weights if any(weights) else (), index if node.skin is not None else None)
        if not len(self.surface(bend).triangles):
            return None
        return bend, Look(node.mesh, override, bool(authored.voxrt_reflect), self._variant)

    def _override(self, index: int, authored: NodeExtras) -> int | None:
        wanted = authored.voxrt_material
        if wanted is None:
            return None
        if self._named is None:
            self._named = material_names(self._document)
        if wanted not in self._named:
            known = ", ".join(map(repr, list(self._named)[:8])) or "no named materials"
            place = f"nodes[{index}].extras.voxrt_material"
            raise self._document.error(place, f"no material {wanted!r} in the file", f"it has {known}")
        return self._named[wanted]

    def _placed(self, index: int, frame: NDArray[np.float64]) -> NDArray[np.float64]:
        instances = read_instances(self._document, index)
        if instances is None:
            return frame[None]
        with np.errstate(over="ignore", invalid="ignore"):
            placed: NDArray[np.float64] = frame @ instances
        return placed

    def _pose(self, bend: Bend) -> Pose:
        if bend.skinned_by is None:
            return Pose(bend.weights)
        skin = self._document.gltf.nodes[bend.skinned_by].skin
        assert skin is not None
        place = f"nodes[{bend.skinned_by}].skin"
        return Pose(bend.weights, joint_matrices(self._document, skin, self._hierarchy.transforms, place))

    def _mesh_as_authored(self, index: int, place: str) -> Surface:
        mesh = self._document.item(self._document.gltf.meshes, index, place, "mesh")
        return self.surface(Bend(index, tuple(mesh.weights) if any(mesh.weights) else ()))
