"""The appearance of each face of an OBJ file: a material id, or a texture and vertex colours."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct, field

from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.formats.image_file import INSTEAD, read_image
from voxrt.voxelize.formats.obj.mtl import MtlMaterial, MtlTexture, read_mtl
from voxrt.voxelize.formats.obj.text import spellings
from voxrt.voxelize.formats.opacity import log_left_out
from voxrt.voxelize.materials import DEFAULT_COLOUR

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.colour.texture import Wrap
    from voxrt.voxelize.formats.external_files import ExternalFiles
    from voxrt.voxelize.formats.material_table import MaterialTable
    from voxrt.voxelize.formats.obj.statements import Statements
    from voxrt.voxelize.formats.obj.text import Text
    from voxrt.voxelize.warning_log import WarningLog


class FaceAppearance(Struct, eq=False):
    """The appearance of each face."""

    # uint8, shape (F,): material ids; 0 for faces that are left out, and for those with an appearance.
    materials: NDArray[np.uint8]
    rows: NDArray[np.int32]  # int32, shape (F,): indices into `entries`; -1 where a face has a plain material
    entries: list[Appearance] = field(default_factory=list)
    # How each entry scales and moves texture coordinates: ``map_Kd -s`` and ``-o``.
    image_placements: list[MtlTexture | None] = field(default_factory=list)
    left_out: dict[str, MtlMaterial] = field(default_factory=dict)  # by name: materials that are not opaque enough


def appearance_of_faces(
    text: Text,
    statements: Statements,
    external_files: ExternalFiles,
    table: MaterialTable,
    log: WarningLog,
    *,
    opaque_from: float,
) -> FaceAppearance:
    """Return the appearance of every face: the texture of its material, else its vertices' colours, else ``Kd``."""
    library = _libraries(external_files, statements, log)
    lines = np.array([line for line, _ in statements.materials], dtype=np.int64)
    turn = np.searchsorted(lines, statements.face_lines) - 1  # the last usemtl before each face; -1 for none
    coloured = _coloured_faces(statements)
    face_appearance = FaceAppearance(np.zeros(len(turn), dtype=np.uint8), np.full(len(turn), -1, dtype=np.int32))
    builder = _AppearanceBuilder(text, face_appearance, external_files, log, opaque_from=opaque_from)
    for index in (np.flatnonzero(np.bincount(turn + 1)) - 1).tolist():
        faces = np.flatnonzero(turn == index)
        name = statements.materials[index][1] if index >= 0 else ""
        name = next((one for one in spellings(name) if one in library), name)
        material = library.get(name)
        if material is not None and material.opacity < opaque_from:
            log_left_out(log, material.opacity, opaque_from, opaque_from, len(faces))
            face_appearance.left_out.setdefault(material.name, material)
            continue
        if material is not None and builder.add_textured(faces, material):
            continue
        coloured_faces = faces[coloured[faces]]
        builder.add_coloured(coloured_faces, name or "vertex colours", material)
        plain = faces[~coloured[faces]]
        if len(plain):
            face_appearance.materials[plain] = _material_id(name, library, table, log, len(plain))
    return face_appearance


def surface_appearance(
    statements: Statements,
    face_appearance: FaceAppearance,
    uv: NDArray[np.float64] | None,
    corners: NDArray[np.int64],
    faces: NDArray[np.int64],
) -> SurfaceAppearance | None:
    """Return the appearance of triangles; None where all of them have plain materials.

    `uv`, float64, shape (corners of the file, 2), points v upwards; None where no face is textured. `corners`, int64,
    shape (T, 3), are each triangle's corners among all corners of the file's faces, and `faces`, int64, shape (T,), its
    face.
    """
    rows = face_appearance.rows[faces]
    if not (rows >= 0).any():
        return None
    uv_of_corners = np.zeros((len(rows), 3, 2))
    colours = np.ones((len(rows), 3, 4), dtype=np.float32)
    for row, (appearance, placement) in enumerate(
        zip(face_appearance.entries, face_appearance.image_placements, strict=True)
    ):
        here = rows == row
        if appearance.texture is None and statements.colours is not None:
            stored = np.round(statements.colours[statements.corners[corners[here]]] * 255.0).astype(np.uint8)
            colours[here, :, :3] = LINEAR_OF_SRGB8[stored]
        elif placement is not None and uv is not None:
            moved = uv[corners[here]] * placement.scale + placement.offset
            uv_of_corners[here] = np.stack(
                [moved[:, :, 0], 1.0 - moved[:, :, 1]], axis=2
            )  # an image's first row is its top
    return SurfaceAppearance(tuple(face_appearance.entries), rows, uv_of_corners, colours)


def _coloured_faces(statements: Statements) -> NDArray[np.bool_]:
    """Tell which faces have a corner of a colour other than white."""
    if statements.colours is None:
        return np.zeros(len(statements.counts), dtype=np.bool_)
    not_white = (statements.colours != 1.0).any(axis=1)[statements.corners]
    return np.asarray(
        np.logical_or.reduceat(not_white, np.cumsum(statements.counts) - statements.counts), dtype=np.bool_
    )


