"""Materials: what the file's mean as uniform colours, and which of them get an id."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from voxrt.voxelize.colour import srgb_from_linear
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.gltf.extras import material_extras
from voxrt.voxelize.scene import DEFAULT_COLOUR, EMPTY, MATERIAL_LIMIT, Material

if TYPE_CHECKING:
    from collections.abc import Iterable

    from voxrt.voxelize.gltf.document import Document

NO_MATERIAL = -1
"""Stands for the material of faces to which the file gives none."""


@dataclass(frozen=True, slots=True, order=True)
class MaterialKey:
    """One of the file's materials, or :data:`NO_MATERIAL`, as it is or made a mirror by a node."""

    index: int
    mirrored: bool = False


def material_named(document: Document, name: str, place: str) -> int:
    """Return the index of the file's material that goes by `name`."""
    for index, material in enumerate(document.gltf.materials):
        if name in (material.name, material_extras(document, index).voxrt_material):
            return index
    known = ", ".join(repr(material.name) for material in document.gltf.materials[:8] if material.name)
    raise document.error(place, f"no material {name!r} in the file", f"it has {known or 'no named materials'}")


def make_materials(
    document: Document, used: Iterable[MaterialKey]
) -> tuple[tuple[Material, ...], dict[MaterialKey, int]]:
    """Give every material in `used` an id: in the order of the file's list, the default material last.

    Returns
    -------
    materials, ids
        The scene's table, entry 0 empty, and the id of each key.

    Raises
    ------
    DoesNotFitError
        More than 255 materials are used.
    """
    table = [EMPTY]
    ids: dict[MaterialKey, int] = {}
    merged: dict[tuple[str, bool], int] = {}
    for key in sorted(set(used), key=lambda key: (key.index == NO_MATERIAL, key)):
        material, renamed = _uniform(document, key)
        group = (material.name, material.mirror)
        if renamed and group in merged:
            ids[key] = merged[group]
            if table[ids[key]].colour != material.colour:
                document.warn("merged-materials", f"materials renamed {material.name!r} take the first one's colour")
            continue
        if material.name in {other.name for other in table}:
            where = f"materials[{key.index}]" if key.index != NO_MATERIAL else "none in the file"
            material = replace(material, name=f"{material.name} ({where}{', mirror' if key.mirrored else ''})")
        ids[key] = len(table)
        table.append(material)
        if renamed:
            merged[group] = ids[key]
    if len(table) - 1 > MATERIAL_LIMIT:
        raise DoesNotFitError(
            f"{document.path}: uses {len(table) - 1} materials, a memory holds {MATERIAL_LIMIT}; "
            "give materials that look alike one name in their voxrt_material property"
        )
    return tuple(table), ids


def _uniform(document: Document, key: MaterialKey) -> tuple[Material, bool]:
    """Return what `key` is in one colour, and whether its author gave it another name for voxrt."""
    if key.index == NO_MATERIAL:
        return Material("default", DEFAULT_COLOUR, key.mirrored, authored=False), False
    material = document.gltf.materials[key.index]
    authored = material_extras(document, key.index)
    if material.pbr_metallic_roughness.base_color_texture is not None:
        document.warn("texture", "materials with a texture took the colour of their base factor alone")
    red, green, blue = srgb_from_linear(material.pbr_metallic_roughness.base_color_factor[:3]).tolist()
    name = authored.voxrt_material or material.name or f"materials[{key.index}]"
    mirror = key.mirrored or bool(authored.voxrt_reflect)
    return Material(name, (red, green, blue), mirror), authored.voxrt_material is not None
