"""The statements of an OBJ file: vertices, faces, and the object and material of each face."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.colour_range import clamped
from voxrt.voxelize.formats.obj.text import Text, index_rows, real_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.warning_log import WarningLog


# Keywords of curves and free-form surfaces, which have no faces.
_FREE_FORM = frozenset(
    {
        *("vp", "deg", "bmat", "step", "cstype", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end"),
        *("con", "bzp", "bsp", "cdc", "cdp", "res", "ctech", "stech"),
    }
)
_WITHOUT_EFFECT = frozenset(
    {
        *("s", "mg", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "maplib", "usemap", "call"),
        *("csh", "version"),
    }
)


class Statements(Struct, frozen=True, eq=False):
    """The file's content, faces in authored order."""

    positions: NDArray[np.float64]  # float64, shape (V, 3), in the file's frame; NaN where a number could not be read
    # float64, shape (V, 3): sRGB of 0 … 1, white where a vertex has none; None where no vertex has one.
    colours: NDArray[np.float64] | None
    counts: NDArray[np.int64]  # int64, shape (F,): corners per face, each at least 3
    corners: NDArray[np.int64]  # int64, flat: rows of `positions`
    face_lines: NDArray[np.int64]  # int64, shape (F,): the line of each face, an index into the text's lines
    # (line, name) of each ``o``, ``g`` and ``usemtl``.
    objects: tuple[tuple[int, str], ...]
    groups: tuple[tuple[int, str], ...]
    materials: tuple[tuple[int, str], ...]
    libraries: tuple[tuple[int, str], ...]  # (line, name) of each ``mtllib``


def read_statements(text: Text, log: WarningLog) -> Statements:
    """Read all statements.

    Raise AssetError for a vertex of fewer than three numbers, a face with a corner that is not a vertex, or a file
    without faces.
    """
    first = text.buffer[text.starts]
    is_vertex, is_face = text.is_statement("v "), text.is_statement("f ")
    attribute = text.is_statement("vn") | text.is_statement("vt")
    other = np.flatnonzero(~(is_vertex | is_face | attribute | (first == ord("#")) | (first == ord("\n"))))
    vertex_lines = np.flatnonzero(is_vertex)
    face_lines = np.flatnonzero(is_face)
    positions, colours = _vertices(text, vertex_lines, log)
    named = _named(text, other, log)
    counts, corners = _faces(text, face_lines, np.cumsum(is_vertex, dtype=np.int64)[face_lines], len(positions))
    if not len(counts):
        raise AssetError(text.path, "has no faces", fix="export it with its polygons")
    keep = counts >= 3
    if not keep.all():
        log.add("degenerate-face", "faces of fewer than three corners were left out", int((~keep).sum()))
        corners, counts, face_lines = corners[np.repeat(keep, counts)], counts[keep], face_lines[keep]
    return Statements(
        positions,
        colours,
        counts,
        corners,
        face_lines,
        tuple(named["o"]),
        tuple(named["g"]),
        tuple(named["usemtl"]),
        tuple(named["mtllib"]),
    )


