"""What each face of an OBJ file looks like: its material's id, or paint."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.images import decode_image
from voxrt.voxelize.colour.paint import Coat, Paint
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.formats.companions import ALLOW_OUTSIDE
from voxrt.voxelize.formats.obj.mtl import MtlMaterial, MtlTexture, read_mtl
from voxrt.voxelize.scene import DEFAULT_COLOUR

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.colour.material_table import MaterialTable
    from voxrt.voxelize.colour.texture import Wrap
    from voxrt.voxelize.formats.companions import Companions
    from voxrt.voxelize.formats.obj.statements import Statements
    from voxrt.voxelize.formats.obj.text import Text
    from voxrt.voxelize.notes import Notes

OPAQUE_FROM = 0.5
"""A material of lower opacity is air."""


@dataclass(eq=False, slots=True)
class Appearance:
    """How faces look, face by face.

    Attributes
    ----------
    materials
        uint8, shape (F,): material ids; 0 for air and for painted faces.
    rows
        int32, shape (F,): paints; -1 where a face has none.
    paints
        The paints.
    layouts
        Of each paint, how texture coordinates are scaled and moved: ``map_Kd -s`` and ``-o``.
    """

    materials: NDArray[np.uint8]
    rows: NDArray[np.int32]
    paints: list[Paint] = field(default_factory=list)
    layouts: list[MtlTexture | None] = field(default_factory=list)


def look_at_faces(
    text: Text, said: Statements, companions: Companions, table: MaterialTable, notes: Notes
) -> Appearance:
    """Find the look of every face: the texture of its material, else its vertices' colours, else ``Kd``.

    Raises
    ------
    AssetError
        A library or an image is broken.
    DoesNotFitError
        More than 255 materials.
    """
    library = _libraries(companions, said, notes)
    lines = np.array([line for line, _ in said.materials], dtype=np.int64)
    turn = np.searchsorted(lines, said.face_lines) - 1  # which usemtl each face is under; -1 before the first
    coloured = _coloured_faces(said)
    seen = Appearance(np.zeros(len(turn), dtype=np.uint8), np.full(len(turn), -1, dtype=np.int32))
    painter = _Painter(text, seen, companions, notes)
    for index in np.unique(turn).tolist():
        faces = np.flatnonzero(turn == index)
        name = said.materials[index][1] if index >= 0 else ""
        material = library.get(name)
        if material is not None and material.opacity < OPAQUE_FROM:
            notes.add("transparent", f"faces of materials less opaque than {OPAQUE_FROM} were taken as air", len(faces))
            continue
        if material is not None and painter.textured(faces, material):
            continue
        vivid = faces[coloured[faces]]
        painter.vivid(vivid, name or "vertex colours", material)
        plain = faces[~coloured[faces]]
        if len(plain):
            seen.materials[plain] = _material_id(name, library, table, notes, len(plain))
    return seen


def coat_of(
    said: Statements,
    seen: Appearance,
    uv: NDArray[np.float64] | None,
    corners: NDArray[np.int64],
    faces: NDArray[np.int64],
) -> Coat | None:
    """Return the paint of triangles; None where none of them is painted.

    Parameters
    ----------
    said, seen
        The file, and how its faces look.
    uv
        float64, shape (corners of the file, 2), v upwards; None where no face is textured.
    corners
        int64, shape (T, 3): each triangle's corners, among all corners of the file's faces.
    faces
        int64, shape (T,): its face.
    """
    rows = seen.rows[faces]
    if not (rows >= 0).any():
        return None
    laid = np.zeros((len(rows), 3, 2))
    colours = np.ones((len(rows), 3, 4), dtype=np.float32)
    for row, (paint, layout) in enumerate(zip(seen.paints, seen.layouts, strict=True)):
        here = rows == row
        if paint.texture is None and said.colours is not None:
            stored = np.round(said.colours[said.corners[corners[here]]] * 255.0).astype(np.uint8)
            colours[here, :, :3] = LINEAR_OF_SRGB8[stored]
        elif layout is not None and uv is not None:
            moved = uv[corners[here]] * layout.scale + layout.offset
            laid[here] = np.stack([moved[:, :, 0], 1.0 - moved[:, :, 1]], axis=2)  # an image's first row is its top
    return Coat(tuple(seen.paints), rows, laid, colours)


def _coloured_faces(said: Statements) -> NDArray[np.bool_]:
    """Whether any corner of a face has a colour other than white."""
    if said.colours is None:
        return np.zeros(len(said.counts), dtype=np.bool_)
    tinted = (said.colours != 1.0).any(axis=1)[said.corners]
    return np.asarray(np.logical_or.reduceat(tinted, np.cumsum(said.counts) - said.counts), dtype=np.bool_)


class _Painter:
    def __init__(self, text: Text, seen: Appearance, companions: Companions, notes: Notes) -> None:
        self._text = text
        self._companions = companions
        self._seen = seen
        self._notes = notes
        self._images: dict[Path, NDArray[np.uint8]] = {}
        self._rows: dict[tuple[str, bool], int] = {}

    def textured(self, faces: NDArray[np.int64], material: MtlMaterial) -> bool:
        """Paint faces with the material's texture in place of ``Kd``; False where it has none, or none to be read.

        A texture of opacity is laid as that of colour is; alone it lies on ``Kd``.
        """
        key = (material.name, True)
        if key not in self._rows:
            colour = self._image("map_Kd", material.texture, len(faces))
            opacity = self._image("map_d", material.opacity_texture, len(faces))
            layout = material.opacity_texture if colour is None else material.texture
            if layout is None or (colour is None and opacity is None):
                return False
            factor = (1.0, 1.0, 1.0)
            if colour is None:
                assert opacity is not None
                colour = np.full_like(opacity, 255)
                factor = _linear(material)
            elif opacity is not None and (material.opacity_texture or layout).placed() != layout.placed():
                self._notes.add("texture", "map_d is laid as map_Kd is: its own options are not honoured")
            wrap: Wrap = "clamp" if layout.clamp else "repeat"
            cutoff = 0.0
            if opacity is not None:
                colour, cutoff = _with_opacity(colour, opacity), OPAQUE_FROM
            paint = Paint(material.name, (*factor, 1.0), Texture(colour, (wrap, wrap)), cutoff)
            self._rows[key] = self._paint(paint, layout)
        self._seen.rows[faces] = self._rows[key]
        return True

    def _image(self, keyword: str, layout: MtlTexture | None, faces: int) -> NDArray[np.uint8] | None:
        """Return the pixels of a texture; None, noted for `faces` faces, where they are not to be had."""
        if layout is None:
            return None
        found = self._companions.find_exported(layout.name)
        if found is None:
            problem = f"texture {layout.name!r} is not beside the file; its material's own value stands in"
            self._notes.add("missing-texture", problem, faces)
            return None
        if not self._companions.allows(found):
            problem = f"texture {layout.name!r} lies outside the file's folder and was not opened"
            self._notes.add("outside", f"{problem}; {ALLOW_OUTSIDE}", faces)
            return None
        if found not in self._images:
            self._images[found] = decode_image(found.read_bytes(), self._text.path, f"{keyword} {layout.name}")
        return self._images[found]

    def vivid(self, faces: NDArray[np.int64], name: str, material: MtlMaterial | None) -> None:
        """Paint faces with their vertices' colours, times ``Kd`` where the material gives one."""
        if not len(faces):
            return
        key = (name, False)
        if key not in self._rows:
            factor = _linear(material) if material else (1.0, 1.0, 1.0)
            self._rows[key] = self._paint(Paint(name, (*factor, 1.0)), None)
        self._seen.rows[faces] = self._rows[key]

    def _paint(self, paint: Paint, layout: MtlTexture | None) -> int:
        self._seen.paints.append(paint)
        self._seen.layouts.append(layout)
        return len(self._seen.paints) - 1


