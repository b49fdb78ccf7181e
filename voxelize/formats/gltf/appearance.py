"""The appearance of a mesh as a node shows it: materials, textures and vertex colours of its triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.formats.colour_range import CLAMPED, clamped
from voxrt.voxelize.formats.gltf.accessors import as_unit_floats
from voxrt.voxelize.formats.gltf.extensions import TEXTURE_TRANSFORM, VARIANTS
from voxrt.voxelize.formats.gltf.materials import NO_MATERIAL, MaterialKey, MaterialProperties, material_properties
from voxrt.voxelize.formats.gltf.schema import FileVariants, PrimitiveVariants, TextureTransform
from voxrt.voxelize.formats.opacity import log_left_out

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.meshes import Span, Surface
    from voxrt.voxelize.formats.gltf.textures import Textures


class AppearanceKey(Struct, frozen=True):
    """How a node shows a mesh. Nodes with equal keys and poses share one mesh."""

    mesh: int  # the mesh's index in the file
    override: int | None = None  # the material its faces take instead of their own, or None
    mirrored: bool = False  # whether its faces are mirrors
    variant: int | None = None  # the index of the material variant; None for the default materials of the primitives


class SurfaceMaterials(Struct, frozen=True, eq=False):
    """The materials of the triangles of a surface."""

    # Runs of triangles of one colour, as start, stop and material. The other triangles have an appearance, or
    # are fully transparent.
    runs: tuple[tuple[int, int, MaterialKey], ...]
    appearance: SurfaceAppearance | None  # textures and vertex colours of the others; None where no triangle has any


def find_variant(document: Document, wanted: tuple[str, ...]) -> int | None:
    """Return the index of the material variant that is `wanted`; None where none is.

    Refuse several, and unknown ones.
    """
    if not wanted:
        return None
    if len(wanted) > 1:
        raise document.error(
            f"extensions.{VARIANTS}", f"{len(wanted)} variants were requested, and one can be shown", "request one"
        )
    name = wanted[0]
    declared = document.extension(document.gltf, VARIANTS, FileVariants, "")
    names = [variant.name for variant in declared.variants] if declared else []
    if name not in names:
        known = ", ".join(map(repr, names[:8])) or "none"
        raise document.error(f"extensions.{VARIANTS}", f"no variant {name!r} in the file", f"it has {known}")
    return names.index(name)


def read_appearance(
    document: Document, textures: Textures, surface: Surface, appearance_key: AppearanceKey
) -> SurfaceMaterials:
    """Find what each triangle of `surface` properties in `appearance_key`."""
    count = len(surface.triangles)
    document.charge(count * 8, f"meshes[{appearance_key.mesh}]")
    runs: list[tuple[int, int, MaterialKey]] = []
    builder = _AppearanceBuilder(document, textures, count)
    for span in surface.spans:
        place = f"meshes[{appearance_key.mesh}].primitives[{span.primitive}]"
        key = MaterialKey(_material(document, appearance_key, span, place), appearance_key.mirrored)
        properties = material_properties(document, key)
        faces = span.stop - span.start
        if properties.is_clamped:
            document.log.add("colour-range", CLAMPED, faces)
        if not faces or builder.add(span, key, properties):
            continue
        if properties.factor[3] < properties.cutoff:
            log_left_out(document.log, properties.factor[3], properties.cutoff, document.opaque_from, faces)
            continue
        runs.append((span.start, span.stop, key))
        if key.index == NO_MATERIAL:
            document.log.add("default-material", "faces without a material got the default one", faces)
    return SurfaceMaterials(tuple(runs), builder.result())


def _material(document: Document, appearance_key: AppearanceKey, span: Span, place: str) -> int:
    if appearance_key.override is not None:
        return appearance_key.override
    primitive = document.gltf.meshes[appearance_key.mesh].primitives[span.primitive]
    material, where = primitive.material, f"{place}.material"
    mapped = document.extension(primitive, VARIANTS, PrimitiveVariants, place)
    if mapped is not None and appearance_key.variant is not None:
        for at, mapping in enumerate(mapped.mappings):
            if appearance_key.variant in mapping.variants:
                material, where = mapping.material, f"{place}.extensions.{VARIANTS}.mappings[{at}].material"
    if material is None:
        return NO_MATERIAL
    document.item(document.gltf.materials, material, where, "material")
    return material


class _AppearanceBuilder:
    """Collects the textures and vertex colours of one surface."""

    def __init__(self, document: Document, textures: Textures, count: int) -> None:
        self._document = document
        self._textures = textures
        self._count = count
        self._appearances: dict[tuple[MaterialKey, bool], int] = {}
        self._entries: list[Appearance] = []
        self._spans: list[tuple[Span, int, NDArray[np.float64] | None, NDArray[np.float64] | None]] = []

    def add(self, span: Span, key: MaterialKey, properties: MaterialProperties) -> bool:
        """Add the appearance of `span`; return False where its material has a uniform colour."""
        colours = self._vertex_colours(span, emits=properties.emits)
        texture = None
        uv = None
        if properties.texture is not None:
            uv = self._coordinates(span, properties)
            if uv is not None:
                texture = self._textures.read(properties.texture.index, f"{properties.place}.index")
        if texture is None and colours is None:
            return False
        same = key, texture is None
        if same not in self._appearances:
            self._appearances[same] = len(self._entries)
            self._entries.append(
                Appearance(properties.name, properties.factor, texture, properties.cutoff, properties.mirror)
            )
        self._spans.append((span, self._appearances[same], uv, colours))
        return True

    def result(self) -> SurfaceAppearance | None:
        """Return the appearance of the surface; None where there is none."""
        if not self._spans:
            return None
        self._document.charge(self._count * 100, "meshes")
        rows = np.full(self._count, -1, np.int32)
        uv = np.zeros((self._count, 3, 2))
        colours = np.ones((self._count, 3, 4), np.float32)
        for span, row, coordinates, own in self._spans:
            part = slice(span.start, span.stop)
            rows[part] = row
            if coordinates is not None:
                uv[part] = coordinates[span.corners]
            if own is not None:
                colours[part] = own[span.corners]
        return SurfaceAppearance(tuple(self._entries), rows, uv, colours)

    def _vertex_colours(self, span: Span, *, emits: bool) -> NDArray[np.float64] | None:
        """Return the linear colours of the vertices, shape (V, 4), or None where they have none or are all white."""
        if "COLOR_0" not in span.attributes:
            return None
        colours = as_unit_floats(span.attributes.stored("COLOR_0", {"VEC3", "VEC4"}))
        if not np.isfinite(colours).all():
            self._document.log.add("vertex-colour", "vertex colours that are not numbers were taken as black")
            colours = np.nan_to_num(colours, nan=0.0, posinf=0.0, neginf=0.0)
        self._fits(span, colours, "COLOR_0")
        if colours.shape[1] == 3:
            colours = np.column_stack([colours, np.ones(len(colours))])
        colours = clamped(colours, self._document.log)
        if emits:
            colours[:, :3] = 1.0
        return None if (colours == 1.0).all() else colours

    def _coordinates(self, span: Span, properties: MaterialProperties) -> NDArray[np.float64] | None:
        """Return the transformed texture coordinates of the vertices, shape (V, 2), or None where they have none."""
        assert properties.texture is not None
        moved = self._document.extension(properties.texture, TEXTURE_TRANSFORM, TextureTransform, properties.place)
        number = properties.texture.tex_coord
        if moved is not None and moved.tex_coord is not None:
            number = moved.tex_coord
        name = f"TEXCOORD_{number}"
        if name not in span.attributes:
            message = f"primitives without the {name} that their texture needs took the colour of their factor"
            self._document.log.add("texture", message)
            return None
        uv = span.attributes.floats(name, {"VEC2"})
        self._fits(span, uv, name)
        if moved is None:
            return uv
        cos, sin = np.cos(moved.rotation), np.sin(moved.rotation)
        with np.errstate(over="ignore", invalid="ignore"):
            u, v = (uv * moved.scale).T
            placed: NDArray[np.float64] = np.column_stack([cos * u + sin * v, cos * v - sin * u]) + moved.offset
        if not np.isfinite(placed).all():
            raise self._document.error(properties.place, "the texture coordinates overflow")
        return placed

    def _fits(self, span: Span, values: NDArray[np.float64], name: str) -> None:
        if len(span.corners) and int(span.corners.max()) >= len(values):
            place = f"{span.attributes.place}.attributes.{name}"
            raise self._document.error(place, f"{len(values)} elements, fewer than there are vertices")
