"""Materials: what the file's mean for colour, and the table of those in use."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.formats.gltf.extensions import SPECULAR_GLOSSINESS, read_extension
from voxrt.voxelize.formats.gltf.extras import material_extras
from voxrt.voxelize.formats.gltf.schema import SpecularGlossiness
from voxrt.voxelize.scene import DEFAULT_COLOUR

if TYPE_CHECKING:
    from collections.abc import Iterable

    from voxrt.voxelize.colour.material_table import MaterialTable
    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import TextureInfo, Vec4

NO_MATERIAL = -1
"""Stands for the material of faces to which the file gives none."""

BLEND_CUTOFF = 0.5
"""Surfaces to be blended are air where their alpha is below this."""


@dataclass(frozen=True, slots=True, order=True)
class MaterialKey:
    """One of the file's materials, or :data:`NO_MATERIAL`, as it is or made a mirror by a node."""

    index: int
    mirrored: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class Finish:
    """What a material means for voxels.

    Attributes
    ----------
    name
        The author's name for it.
    renamed
        Whether that is a name given for voxrt, which several materials may share to become one.
    factor
        Linear red, green, blue and alpha.
    texture, place
        The texture of its base colour, or None, and where in the file it stands.
    cutoff
        Where alpha is below it there is no surface; 0 for opaque ones.
    mirror
        Whether it is a mirror.
    """

    name: str
    renamed: bool = False
    factor: Vec4 = (1.0, 1.0, 1.0, 1.0)
    texture: TextureInfo | None = None
    place: str = ""
    cutoff: float = 0.0
    mirror: bool = False


def finish(document: Document, key: MaterialKey) -> Finish:
    """Read what `key` means."""
    if key.index == NO_MATERIAL:
        return Finish("default", mirror=key.mirrored)
    material = document.gltf.materials[key.index]
    place = f"materials[{key.index}]"
    authored = material_extras(document, key.index)
    base = material.pbr_metallic_roughness
    factor, texture, where = base.base_color_factor, base.base_color_texture, "pbrMetallicRoughness.baseColorTexture"
    glossy = read_extension(document, material, SPECULAR_GLOSSINESS, SpecularGlossiness, place)
    if glossy is not None:
        factor, texture = glossy.diffuse_factor, glossy.diffuse_texture
        where = f"extensions.{SPECULAR_GLOSSINESS}.diffuseTexture"
    red, green, blue, alpha = (min(max(component, 0.0), 1.0) for component in factor)
    return Finish(
        name=authored.voxrt_material or material.name or place,
        renamed=authored.voxrt_material is not None,
        factor=(red, green, blue, alpha),
        texture=texture,
        place=f"{place}.{where}",
        cutoff={"OPAQUE": 0.0, "MASK": material.alpha_cutoff, "BLEND": BLEND_CUTOFF}[material.alpha_mode],
        mirror=key.mirrored or bool(authored.voxrt_reflect),
    )


def material_names(document: Document) -> dict[str, int]:
    """Map the names by which nodes may ask for the file's materials to their indices, the first of a name winning."""
    named: dict[str, int] = {}
    for index, material in enumerate(document.gltf.materials):
        for name in (material.name, material_extras(document, index).voxrt_material):
            if name:
                named.setdefault(name, index)
    return named


def number_materials(document: Document, table: MaterialTable, used: Iterable[MaterialKey]) -> dict[MaterialKey, int]:
    """Give every material in `used` an id in `table`: in the order of the file's list, the default material last.

    Materials that their author renamed alike become one.

    Raises
    ------
    DoesNotFitError
        More than 255 materials are used.
    """
    ids: dict[MaterialKey, int] = {}
    for key in sorted(set(used), key=lambda key: (key.index == NO_MATERIAL, key)):
        look = finish(document, key)
        if key.index == NO_MATERIAL:
            ids[key] = table.id_of(key, look.name, DEFAULT_COLOUR, mirror=look.mirror, authored=False)
            continue
        red, green, blue = srgb_from_linear(look.factor[:3]).tolist()
        shared = (look.name, look.mirror) if look.renamed else key
        ids[key] = table.id_of(shared, look.name, (red, green, blue), mirror=look.mirror)
        if table.materials()[ids[key]].colour != (red, green, blue):
            document.notes.add("merged-materials", f"materials renamed {look.name!r} take the colour of the first")
    return ids