def _with_opacity(colour: NDArray[np.uint8], opacity: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return an image with the alpha of another, or with its brightness where it is opaque throughout.

    The one with fewer pixels along an axis has them repeated; uint8, shape (H, W, 4) all.
    """
    alpha = opacity[:, :, 3]
    if (alpha == 255).all():
        alpha = (opacity[:, :, :3] @ np.array([299, 587, 114], np.uint32) // 1000).astype(np.uint8)
    height, width = (max(sides) for sides in zip(colour.shape[:2], alpha.shape, strict=True))
    made = _stretched(colour, height, width).copy()
    made[:, :, 3] = _stretched(alpha, height, width)
    return made


def _stretched(pixels: NDArray[np.uint8], height: int, width: int) -> NDArray[np.uint8]:
    rows, columns = np.arange(height) * pixels.shape[0] // height, np.arange(width) * pixels.shape[1] // width
    stretched: NDArray[np.uint8] = pixels[rows[:, None], columns]
    return stretched


def _linear(material: MtlMaterial) -> tuple[float, float, float]:
    red, green, blue = LINEAR_OF_SRGB8[list(_display(material))].tolist()
    return red, green, blue


def _display(material: MtlMaterial) -> tuple[int, int, int]:
    red, green, blue = (round(255 * min(max(value, 0.0), 1.0)) for value in material.colour or (1.0, 1.0, 1.0))
    return red, green, blue


def _material_id(name: str, library: dict[str, MtlMaterial], table: MaterialTable, notes: Notes, faces: int) -> int:
    if not name:
        return table.default(notes, faces)
    if name not in library:
        notes.add("missing-material", "materials that no library describes got the default colour", faces)
        return table.id_of(name, name, DEFAULT_COLOUR)
    if library[name].colour is None:
        notes.add("material-colour", "materials without Kd got the default colour", faces)
        return table.id_of(name, name, DEFAULT_COLOUR)
    return table.id_of(name, name, _display(library[name]))


def _libraries(companions: Companions, said: Statements, notes: Notes) -> dict[str, MtlMaterial]:
    """Return the materials of all libraries by name; the library named last wins, as if read in order."""
    library: dict[str, MtlMaterial] = {}
    seen: set[Path] = set()
    for _, argument in said.libraries:
        # One name may hold blanks, or several names may stand in one line.
        whole = companions.find_exported(argument)
        words = argument.split()
        names = [(whole, argument)] if whole else [(companions.find_exported(word), word) for word in words]
        for found, name in names:
            if found is None:
                notes.add("missing-library", f"material library {name!r} is not beside the file")
            elif not companions.allows(found):
                problem = f"material library {name!r} lies outside the file's folder and was not opened"
                notes.add("outside", f"{problem}; {ALLOW_OUTSIDE}")
            elif found not in seen:
                seen.add(found)
                library |= read_mtl(found, notes)
    return library
