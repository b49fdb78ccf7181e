"""The parts of the glTF 2.0 JSON that define geometry and colour, as validated values.

Field names are the format's own in snake case. Other members (roughness, sheen …) are skipped. `extensions` and
`extras` stay raw until they are needed. Source: Khronos, glTF 2.0
specification, section 5 (properties reference).
"""

# Without `from __future__ import annotations`: msgspec compiles every annotation that is a string, which takes 2 ms.

from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Raw, Struct

Index: TypeAlias = Annotated[int, Meta(ge=0)]
Count: TypeAlias = Annotated[int, Meta(ge=1)]
Vec3: TypeAlias = tuple[float, float, float]
Vec4: TypeAlias = tuple[float, float, float, float]
Matrix4: TypeAlias = Annotated[list[float], Meta(min_length=16, max_length=16)]

BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
ComponentType: TypeAlias = Literal[5120, 5121, 5122, 5123, 5125, 5126]
ElementType: TypeAlias = Literal["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"]

POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN = range(7)


class Property(Struct, frozen=True, kw_only=True, rename="camel"):
    """Members of every glTF object."""

    extensions: dict[str, Raw] = {}
    extras: Raw = Raw(b"null")


class Named(Property, frozen=True, kw_only=True):
    """An object of one of the file's top-level arrays."""

    name: str = ""


class Asset(Property, frozen=True, kw_only=True):
    """Which version of the format the file is written in."""

    version: Annotated[str, Meta(pattern=r"^[0-9]+\.[0-9]+$")]
    min_version: Annotated[str, Meta(pattern=r"^[0-9]+\.[0-9]+$")] = "2.0"


class Buffer(Named, frozen=True, kw_only=True):
    """Bytes: inline, in another file, or in the binary chunk of a GLB."""

    byte_length: Count
    uri: str | None = None


class BufferView(Named, frozen=True, kw_only=True):
    """A stretch of a buffer."""

    buffer: Index
    byte_length: Count
    byte_offset: Index = 0
    byte_stride: Annotated[int, Meta(ge=1, le=252)] | None = None


class SparseIndices(Property, frozen=True, kw_only=True):
    """Which elements of a sparse accessor differ."""

    buffer_view: Index
    component_type: Literal[5121, 5123, 5125]
    byte_offset: Index = 0


class SparseValues(Property, frozen=True, kw_only=True):
    """What the differing elements are."""

    buffer_view: Index
    byte_offset: Index = 0


class Sparse(Property, frozen=True, kw_only=True):
    """Elements that differ from the accessor's base."""

    count: Count
    indices: SparseIndices
    values: SparseValues


class Accessor(Named, frozen=True, kw_only=True):
    """How to read typed elements from a buffer view."""

    component_type: ComponentType
    count: Count
    type: ElementType
    buffer_view: Index | None = None
    byte_offset: Index | None = None
    normalized: bool = False
    sparse: Sparse | None = None


class Primitive(Property, frozen=True, kw_only=True):
    """Geometry of one material."""

    attributes: dict[str, Index]
    indices: Index | None = None
    material: Index | None = None
    mode: Annotated[int, Meta(ge=0, le=6)] = TRIANGLES
    targets: list[dict[str, Index]] = []


class VariantMapping(Struct, frozen=True, kw_only=True):
    """A material that a primitive takes in some variants."""

    material: Index
    variants: list[Index]


class PrimitiveVariants(Struct, frozen=True, kw_only=True):
    """KHR_materials_variants on a primitive."""

    mappings: list[VariantMapping]


class Variant(Struct, frozen=True, kw_only=True):
    """One of the file's variants."""

    name: str


class FileVariants(Struct, frozen=True, kw_only=True):
    """KHR_materials_variants on the file."""

    variants: list[Variant]


class DracoPrimitive(Struct, frozen=True, kw_only=True, rename="camel"):
    """KHR_draco_mesh_compression: the buffer view that holds a primitive, and the ids of its attributes there."""

    buffer_view: Index
    attributes: dict[str, Index]


class Instances(Struct, frozen=True, kw_only=True):
    """EXT_mesh_gpu_instancing: accessors with one element per instance."""

    attributes: dict[str, Index]


class Visibility(Struct, frozen=True, kw_only=True):
    """KHR_node_visibility: whether a node and its descendants are shown."""

    visible: bool = True


class Mesh(Named, frozen=True, kw_only=True):
    """Primitives that are placed together."""

    primitives: Annotated[list[Primitive], Meta(min_length=1)]
    weights: list[float] = []


class Node(Named, frozen=True, kw_only=True):
    """A node of the hierarchy."""

    children: list[Index] = []
    mesh: Index | None = None
    skin: Index | None = None
    camera: Index | None = None
    matrix: Matrix4 | None = None
    translation: Vec3 | None = None
    rotation: Vec4 | None = None
    scale: Vec3 | None = None
    weights: list[float] = []


