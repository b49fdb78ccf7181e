"""STL, binary and ASCII."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.frames import scene_transform
from voxrt.voxelize.material_table import MaterialTable
from voxrt.voxelize.notes import Notes
from voxrt.voxelize.scene import Mesh, Scene, SceneObject
from voxrt.voxelize.weld import weld

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

# A solid's first line; its name may be empty and its end may lack the name.
_SOLID = re.compile(rb"^[ \t]*solid\b[ \t]*(?P<name>[^\r\n]*)", re.IGNORECASE | re.MULTILINE)
# Longer words are no numbers, and would each get the longest one's room in the array.
_VERTEX = re.compile(rb"vertex\s+(\S{1,64})\s+(\S{1,64})\s+(\S{1,64})(?!\S)", re.IGNORECASE)


def load_stl(path: str | Path, *, up: str | None = None, unit: float | None = None) -> Scene:
    """Read an STL file.

    Corners at exactly one place become one vertex. Normals are not used: the order of corners says what is outside.

    Parameters
    ----------
    path
        The file: binary, or ASCII with any number of solids, each of which becomes an object.
    up
        The file's up axis; None means y.
    unit
        Metres per unit of the file; None means 1.

    Raises
    ------
    AssetError
        The file cannot be read, is cut short, or has no triangles.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise AssetError(path, f"cannot be read: {error.strerror}", fix="check the path and its permissions") from None
    notes = Notes()
    solids = [(path.stem, _binary(path, data, notes))] if _is_binary(data) else _ascii(path, data)
    table = MaterialTable()
    transform = scene_transform(up, unit)
    objects = []
    for name, corners in solids:
        if not len(corners):
            notes.add("empty-mesh", "solids without triangles were left out")
            continue
        if not np.isfinite(corners).all():
            raise AssetError(path, "has a coordinate that is no number", place=f"solid {name!r}", fix="export it again")
        positions, triangles = weld(corners)
        material = table.default(notes, len(triangles))
        mesh = Mesh(positions, triangles, np.full(len(triangles), material, dtype=np.uint8))
        objects.append(SceneObject(name, mesh, transform))
    if not objects:
        raise AssetError(path, "has no triangles", fix="export it with its surface")
    return Scene(path.stem, tuple(objects), table.materials(), notes.warnings())


def _is_binary(data: bytes) -> bool:
    """Binary when the length is what the header's count says, or when it does not begin as ASCII files do.

    The word ``solid`` alone proves nothing: many exporters begin binary files with it.
    """
    if len(data) >= _HEADER and len(data) == _HEADER + 50 * int.from_bytes(data[80:84], "little"):
        return True
    head = data[:1024]
    return not (head.lstrip().lower().startswith(b"solid") and b"\0" not in head)


def _binary(path: Path, data: bytes, notes: Notes) -> NDArray[np.float64]:
    """Corners, float64, shape (3 * T, 3)."""
    if len(data) < _HEADER:
        problem = "is empty" if not data else "is too short for an STL file"
        raise AssetError(path, problem, fix="export it again")
    count = int.from_bytes(data[80:84], "little")
    stored = (len(data) - _HEADER) // 50
    if stored < count:
        raise AssetError(path, f"is cut short: {stored} of {count} triangles", fix="copy or export it again")
    notes.add("trailing-bytes", "bytes after the last triangle were ignored", len(data) - _HEADER - 50 * count)
    records = np.frombuffer(data, dtype=_RECORD, count=count, offset=_HEADER)
    # Two exporters keep a colour of 15 bits here, each in its own way; nothing tells them apart.
    notes.add("stl-colour", "triangle attributes (colours) are not honoured", int((records["attribute"] != 0).sum()))
    return records["corners"].reshape(-1, 3).astype(np.float64)


def _ascii(path: Path, data: bytes) -> list[tuple[str, NDArray[np.float64]]]:
    """Each solid's name, once, and corners (float64, shape (3 * T, 3))."""
    # `endsolid` begins no solid: the pattern wants the word at the line's beginning.
    heads = list(_SOLID.finditer(data))
    solids: list[tuple[str, NDArray[np.float64]]] = []
    used: set[str] = set()
    for head, end in zip(heads, [*(head.start() for head in heads[1:]), len(data)], strict=True):
        stem = head["name"].decode("utf-8", errors="replace").strip() or path.stem
        name, number = stem, 2
        while name in used:
            name, number = f"{stem} ({number})", number + 1
        used.add(name)
        body = data[head.end() : end]
        words = _VERTEX.findall(body)
        if len(words) % 3 or len(words) // 3 != len(re.findall(rb"\bendfacet\b", body, re.IGNORECASE)):
            raise AssetError(path, "has a facet that is no triangle", place=f"solid {name!r}", fix="export it again")
        try:
            corners = np.array(words, dtype=np.bytes_).astype(np.float64).reshape(-1, 3)
        except ValueError as error:
            raise AssetError(path, f"has a vertex that is no number: {error}", place=f"solid {name!r}") from None
        solids.append((name, corners))
    return solids
