"""STL, binary and ASCII."""

from __future__ import annotations

import codecs
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import asset_name, read_asset
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.scene_frame import FARTHEST, in_range, scene_transform
from voxrt.voxelize.formats.stl.text import ascii_solids
from voxrt.voxelize.formats.text_encoding import ascii_compatible, is_marked_wide
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def load_stl(path: str | Path, *, up: str | None = None, unit: float | None = None) -> Scene:
    """Read an STL file.

    Equal corners become one vertex. Normals are ignored: the order of corners defines the outside.

    Parameters
    ----------
    path
        The file: binary, or ASCII with any number of solids, each of which becomes an object.
    up
        The file's up axis; None for z, as printers and CAD programs mean it.
    unit
        Metres per unit of the file; None for 1.

    Raises
    ------
    AssetError
        The file cannot be read, is cut short, or has no triangles.
    """
    path = Path(path)
    data = read_asset(path)
    log = WarningLog()
    facet_colours = None
    if is_marked_wide(data) and not _has_binary_length(data):
        data = ascii_compatible(path, data)
    if _is_binary(data):
        corners, facet_colours = _binary(path, data, log)
        solids = [(asset_name(path), corners)]
    else:
        solids = ascii_solids(path, data.removeprefix(codecs.BOM_UTF8))
    table = MaterialTable()
    transform = scene_transform(up or "z", unit)
    objects = []
    for name, corners in solids:
        if not len(corners):
            log.add("empty-mesh", "solids without triangles were left out")
            continue
        if not in_range(corners).all():
            raise AssetError(
                path,
                f"has a coordinate that is not a number below {FARTHEST:g}",
                place=f"solid {name!r}",
                fix="export it again",
            )
        positions, triangles = weld(corners)
        appearance = None if facet_colours is None else _appearance(facet_colours)
        bare = np.ones(len(triangles), dtype=np.bool_) if appearance is None else appearance.rows < 0
        materials = np.zeros(len(triangles), dtype=np.uint8)
        if bare.any():
            materials[bare] = table.default(None if appearance is None else log, int(bare.sum()))
        (mesh,) = assign_materials([LoadedMesh(positions, triangles, materials, appearance)], table, log)
        objects.append(SceneObject(name, mesh, transform))
    if not objects:
        raise AssetError(path, "has no triangles", fix="export it with its surface")
    return Scene(asset_name(path), tuple(objects), table.materials(), log.warnings())


def _is_binary(data: bytes) -> bool:
    """Tell whether a file is binary: its length matches its count, or no line of its beginning is that of a solid.

    The word ``solid`` alone is no sign of an ASCII file: many exporters begin binary files with it. Lines before it are
    comments of some writers.
    """
    if _has_binary_length(data):
        return True
    head = data[:1024]
    return b"\0" in head or re.search(rb"^(\xef\xbb\xbf)?[ \t]*solid", head, re.IGNORECASE | re.MULTILINE) is None


def _has_binary_length(data: bytes) -> bool:
    return len(data) >= _HEADER and len(data) == _HEADER + 50 * int.from_bytes(data[80:84], "little")


def _binary(
    path: Path, data: bytes, log: WarningLog
) -> tuple[NDArray[np.float64], tuple[NDArray[np.uint8], NDArray[np.bool_]] | None]:
    """Return the corners, float64, shape (3 * T, 3), and the facets' colours; None where there are none."""
    if len(data) < _HEADER:
        problem = "is empty" if not data else "is too short for an STL file"
        raise AssetError(path, problem, fix="export it again")
    count = int.from_bytes(data[80:84], "little")
    stored = (len(data) - _HEADER) // 50
    if stored < count:
        raise AssetError(path, f"is cut short: {stored} of {count} triangles", fix="copy or export it again")
    log.add("trailing-bytes", "bytes after the last triangle were ignored", len(data) - _HEADER - 50 * count)
    records = np.frombuffer(data, dtype=_RECORD, count=count, offset=_HEADER)
    corners = records["corners"].reshape(-1, 3).astype(np.float64)
    return corners, _facet_colours(data[:80], records["attribute"], log)


def _facet_colours(
    header: bytes, attributes: NDArray[np.uint16], log: WarningLog
) -> tuple[NDArray[np.uint8], NDArray[np.bool_]] | None:
    """Return 15-bit colours as uint8 (T, 3), sRGB, and which facets have one; None where no facet has.

    Materialise Magics writes COLOR= and the colour of the object into the header, and red in the lowest bits of those
    facets that have a colour of their own, whose highest bit is clear. VisCAM and SolidView write blue in the lowest
    bits, and set the highest bit of facets that have a colour. Source: Wikipedia, "STL (file format)".
    """
    low, middle, high = ((attributes >> shift & 31).astype(np.uint32) for shift in (0, 5, 10))
    flagged = attributes >= 1 << 15
    at = header.find(b"COLOR=")
    if 0 <= at <= len(header) - 10:
        # Exporters that leave all attributes 0 mean the object's colour, not black facets.
        flagged = flagged | ~attributes.any()
        colours = np.stack([low, middle, high], axis=1) * 255 // 31
        colours[flagged] = list(header[at + 6 : at + 9])
        return colours.astype(np.uint8), np.ones(len(flagged), dtype=np.bool_)
    log.add(
        "stl-attribute",
        "triangle attributes that are not colours were ignored",
        int(((attributes != 0) & ~flagged).sum()),
    )
    if not flagged.any():
        return None
    return (np.stack([high, middle, low], axis=1) * 255 // 31).astype(np.uint8), flagged


def _appearance(facet_colours: tuple[NDArray[np.uint8], NDArray[np.bool_]]) -> SurfaceAppearance:
    """Return the appearance of facets with colours."""
    colours, coloured = facet_colours
    linear = np.ones((len(colours), 3, 4), dtype=np.float32)
    linear[:, :, :3] = LINEAR_OF_SRGB8[colours][:, None]
    rows = np.where(coloured, 0, -1).astype(np.int32)
    return SurfaceAppearance((Appearance("facet colours"),), rows, np.zeros((len(colours), 3, 2)), linear)


def weld(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return the distinct corners as vertices, and the triangles over them.

    `corners`, float64, shape (3 * T, 3), are those of triangle after triangle. The vertices, float64, shape (V, 3), are
    in order of first appearance; the triangles are int32, shape (T, 3).
    """
    exact = np.ascontiguousarray(corners + 0.0)  # -0 becomes 0, which it equals
    _, first, inverse = np.unique(_hashes(exact), return_index=True, return_inverse=True)
    if not np.array_equal(exact[first][inverse], exact):  # two positions share a hash: compare all bytes, which is slow
        keys = exact.view(np.dtype((np.void, 24))).ravel()
        _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return exact[first[order]], rank[inverse].reshape(-1, 3).astype(np.int32)


def _hashes(exact: NDArray[np.float64]) -> NDArray[np.uint64]:
    """Mix the bits of each row: odd multipliers, as in Knuth's multiplicative hashing, and shifts of the high bits."""
    bits = exact.view(np.uint64)
    mixed = np.zeros(len(exact), dtype=np.uint64)
    for column, odd in enumerate((0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)):
        mixed = (mixed ^ bits[:, column]) * np.uint64(odd)
        mixed ^= mixed >> np.uint64(29)
    return mixed
