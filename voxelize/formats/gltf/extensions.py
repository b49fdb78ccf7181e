"""Names of glTF extensions: those that are supported, and those that affect neither geometry nor base colour."""

from __future__ import annotations

DRACO = "KHR_draco_mesh_compression"
EMISSIVE_STRENGTH = "KHR_materials_emissive_strength"
INSTANCING = "EXT_mesh_gpu_instancing"
MESHOPT = ("KHR_meshopt_compression", "EXT_meshopt_compression")
PHYSICS = "KHR_physics_rigid_bodies"
SHAPES = "KHR_implicit_shapes"
SPECULAR_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
TEXTURE_TRANSFORM = "KHR_texture_transform"
VARIANTS = "KHR_materials_variants"
VISIBILITY = "KHR_node_visibility"

SUPPORTED = frozenset(
    {
        DRACO,
        EMISSIVE_STRENGTH,
        INSTANCING,
        *MESHOPT,
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
"""Extensions that the loader reads."""

WITHOUT_EFFECT = frozenset(
    {
        "CESIUM_primitive_outline",
        "EXT_lights_image_based",
        "EXT_mesh_features",
        "EXT_structural_metadata",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_xmp_json_ld",
    }
)
"""Extensions that affect neither geometry nor base colour."""


CONVERT_IMAGES = (
    "convert its images to PNG: npx @gltf-transform/cli ktxdecompress IN OUT for KTX2, npx @gltf-transform/cli png IN "
    "OUT for others"
)
"""How to convert unsupported image formats: glTF Transform's command line."""

REPLACEMENTS = {"KHR_texture_basisu": CONVERT_IMAGES, "EXT_texture_avif": CONVERT_IMAGES}
"""What to do about a required extension that is not supported."""