def texture_coordinates(text: Text, statements: Statements) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Read the texture coordinates (``vt``) of all corners.

    Return uv, float64, shape (corners, 2), v upwards and 0 where a corner has none, and whether all corners of a face
    have coordinates: bool, shape (F,). Raise AssetError where a corner refers to coordinates that do not exist.
    """
    is_texture = text.is_statement("vt")
    values, widths = real_rows(text, np.flatnonzero(is_texture), 2)
    begins = np.cumsum(widths) - widths
    stored = np.zeros((len(widths), 2))
    for column in range(2):  # v is 0 where a line has u alone
        wide = widths > column
        stored[wide, column] = values[begins[wide] + column]
    numbers, counts, rows, is_wrong = _attribute_rows(text, statements, 1, is_texture)
    wrong = np.flatnonzero(is_wrong)
    if len(wrong):
        face = int(np.searchsorted(np.cumsum(counts), wrong[0], side="right"))
        problem = f"texture coordinate {numbers[wrong[0]]} of a face does not exist: the file has {len(stored)}"
        raise AssetError(text.path, problem, place=text.place(int(statements.face_lines[face])), fix="export it again")
    missing = numbers == 0
    uv = np.zeros((len(rows), 2))
    uv[~missing] = stored[rows[~missing]]
    missing |= ~np.isfinite(uv).all(axis=1)
    uv[missing] = 0.0
    return uv, ~np.logical_or.reduceat(missing, np.cumsum(counts) - counts)


_IGNORED = "normals that cannot be read, or do not exist, were ignored"


def read_normals(
    text: Text, statements: Statements, log: WarningLog
) -> tuple[NDArray[np.float64], NDArray[np.int32]] | None:
    """Read the normals of all corners; None where the file has none.

    Return the vectors, float64, shape (N, 3), NaN where a number could not be read, and the row of each corner of the
    faces, int32, -1 for a corner without a normal.
    """
    is_normal = text.is_statement("vn")
    lines = np.flatnonzero(is_normal)
    if not len(lines):
        return None
    values, widths = real_rows(text, lines, 2)
    if (widths != 3).any():
        log.add("normals", _IGNORED, int((widths != 3).sum()))
        return None
    try:
        _, _, rows, wrong = _attribute_rows(text, statements, 2, is_normal)
    except AssetError:
        log.add("normals", _IGNORED)
        return None
    log.add("normals", _IGNORED, int(wrong.sum()))
    rows[wrong] = -1
    return values.reshape(-1, 3), rows.astype(np.int32)


def _attribute_rows(
    text: Text, statements: Statements, field: int, is_attribute: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
    """Return the numbers in a field of all corners, corners per face, rows of the attribute, and which do not exist."""
    numbers, counts = index_rows(text, statements.face_lines, 1, field)
    before = np.repeat(np.cumsum(is_attribute)[statements.face_lines], counts)
    rows = np.where(numbers < 0, before + numbers, numbers - 1)
    return numbers, counts, rows, (numbers != 0) & ((rows < 0) | (rows >= np.count_nonzero(is_attribute)))


_WITHOUT_COLOUR = (
    "vertices have no colour, beside others that have one: they count as white; faces of such alone keep their material"
)


def _vertices(
    text: Text, lines: NDArray[np.int64], log: WarningLog
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    values, counts = real_rows(text, lines, 1)
    short = np.flatnonzero(counts < 3)
    if len(short):
        raise AssetError(
            text.path, "a vertex needs three numbers", place=text.place(lines[short[0]]), fix="repair the vertex"
        )
    begins = np.cumsum(counts) - counts
    log.add("vertex-numbers", "numbers after a vertex's place and colour were left out", _left_out(values, counts))
    coloured = counts >= 6
    colours = None
    if coloured.any():
        log.add("vertex-colour", _WITHOUT_COLOUR, int((~coloured).sum()))
        colours = np.ones((len(counts), 3))
        # Numbers four to six, as in MeshLab, Blender, three.js and tinyobjloader; what follows differs between them.
        colours[coloured] = values[begins[coloured, None] + np.arange(3, 6)]
        broken = ~np.isfinite(colours).all(axis=1)
        log.add("vertex-colour", "vertex colours that are not numbers were taken as black", int(broken.sum()))
        colours[broken] = 0.0
        colours = clamped(colours, log)
    if len(counts) and (counts == counts[0]).all():
        return np.ascontiguousarray(values.reshape(len(counts), -1)[:, :3]), colours
    return values[begins[:, None] + np.arange(3)], colours


def _left_out(values: NDArray[np.float64], counts: NDArray[np.int64]) -> int:
    """Return how many vertices have numbers that are not read; a fourth number is a weight, and 1 says nothing."""
    weights = values[(np.cumsum(counts) - counts)[counts == 4] + 3]
    return int((counts == 5).sum() + (counts > 6).sum() + (weights != 1.0).sum())


def _faces(
    text: Text, lines: NDArray[np.int64], vertices_before: NDArray[np.int64], vertices: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the corners per face, and their vertices as rows; negative numbers count back from the face."""
    numbers, counts = index_rows(text, lines, 1, 0)
    corners = numbers
    negative = corners < 0
    if negative.any():
        corners = np.where(negative, corners + np.repeat(vertices_before, counts), corners - 1)
    else:
        corners = corners - 1
    wrong = np.flatnonzero((corners < 0) | (corners >= vertices))
    if len(wrong):
        face = int(np.searchsorted(np.cumsum(counts), wrong[0], side="right"))
        raise AssetError(
            text.path,
            f"vertex {numbers[wrong[0]]} of a face does not exist: the file has {vertices}",
            place=text.place(lines[face]),
            fix="export it again",
        )
    return counts, corners


def _named(text: Text, lines: NDArray[np.int64], log: WarningLog) -> dict[str, list[tuple[int, str]]]:
    named: dict[str, list[tuple[int, str]]] = {"o": [], "g": [], "usemtl": [], "mtllib": []}
    for line in lines.tolist():
        keyword, argument = text.statement(line)
        if keyword in named:
            named[keyword].append((line, argument))
        elif keyword in ("l", "p"):
            log.add("no-area", "lines and points were left out: they have no area")
        elif keyword in _FREE_FORM:
            log.add("free-form", "curves and free-form surfaces were left out; export them as polygons")
        elif keyword and keyword not in _WITHOUT_EFFECT:
            log.add("unknown-statement", "unknown statements were ignored")
    return named
