"""The way from a glTF file to a scene: place the nodes, read each mesh once, number the materials in use."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.gltf.colliders import collider_around
from voxrt.voxelize.gltf.document import Document
from voxrt.voxelize.gltf.extensions import check_required
from voxrt.voxelize.gltf.extras import NodeExtras, node_extras
from voxrt.voxelize.gltf.materials import NO_MATERIAL, MaterialKey, make_materials, material_named
from voxrt.voxelize.gltf.meshes import Surface, read_surface
from voxrt.voxelize.gltf.nodes import PlacedNode, place_nodes
from voxrt.voxelize.scene import Mesh, Scene, SceneObject

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class _Look:
    """How a node shows a mesh. Nodes with equal looks share one mesh value."""

    mesh: int
    override: int | None
    mirrored: bool

    def key(self, material: int) -> MaterialKey:
        """Return what a face of the file's `material` takes in this look."""
        return MaterialKey(material if self.override is None else self.override, self.mirrored)


def load_gltf(path: Path) -> Scene:
    """Read a ``.gltf`` or ``.glb`` file.

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
    surfaces: dict[int, Surface] = {}
    shown: list[tuple[PlacedNode, _Look, NodeExtras]] = []
    for placed in place_nodes(document):
        authored = node_extras(document, placed.index)
        look = _look(document, placed.index, authored)
        if look is None:
            continue
        if look.mesh not in surfaces:
            surfaces[look.mesh] = read_surface(document, look.mesh)
        if len(surfaces[look.mesh].triangles):
            shown.append((placed, look, authored))
    if not shown:
        raise document.error("", "has no triangles to voxelize", "check that the scene shows a mesh")
    looks = dict.fromkeys(look for _, look, _ in shown)
    materials, ids = make_materials(document, _keys(looks, surfaces))
    meshes = {look: _mesh(document, look, surfaces[look.mesh], ids) for look in looks}
    names = _names(document, [placed.index for placed, _, _ in shown])
    objects = tuple(
        SceneObject(
            name,
            meshes[look],
            _within_range(document, placed, surfaces[look.mesh]),
            (collider_around(surfaces[look.mesh], authored.voxrt_collider),) if authored.voxrt_collider else (),
            int(meshes[look].materials[0]),
        )
        for name, (placed, look, authored) in zip(names, shown, strict=True)
    )
    return Scene(path.stem, objects, materials, document.warnings)


def _look(document: Document, index: int, authored: NodeExtras) -> _Look | None:
    """Return how node `index` shows its mesh, or None where it has none."""
    node = document.gltf.nodes[index]
    if node.mesh is None:
        if authored.voxrt_collider is not None:
            place = f"nodes[{index}].extras.voxrt_collider"
            raise document.error(place, "the node has no mesh", "put the property on the node with the mesh")
        return None
    document.item(document.gltf.meshes, node.mesh, f"nodes[{index}].mesh", "mesh")
    override = None
    if authored.voxrt_material is not None:
        place = f"nodes[{index}].extras.voxrt_material"
        override = material_named(document, authored.voxrt_material, place)
    return _Look(node.mesh, override, bool(authored.voxrt_reflect))


def _keys(looks: Iterable[_Look], surfaces: dict[int, Surface]) -> set[MaterialKey]:
    return {look.key(int(material)) for look in looks for material in np.unique(surfaces[look.mesh].materials)}


def _mesh(document: Document, look: _Look, surface: Surface, ids: dict[MaterialKey, int]) -> Mesh:
    """Return `surface` with material ids for the file's materials."""
    document.charge(len(surface.triangles), f"meshes[{look.mesh}]")
    materials = np.empty(len(surface.triangles), np.uint8)
    for material in np.unique(surface.materials).tolist():
        faces = surface.materials == material
        materials[faces] = ids[look.key(material)]
        if material == NO_MATERIAL and look.override is None:
            count = int(np.count_nonzero(faces))
            document.warn("default-material", "faces without material took the default material", count)
    return Mesh(surface.positions, surface.triangles, materials)


def _names(document: Document, indices: list[int]) -> list[str]:
    """Name objects after their nodes, else their meshes; where a name repeats, say which node is meant."""
    nodes, meshes = document.gltf.nodes, document.gltf.meshes
    plain = [nodes[index].name or meshes[nodes[index].mesh or 0].name or f"nodes[{index}]" for index in indices]
    repeats = Counter(plain)
    return [
        name if repeats[name] == 1 else f"{name} (nodes[{index}])" for name, index in zip(plain, indices, strict=True)
    ]


def _within_range(document: Document, placed: PlacedNode, surface: Surface) -> NDArray[np.float64]:
    """Return the node's transform, having made sure that it leaves the surface in the range of numbers."""
    with np.errstate(over="ignore", invalid="ignore"):
        reach = np.abs(placed.transform[:3, :3]) @ np.abs(surface.positions).max(axis=0)
        reach += np.abs(placed.transform[:3, 3])
    if not np.isfinite(reach).all():
        raise document.error(f"nodes[{placed.index}]", "the transform leaves the range of numbers")
    return placed.transform
