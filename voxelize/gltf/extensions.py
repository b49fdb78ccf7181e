"""Which extensions are honoured, which have no bearing on shape or colour, and what happens to the others."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.voxelize.gltf.document import Document

HONOURED = frozenset({"KHR_mesh_quantization", "KHR_materials_unlit"})
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


def check_required(document: Document) -> None:
    """Refuse a file that cannot be read without an extension unknown here; note the others that are unknown."""
    gltf = document.gltf
    known = HONOURED | NO_BEARING
    for at, name in enumerate(gltf.extensions_required):
        if name not in known:
            fix = "export the file without it"
            raise document.error(f"extensionsRequired[{at}]", f"the extension {name[:60]} is not supported", fix)
    for name in dict.fromkeys(gltf.extensions_used):
        if name not in known:
            document.warn("unknown-extension", f"the extension {name[:60]} was ignored")
