"""The contents of visible nodes: meshes with pose, appearance and placement, and colliders."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize.formats.gltf.appearance import AppearanceKey
from voxrt.voxelize.formats.gltf.deform import Pose, joint_matrices
from voxrt.voxelize.formats.gltf.extras import node_extras
from voxrt.voxelize.formats.gltf.materials import NO_MATERIAL, MaterialKey, material_names
from voxrt.voxelize.formats.gltf.meshes import read_surface
from voxrt.voxelize.formats.gltf.nodes import read_instances
from voxrt.voxelize.formats.gltf.physics import physics_collider, read_shapes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.collider_shapes import Collider, ColliderKind
    from voxrt.voxelize.formats.authored_properties import ObjectProperties
    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.meshes import Surface
    from voxrt.voxelize.formats.gltf.nodes import Hierarchy
    from voxrt.voxelize.rules import ObjectFill, Rule


class PoseKey(Struct, frozen=True):
    """A pose of a mesh: its morph weights, and the node whose skin deforms it."""

    mesh: int
    weights: tuple[float, ...] = ()
    skinned_by: int | None = None


class NodeContent(Struct, frozen=True, eq=False):
    """What a node adds to the scene: a mesh, or a collider without a mesh."""

    node: int  # the node's index in the file
    mesh: tuple[PoseKey, AppearanceKey] | None  # the mesh with its pose and appearance, or None
    material: MaterialKey  # the material of a collider without a mesh
    collider_kind: ColliderKind | None  # the kind of collider that its author wants around the mesh, or None
    collider: Collider | None  # the node's own collider, in its frame, or None
    transforms: NDArray[np.float64]  # float64, shape (N, 4, 4): to the scene frame, one per instance
    rule: Rule | None = None  # which voxels it fills, or None for what the build says
    fill: ObjectFill | None = None  # whether what it encloses is filled, or None for what the build says


class VisibleNodes:
    """The visible nodes of a file, and its meshes, each read once per pose.

    `variant` is the index of the material variant to show, or None.
    """

    def __init__(self, document: Document, hierarchy: Hierarchy, variant: int | None) -> None:
        self._document = document
        self._hierarchy = hierarchy
        self._variant = variant
        self._surfaces: dict[PoseKey, Surface] = {}
        self._shapes = read_shapes(document)
        self._named: dict[str, int] | None = None

    def contents(self) -> Iterator[NodeContent]:
        """Go through what the scene shows, in extras order; meshes without triangles are left out."""
        for node in self._hierarchy.shown:
            extras = node_extras(self._document, node)
            if extras.voxrt_ignore:
                self._document.log.add("ignored", "objects with voxrt_ignore were left out")
                continue
            override = self._override(node, extras)
            material = MaterialKey(NO_MATERIAL if override is None else override, bool(extras.voxrt_reflect))
            collider = physics_collider(self._document, node, self._shapes, self._mesh_as_authored)
            frame = self._hierarchy.transforms[node]
            mesh = self._mesh(node, override, extras)
            if mesh is not None:
                # A skin moves its mesh to the scene frame. It does not move the node's collider.
                skinned = mesh[0].skinned_by is not None
                placed = self._placed(node, np.eye(4) if skinned else frame)
                own = None if skinned else collider
                how = (extras.voxrt_rule, extras.voxrt_fill)
                yield NodeContent(node, mesh, material, extras.voxrt_collider, own, placed, *how)
                if not skinned:
                    continue
            else:
                for key in ("voxrt_collider", "voxrt_rule", "voxrt_fill"):
                    if getattr(extras, key) is not None:
                        problem, fix = "the node shows no triangles", "put it on the node with the mesh"
                        raise self._document.error(f"nodes[{node}].extras.{key}", problem, fix)
            if collider is not None:
                if override is None:
                    message = "colliders without a mesh or a material got the default one"
                    self._document.log.add("default-material", message)
                yield NodeContent(node, None, material, None, collider, frame[None])

    def surface(self, pose_key: PoseKey) -> Surface:
        """Return the triangles of a mesh in a pose."""
        if pose_key not in self._surfaces:
            self._surfaces[pose_key] = read_surface(self._document, pose_key.mesh, self._pose(pose_key))
        return self._surfaces[pose_key]

    def names(self, contents: list[NodeContent]) -> list[str]:
        """Return a name for each content: its node's, else its mesh's; repeated names get the node's index."""
        nodes, meshes = self._document.gltf.nodes, self._document.gltf.meshes
        plain = []
        for content in contents:
            node = nodes[content.node]
            name = node.name or (meshes[node.mesh].name if node.mesh is not None else "") or f"nodes[{content.node}]"
            plain.append(f"{name} collider" if node.mesh is not None and content.mesh is None else name)
        repeats = Counter(plain)
        return [
            name if repeats[name] == 1 else f"{name} (nodes[{content.node}])"
            for name, content in zip(plain, contents, strict=True)
        ]

    def _mesh(self, index: int, override: int | None, extras: ObjectProperties) -> tuple[PoseKey, AppearanceKey] | None:
        node = self._document.gltf.nodes[index]
        if node.mesh is None:
            return None
        mesh = self._document.item(self._document.gltf.meshes, node.mesh, f"nodes[{index}].mesh", "mesh")
        weights = tuple(node.weights or mesh.weights)
        pose_key = PoseKey(node.mesh, weights if any(weights) else (), index if node.skin is not None else None)
        if not len(self.surface(pose_key).triangles):
            return None
        return pose_key, AppearanceKey(node.mesh, override, bool(extras.voxrt_reflect), self._variant)

    def _override(self, index: int, extras: ObjectProperties) -> int | None:
        wanted = extras.voxrt_material
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

    def _pose(self, pose_key: PoseKey) -> Pose:
        if pose_key.skinned_by is None:
            return Pose(pose_key.weights)
        skin = self._document.gltf.nodes[pose_key.skinned_by].skin
        assert skin is not None
        place = f"nodes[{pose_key.skinned_by}].skin"
        return Pose(pose_key.weights, joint_matrices(self._document, skin, self._hierarchy.transforms, place))

    def _mesh_as_authored(self, index: int, place: str) -> Surface:
        mesh = self._document.item(self._document.gltf.meshes, index, place, "mesh")
        return self.surface(PoseKey(index, tuple(mesh.weights) if any(mesh.weights) else ()))