class Scene(Named, frozen=True, kw_only=True):
    """Root nodes that are shown together."""

    nodes: list[Index] = []


class TextureInfo(Property, frozen=True, kw_only=True):
    """Which texture, over which texture coordinates."""

    index: Index
    tex_coord: Index = 0


class NormalTextureInfo(TextureInfo, frozen=True, kw_only=True):
    """A normal texture; it is only validated."""

    scale: float = 1.0


class Roughness(Property, frozen=True, kw_only=True):
    """The base colour of the metallic-roughness model."""

    base_color_factor: Vec4 = (1.0, 1.0, 1.0, 1.0)
    base_color_texture: TextureInfo | None = None


class TextureTransform(Struct, frozen=True, kw_only=True, rename="camel"):
    """KHR_texture_transform: where in the image texture coordinates fall."""

    offset: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)
    tex_coord: Index | None = None


class SpecularGlossiness(Struct, frozen=True, kw_only=True, rename="camel"):
    """The base colour of KHR_materials_pbrSpecularGlossiness."""

    diffuse_factor: Vec4 = (1.0, 1.0, 1.0, 1.0)
    diffuse_texture: TextureInfo | None = None


class EmissiveStrength(Struct, frozen=True, kw_only=True, rename="camel"):
    """KHR_materials_emissive_strength: by how much the emission is brighter than its factor and texture say."""

    emissive_strength: Annotated[float, Meta(ge=0.0)] = 1.0


class Material(Named, frozen=True, kw_only=True):
    """A material."""

    pbr_metallic_roughness: Roughness = Roughness()
    normal_texture: NormalTextureInfo | None = None
    emissive_factor: Vec3 = (0.0, 0.0, 0.0)
    emissive_texture: TextureInfo | None = None
    alpha_mode: Literal["OPAQUE", "MASK", "BLEND"] = "OPAQUE"
    alpha_cutoff: Annotated[float, Meta(ge=0.0)] = 0.5


class Texture(Named, frozen=True, kw_only=True):
    """An image and how it is sampled."""

    sampler: Index | None = None
    source: Index | None = None


class TextureSource(Struct, frozen=True, kw_only=True):
    """EXT_texture_webp: the image to use instead."""

    source: Index


class Sampler(Named, frozen=True, kw_only=True):
    """Filtering, and what happens outside the image."""

    mag_filter: Literal[9728, 9729] = 9729
    wrap_s: Literal[33071, 33648, 10497] = 10497
    wrap_t: Literal[33071, 33648, 10497] = 10497


class Image(Named, frozen=True, kw_only=True):
    """An image, in the file or in another."""

    uri: str | None = None
    mime_type: str = ""
    buffer_view: Index | None = None


class Perspective(Property, frozen=True, kw_only=True):
    """The projection of a perspective camera."""

    yfov: float


class Camera(Named, frozen=True, kw_only=True):
    """A camera: it looks along -z, y is up."""

    type: str
    perspective: Perspective | None = None


class Skin(Named, frozen=True, kw_only=True):
    """Joints that move vertices."""

    joints: Annotated[list[Index], Meta(min_length=1)]
    inverse_bind_matrices: Index | None = None


class AnimationTarget(Property, frozen=True, kw_only=True):
    """The property that a channel animates."""

    path: str
    node: Index | None = None


class AnimationChannel(Property, frozen=True, kw_only=True):
    """One property of one node that changes with time."""

    sampler: Index
    target: AnimationTarget


class AnimationSampler(Property, frozen=True, kw_only=True):
    """Key frames and what happens between them."""

    input: Index
    output: Index
    interpolation: Literal["LINEAR", "STEP", "CUBICSPLINE"] = "LINEAR"


class Animation(Named, frozen=True, kw_only=True):
    """Channels that play together."""

    channels: Annotated[list[AnimationChannel], Meta(min_length=1)]
    samplers: Annotated[list[AnimationSampler], Meta(min_length=1)]


class Gltf(Property, frozen=True, kw_only=True):
    """The whole file."""

    asset: Asset
    extensions_used: list[str] = []
    extensions_required: list[str] = []
    scene: Index | None = None
    scenes: list[Scene] = []
    nodes: list[Node] = []
    meshes: list[Mesh] = []
    materials: list[Material] = []
    accessors: list[Accessor] = []
    buffer_views: list[BufferView] = []
    buffers: list[Buffer] = []
    textures: list[Texture] = []
    samplers: list[Sampler] = []
    images: list[Image] = []
    skins: list[Skin] = []
    animations: list[Animation] = []
    cameras: list[Camera] = []
