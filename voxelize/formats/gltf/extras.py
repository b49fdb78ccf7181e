"""Properties for voxrt in the `extras` of nodes and materials (custom properties, in Blender)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from voxrt.voxelize.formats.authored_properties import PREFIX, MaterialProperties, ObjectProperties, checked_properties

if TYPE_CHECKING:
    from voxrt.voxelize.formats.authored_properties import P
    from voxrt.voxelize.formats.gltf.document import Document


def refuse_misplaced(document: Document) -> None:
    """Refuse properties for voxrt on scenes and meshes, where they have no effect."""
    for array, owners in (("scenes", document.gltf.scenes), ("meshes", document.gltf.meshes)):
        for index, owner in enumerate(owners):
            if _PREFIX in bytes(owner.extras):
                place = f"{array}[{index}].extras"
                problem = "properties for voxrt belong on nodes and materials"
                raise document.error(place, problem, "move them there (in Blender: from the mesh to the object)")


_PREFIX = f'"{PREFIX}'.encode()


def node_extras(document: Document, index: int) -> ObjectProperties:
    """Return the properties of node `index`."""
    return _read(document, document.gltf.nodes[index].extras, f"nodes[{index}].extras", ObjectProperties)


def material_extras(document: Document, index: int) -> MaterialProperties:
    """Return the properties of material `index`."""
    return _read(document, document.gltf.materials[index].extras, f"materials[{index}].extras", MaterialProperties)


def _read(document: Document, extras: msgspec.Raw, place: str, kind: type[P]) -> P:
    if _PREFIX not in bytes(extras):
        return kind()
    try:
        authored = msgspec.json.decode(extras)
    except (msgspec.DecodeError, RecursionError):
        raise document.error(place, "is not valid JSON") from None
    if not isinstance(authored, dict):
        return kind()
    return checked_properties(authored, kind, place, document.error)
