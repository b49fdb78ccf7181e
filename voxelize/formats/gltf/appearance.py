"""How a node shows a mesh: which material each primitive takes, and the paint on its triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.paint import Coat, Paint
from voxrt.voxelize.formats.gltf.accessors import as_unit_floats
from voxrt.voxelize.formats.gltf.extensions import TEXTURE_TRANSFORM, VARIANTS, read_extension
from voxrt.voxelize.formats.gltf.materials import NO_MATERIAL, Finish, MaterialKey, finish
from voxrt.voxelize.formats.gltf.schema import FileVariants, PrimitiveVariants, TextureTransform

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.meshes import Span, Surface
    from voxrt.voxelize.formats.gltf.textures import Textures


@dataclass(frozen=True, slots=True)
class Look:
    """How a node shows a mesh. Nodes with equal looks share one mesh value.

    Attributes
    ----------
    mesh
        The mesh's index in the file.
    override
        The material its faces take instead of their own, or None.
    mirrored
        Whether its faces are mirrors.
    variant
        The material variant, an index, or None for the materials that the primitives name first.
    """

    mesh: int
    override: int | None = None
    mirrored: bool = False
    variant: int | None = None


@dataclass(frozen=True, eq=False, slots=True)
class Dress:
    """What the triangles of a surface wear.

    Attributes
    ----------
    runs
        Stretches of triangles that have one colour, as start, stop and material. The others are painted, or air.
    coat
        The paint on painted triangles, or None.
    """

    runs: tuple[tuple[int, int, MaterialKey], ...]
    coat: Coat | None


def find_variant(document: Document, wanted: tuple[str, ...]) -> int | None:
    """Return the index of the material variant whose name is the only one `wanted`, or None where none is.

    Raises
    ------
    AssetError
        The file has no such variant, or several are wanted at once.
    """
    if not wanted:
        return None
    if len(wanted) > 1:
        raise document.error(f"extensions.{VARIANTS}", f"{len(wanted)} variants asked for at once", "ask for one")
    name = wanted[0]
    declared = read_extension(document, document.gltf, VARIANTS, FileVariants, "")
    names = [variant.name for variant in declared.variants] if declared else []
    if name not in names:
        known = ", ".join(map(repr, names[:8])) or "none"
        raise document.error(f"extensions.{VARIANTS}", f"no variant {name!r} in the file", f"it has {known}")
    return names.index(name)


def dress(document: Document, textures: Textures, surface: Surface, look: Look) -> Dress:
    """Find what each triangle of `surface` wears in `look`."""
    count = len(surface.triangles)
    document.charge(count * 8, f"meshes[{look.mesh}]")
    runs: list[tuple[int, int, MaterialKey]] = []
    painter = _Painter(document, textures, count)
    for span in surface.spans:
        place = f"meshes[{look.mesh}].primitives[{span.primitive}]"
        key = MaterialKey(_material(document, look, span, place), look.mirrored)
        wears = finish(document, key)
        faces = span.stop - span.start
        if not faces or painter.paint(span, key, wears):
            continue
        if wears.factor[3] < wears.cutoff:
            document.notes.add("transparent", "faces of transparent materials are air", faces)
            continue
        runs.append((span.start, span.stop, key))
        if key.index == NO_MATERIAL:
            document.notes.add("default-material", "faces without a material got the default one", faces)
    return Dress(tuple(runs), painter.coat())


def _material(document: Document, look: Look, span: Span, place: str) -> int:
    if look.override is not None:
        return look.override
    primitive = document.gltf.meshes[look.mesh].primitives[span.primitive]
    material, where = primitive.material, f"{place}.material"
    mapped = read_extension(document, primitive, VARIANTS, PrimitiveVariants, place)
    if mapped is not None and look.variant is not None:
        for at, mapping in enumerate(mapped.mappings):
            if look.variant in mapping.variants:
                material, where = mapping.material, f"{place}.extensions.{VARIANTS}.mappings[{at}].material"
    if material is None:
        return NO_MATERIAL
    document.item(document.gltf.materials, material, where, "material")
    return material


class _Painter:
    """Collects the paint on the triangles of one surface."""

    def __init__(self, document: Document, textures: Textures, count: int) -> None:
        self._document = document
        self._textures = textures
        self._count = count
        self._paints: dict[tuple[MaterialKey, bool], int] = {}
        self._made: list[Paint] = []
        self._spans: list[tuple[Span, int, NDArray[np.float64] | None, NDArray[np.float64] | None]] = []

    def paint(self, span: Span, key: MaterialKey, wears: Finish) -> bool:
        """Take note of the paint on `span`; False where there is none but the material's own colour."""
        colours = self._vertex_colours(span)
        texture = None
        uv = None
        if wears.texture is not None:
            uv = self._coordinates(span, wears)
            if uv is not None:
                texture = self._textures.read(wears.texture.index, f"{wears.place}.index")
        if texture is None and colours is None:
            return False
        same = key, texture is None
        if same not in self._paints:
            self._paints[same] = len(self._made)
            self._made.append(Paint(wears.name, wears.factor, texture, wears.cutoff, wears.mirror))
        self._spans.append((span, self._paints[same], uv, colours))
        return True

    def coat(self) -> Coat | None:
        """Return the paint collected, or None where there is none."""
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
        return Coat(tuple(self._made), rows, uv, colours)

    def _vertex_colours(self, span: Span) -> NDArray[np.float64] | None:
        """Return the linear colours of the vertices, shape (V, 4), or None where they have none or are all white."""
        if "COLOR_0" not in span.attributes:
            return None
        colours = as_unit_floats(span.attributes.stored("COLOR_0", {"VEC3", "VEC4"}))
        if not np.isfinite(colours).all():
            self._document.notes.add("vertex-colour", "vertex colours that are not numbers were taken as black")
            colours = np.nan_to_num(colours, nan=0.0, posinf=0.0, neginf=0.0)
        self._fits(span, colours, "COLOR_0")
        if colours.shape[1] == 3:
            colours = np.column_stack([colours, np.ones(len(colours))])
        colours = np.clip(colours, 0.0, 1.0)
        return None if (colours == 1.0).all() else colours

    def _coordinates(self, span: Span, wears: Finish) -> NDArray[np.float64] | None:
        """Return the transformed texture coordinates of the vertices, shape (V, 2), or None where they have none."""
        assert wears.texture is not None
        moved = read_extension(self._document, wears.texture, TEXTURE_TRANSFORM, TextureTransform, wears.place)
        number = wears.texture.tex_coord
        if moved is not None and moved.tex_coord is not None:
            number = moved.tex_coord
        name = f"TEXCOORD_{number}"
        if name not in span.attributes:
            message = f"primitives without the {name} that their texture asks for took the colour of its factor"
            self._document.notes.add("texture", message)
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
            raise self._document.error(wears.place, "the texture coordinates leave the range of numbers")
        return placed

    def _fits(self, span: Span, values: NDArray[np.float64], name: str) -> None:
        if len(span.corners) and int(span.corners.max()) >= len(values):
            place = f"{span.attributes.place}.attributes.{name}"
            raise self._document.error(place, f"{len(values)} elements, fewer than there are vertices")
