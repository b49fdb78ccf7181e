"""Materials: their colour properties, and the ids of those in use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.formats.gltf.extensions import EMISSIVE_STRENGTH, SPECULAR_GLOSSINESS
from voxrt.voxelize.formats.gltf.extras import material_extras
from voxrt.voxelize.formats.gltf.schema import EmissiveStrength, SpecularGlossiness
from voxrt.voxelize.materials import DEFAULT_COLOUR

if TYPE_CHECKING:
    from collections.abc import Iterable

    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import Material, TextureInfo, Vec3, Vec4
    from voxrt.voxelize.formats.material_table import MaterialTable

NO_MATERIAL = -1
"""The index of the material of faces that have none."""


class MaterialKey(Struct, frozen=True, order=True):
    """One of the file's materials, or :data:`NO_MATERIAL`; `mirrored` where a node makes it a mirror."""

    index: int
    mirrored: bool = False


class MaterialProperties(Struct, frozen=True, eq=False):
    """The properties of a material that matter for voxels."""

    name: str
    # Whether the name comes from the property `voxrt_material`; materials that share such a name become one.
    renamed: bool = False
    factor: Vec4 = (1.0, 1.0, 1.0, 1.0)  # linear red, green, blue and alpha
    # The texture of its base colour, or None, and its JSON path.
    texture: TextureInfo | None = None
    place: str = ""
    cutoff: float = 0.0  # the surface is cut away where its alpha is below this; 0 for opaque surfaces
    mirror: bool = False
    emits: bool = False  # its colour is that of its emission, which vertex colours do not change
    is_clamped: bool = False  # the file's factor is not within 0 … 1


def material_properties(document: Document, key: MaterialKey) -> MaterialProperties:
    """Read the properties of a material."""
    if key.index == NO_MATERIAL:
        return MaterialProperties("default", mirror=key.mirrored)
    material = document.gltf.materials[key.index]
    place = f"materials[{key.index}]"
    authored = material_extras(document, key.index)
    base = material.pbr_metallic_roughness
    factor, texture, where = base.base_color_factor, base.base_color_texture, "pbrMetallicRoughness.baseColorTexture"
    glossy = document.extension(material, SPECULAR_GLOSSINESS, SpecularGlossiness, place)
    if glossy is not None:
        factor, texture = glossy.diffuse_factor, glossy.diffuse_texture
        where = f"extensions.{SPECULAR_GLOSSINESS}.diffuseTexture"
    emission = _emission(document, material, place) if max(factor[:3]) <= 0 else None
    if emission is not None:  # it reflects nothing, and shows what it emits
        factor, texture, where = (*emission, factor[3]), material.emissive_texture, "emissiveTexture"
    red, green, blue, alpha = (min(max(component, 0.0), 1.0) for component in factor)
    return MaterialProperties(
        name=authored.voxrt_material or material.name or place,
        renamed=authored.voxrt_material is not None,
        factor=(red, green, blue, alpha),
        texture=texture,
        place=f"{place}.{where}",
        cutoff={"OPAQUE": 0.0, "MASK": material.alpha_cutoff, "BLEND": document.opaque_from}[material.alpha_mode],
        mirror=key.mirrored or bool(authored.voxrt_reflect),
        emits=emission is not None,
        is_clamped=(red, green, blue, alpha) != tuple(factor),
    )


def _emission(document: Document, material: Material, place: str) -> Vec3 | None:
    """Return the linear emission of a material; None without any."""
    found = document.extension(material, EMISSIVE_STRENGTH, EmissiveStrength, place)
    strength = 1.0 if found is None else found.emissive_strength
    red, green, blue = (component * strength for component in material.emissive_factor)
    return (red, green, blue) if max(red, green, blue) > 0 else None


def material_names(document: Document) -> dict[str, int]:
    """Return the index of each material name that nodes may use; the first material of a name wins."""
    named: dict[str, int] = {}
    for index, material in enumerate(document.gltf.materials):
        for name in (material.name, material_extras(document, index).voxrt_material):
            if name:
                named.setdefault(name, index)
    return named


def number_materials(document: Document, table: MaterialTable, used: Iterable[MaterialKey]) -> dict[MaterialKey, int]:
    """Give every material in `used` an id in `table`: in the file's order, the default material last.

    Materials that their author gave the same `voxrt_material` become one.
    """
    ids: dict[MaterialKey, int] = {}
    for key in sorted(set(used), key=lambda key: (key.index == NO_MATERIAL, key)):
        properties = material_properties(document, key)
        if key.index == NO_MATERIAL:
            ids[key] = table.id_of(key, properties.name, DEFAULT_COLOUR, mirror=properties.mirror, authored=False)
            continue
        red, green, blue = srgb_from_linear(properties.factor[:3]).tolist()
        shared = (properties.name, properties.mirror) if properties.renamed else key
        ids[key] = table.id_of(shared, properties.name, (red, green, blue), mirror=properties.mirror)
        if table.materials()[ids[key]].colour != (red, green, blue):
            document.log.add("merged-materials", f"materials renamed {properties.name!r} took the colour of the first")
    return ids
