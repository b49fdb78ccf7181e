"""Which extensions are honoured, which have no bearing on shape or colour, and what happens to the others."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import msgspec

from voxrt.voxelize.formats.gltf.schema_errors import explain

if TYPE_CHECKING:
    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import Property

DRACO = "KHR_draco_mesh_compression"
INSTANCING = "EXT_mesh_gpu_instancing"
MESHOPT = "EXT_meshopt_compression"
PHYSICS = "KHR_physics_rigid_bodies"
SHAPES = "KHR_implicit_shapes"
SPECULAR_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
TEXTURE_TRANSFORM = "KHR_texture_transform"
VARIANTS = "KHR_materials_variants"
VISIBILITY = "KHR_node_visibility"

HONOURED = frozenset(
    {
        DRACO,
        INSTANCING,
        MESHOPT,
        PHYSICS,
        SHAPES,
        SPECULAR_GLOSSINESS,
        TEXTURE_TRANSFORM,
        VARIANTS,
        VISIBILITY,
        "EXT_texture_webp",
        "KHR_materials_unlit",
        "KHR_mesh_quantization",
    }
)
"""Extensions whose meaning reaches the scene."""

NO_BEARING = frozenset(
    {
        "CESIUM_primitive_outline",
        "EXT_lights_image_based",
        "EXT_mesh_features",
        "EXT_structural_metadata",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_xmp_json_ld",
    }
)
"""Extensions that say nothing about where surfaces are or what base colour they have."""


CONVERT_IMAGES = "convert it: gltf-transform ktxdecompress IN OUT for KTX2, gltf-transform png IN OUT for others"
"""What turns images of kinds that are not read into such that are (glTF Transform's command line)."""

_WAYS_OUT = {
    "KHR_meshopt_compression": "compress it with EXT_meshopt_compression, or not at all",
    "KHR_texture_basisu": CONVERT_IMAGES,
    "EXT_texture_avif": CONVERT_IMAGES,
}

_T = TypeVar("_T")


def read_extension(document: Document, owner: Property, name: str, kind: type[_T], place: str) -> _T | None:
    """Return the extension `name` of `owner`, which stands at `place`, as a value of `kind`; None where it has none."""
    if name not in owner.extensions:
        return None
    try:
        return msgspec.json.decode(owner.extensions[name], type=kind)
    except msgspec.ValidationError as error:
        problem, here = explain(error, f"{place}.extensions.{name}")
        raise document.error(here, problem) from None
    except (msgspec.DecodeError, RecursionError):
        raise document.error(f"{place}.extensions.{name}".removeprefix("."), "is not JSON that can be read") from None


def check_required(document: Document) -> None:
    """Refuse a file that cannot be read without an extension unknown here; note the others that are unknown."""
    gltf = document.gltf
    known = HONOURED | NO_BEARING
    for at, name in enumerate(gltf.extensions_required):
        if name not in known:
            fix = _WAYS_OUT.get(name, "export the file without it")
            raise document.error(f"extensionsRequired[{at}]", f"the extension {name[:60]} is not supported", fix)
    for name in dict.fromkeys(gltf.extensions_used):
        if name not in known:
            document.notes.add("unknown-extension", f"the extension {name[:60]} was ignored")
