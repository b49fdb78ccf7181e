"""Properties for voxrt in the `extras` of nodes and materials (custom properties, in Blender).

`voxrt_material` names the material that a node's faces take, or renames a material; `voxrt_collider` makes a node's
mesh collide as a box, a sphere, a hull or a mesh; `voxrt_rule` says which voxels it fills; `voxrt_reflect` makes a
material, or what a node shows, a mirror.
"""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING, TypeVar

import msgspec

from voxrt.voxelize.collider_shapes import ColliderKind  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.formats.gltf.schema_errors import explain
from voxrt.voxelize.rules import Rule  # noqa: TC001

if TYPE_CHECKING:
    from voxrt.voxelize.formats.gltf.document import Document


class MaterialExtras(msgspec.Struct, frozen=True, kw_only=True):
    """The properties of a material: its name in the palette, and whether it is a mirror."""

    voxrt_material: str | None = None
    voxrt_reflect: bool | float = False


class NodeExtras(MaterialExtras, frozen=True, kw_only=True):
    """The properties of a node: the material of its faces, whether they are mirrors, its collider and its rule."""

    voxrt_collider: ColliderKind | None = None
    voxrt_rule: Rule | None = None


def refuse_misplaced(document: Document) -> None:
    """Refuse properties for voxrt on scenes and meshes, where they have no effect."""
    for array, owners in (("scenes", document.gltf.scenes), ("meshes", document.gltf.meshes)):
        for index, owner in enumerate(owners):
            if _PREFIX in bytes(owner.extras):
                place = f"{array}[{index}].extras"
                problem = "properties for voxrt belong on nodes and materials"
                raise document.error(place, problem, "move them there (in Blender: from the mesh to the object)")


_PREFIX = b'"voxrt_'
_T = TypeVar("_T", MaterialExtras, NodeExtras)


def node_extras(document: Document, index: int) -> NodeExtras:
    """Return the properties of node `index`."""
    return _read(document, document.gltf.nodes[index].extras, f"nodes[{index}].extras", NodeExtras)


def material_extras(document: Document, index: int) -> MaterialExtras:
    """Return the properties of material `index`."""
    return _read(document, document.gltf.materials[index].extras, f"materials[{index}].extras", MaterialExtras)


def _read(document: Document, extras: msgspec.Raw, place: str, kind: type[_T]) -> _T:
    if _PREFIX not in bytes(extras):
        return kind()
    try:
        authored = msgspec.json.decode(extras)
    except (msgspec.DecodeError, RecursionError):
        raise document.error(place, "is not valid JSON") from None
    if not isinstance(authored, dict):
        return kind()
    for key in authored:
        if key.startswith("voxrt_") and key not in kind.__struct_fields__:
            nearest = difflib.get_close_matches(key, kind.__struct_fields__, n=1)
            fix = f"did you mean {nearest[0]}?" if nearest else f"use {', '.join(kind.__struct_fields__)}"
            raise document.error(f"{place}.{key}", "unknown property for voxrt", fix)
    try:
        return msgspec.convert(authored, kind)
    except msgspec.ValidationError as error:
        problem, here = explain(error, place)
        raise document.error(here, problem, "correct the property") from None