class _AppearanceBuilder:
    def __init__(
        self,
        text: Text,
        face_appearance: FaceAppearance,
        external_files: ExternalFiles,
        log: WarningLog,
        *,
        opaque_from: float,
    ) -> None:
        self._text = text
        self._external_files = external_files
        self._faces = face_appearance
        self._log = log
        self._opaque_from = opaque_from
        self._images: dict[Path, NDArray[np.uint8] | None] = {}
        self._rows: dict[tuple[str, bool], int] = {}

    def add_textured(self, faces: NDArray[np.int64], material: MtlMaterial) -> bool:
        """Give faces their material's texture in place of ``Kd``; return False where there is none that can be read.

        A texture of opacity is placed as the one of colour is. Without a texture of colour it applies to ``Kd``.
        """
        key = (material.name, True)
        if key not in self._rows:
            colour = self._image("map_Kd", material.texture, material.folder, len(faces))
            opacity = self._image("map_d", material.opacity_texture, material.folder, len(faces))
            placement = material.opacity_texture if colour is None else material.texture
            if placement is None or (colour is None and opacity is None):
                return False
            factor = (1.0, 1.0, 1.0)
            if colour is None:
                assert opacity is not None
                colour = np.full_like(opacity, 255)
                factor = _linear(material)
            elif opacity is not None and (material.opacity_texture or placement).placed() != placement.placed():
                self._log.add("texture", "map_d was placed as map_Kd is: its own options were ignored")
            wrap: Wrap = "clamp" if placement.clamp else "repeat"
            cutoff = 0.0
            if opacity is not None:
                colour, cutoff = _with_opacity(colour, opacity), self._opaque_from
            appearance = Appearance(material.name, (*factor, 1.0), Texture(colour, (wrap, wrap)), cutoff)
            self._rows[key] = self._entry(appearance, placement)
        self._faces.rows[faces] = self._rows[key]
        return True

    def _image(self, keyword: str, placement: MtlTexture | None, folder: Path, faces: int) -> NDArray[np.uint8] | None:
        """Return the pixels of a texture; None, with a warning for `faces` faces, where it cannot be read.

        It is looked for beside the material library in `folder`, then beside the file.
        """
        if placement is None:
            return None
        files, name = self._external_files, placement.name
        places = [files.find_exported(one, start) for one in spellings(name) for start in (folder, None)]
        found = next((place for place in places if place is not None), None)
        found = files.reported(found, "texture", name, self._log, start=folder, count=faces, instead=INSTEAD)
        if found is None:
            return None
        if found not in self._images:
            self._images[found] = read_image(found, self._text.path, f"{keyword} {name}", self._log, faces)
        return self._images[found]

    def add_coloured(self, faces: NDArray[np.int64], name: str, material: MtlMaterial | None) -> None:
        """Give faces their vertices' colours, times ``Kd`` where the material has one."""
        if not len(faces):
            return
        key = (name, False)
        if key not in self._rows:
            factor = _linear(material) if material else (1.0, 1.0, 1.0)
            self._rows[key] = self._entry(Appearance(name, (*factor, 1.0)), None)
        self._faces.rows[faces] = self._rows[key]

    def _entry(self, appearance: Appearance, placement: MtlTexture | None) -> int:
        self._faces.entries.append(appearance)
        self._faces.image_placements.append(placement)
        return len(self._faces.entries) - 1


def _with_opacity(colour: NDArray[np.uint8], opacity: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return an image with the alpha of another; an opaque image gives its brightness as alpha.

    All are uint8, shape (H, W, 4). The smaller image is scaled up by repeating pixels.
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


def _material_id(name: str, library: dict[str, MtlMaterial], table: MaterialTable, log: WarningLog, faces: int) -> int:
    if not name:
        return table.default(log, faces)
    if name not in library:
        log.add("missing-material", "materials that no library defines got the default colour", faces)
        return table.id_of(name, name, DEFAULT_COLOUR)
    if library[name].colour is None:
        log.add("material-colour", "materials without Kd got the default colour", faces)
        return table.id_of(name, name, DEFAULT_COLOUR)
    return table.id_of(name, name, _display(library[name]))


def _libraries(external_files: ExternalFiles, statements: Statements, log: WarningLog) -> dict[str, MtlMaterial]:
    """Return the materials of all libraries by name; a later library overrides an earlier one."""
    library: dict[str, MtlMaterial] = {}
    seen: set[Path] = set()
    for _, argument in statements.libraries:
        # A line holds one name with blanks, or several names.
        whole = [(external_files.find_exported(one), one) for one in spellings(argument)]
        words = whole[-1][1].split()
        names = [one for one in whole if one[0]][:1] or [(external_files.find_exported(word), word) for word in words]
        for found, name in names:
            file = external_files.reported(found, "material library", name, log)
            if file is not None and file not in seen:
                seen.add(file)
                library |= read_mtl(file, log)
    for name, material in list(library.items()):
        for one in spellings(name):
            library.setdefault(one, material)
    return library
