"""The last step of loading: material ids for all triangles, and a palette for the painted ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.gltf.materials import append_named, make_table
from voxrt.voxelize.gltf.meshes import compact
from voxrt.voxelize.paint import Coat
from voxrt.voxelize.palette import quantize
from voxrt.voxelize.scene import MATERIAL_LIMIT, Material, Mesh

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from voxrt.voxelize.gltf.appearance import Dress
    from voxrt.voxelize.gltf.document import Document
    from voxrt.voxelize.gltf.materials import MaterialKey
    from voxrt.voxelize.gltf.meshes import Surface

PALETTE_SIZE = 64
"""How many colours painted surfaces get, where the materials leave as many."""


def finish_meshes(
    document: Document, dressed: list[tuple[Surface, Dress]], others: Iterable[MaterialKey]
) -> tuple[list[Mesh], tuple[Material, ...], dict[MaterialKey, int]]:
    """Give every triangle its material id and leave out those that are air.

    Parameters
    ----------
    document
        The open asset.
    dressed
        Surfaces and what they wear.
    others
        Materials in use beside them.

    Returns
    -------
    meshes, materials, ids
        A mesh for each pair of `dressed`; the scene's materials: the file's in authored order, the default material,
        then the palette of the painted triangles; and the id of each material in use.
    """
    painted = [wears.solid & _painted(wears) for _, wears in dressed]
    plain = [wears.solid & ~paint for (_, wears), paint in zip(dressed, painted, strict=True)]
    used = {
        wears.keys[row]
        for (_, wears), faces in zip(dressed, plain, strict=True)
        for row in np.flatnonzero(np.bincount(wears.rows[faces])).tolist()
    }
    table, ids = make_table(document, used.union(others))
    chosen = _palette(document, dressed, painted, table)
    meshes = []
    for (surface, wears), faces, paint, colours in zip(dressed, plain, painted, chosen, strict=True):
        materials = np.zeros(len(faces), np.uint8)
        materials[paint] = colours
        by_row = np.array([ids.get(key, 0) for key in wears.keys], np.uint8)
        materials[faces] = by_row[wears.rows[faces]]
        meshes.append(_mesh(surface, wears, materials))
    return meshes, tuple(table), ids


def _painted(wears: Dress) -> NDArray[np.bool_]:
    if wears.coat is None:
        return np.zeros(len(wears.rows), np.bool_)
    return wears.coat.rows >= 0


def _mesh(surface: Surface, wears: Dress, materials: NDArray[np.uint8]) -> Mesh:
    solid = wears.solid
    if solid.all():
        return Mesh(surface.positions, surface.triangles, materials, wears.coat)
    coat = wears.coat
    if coat is not None:
        coat = Coat(coat.paints, coat.rows[solid], coat.uv[solid], coat.colours[solid])
    return Mesh(*compact(surface.positions, surface.triangles[solid]), materials[solid], coat)


def _palette(
    document: Document, dressed: list[tuple[Surface, Dress]], painted: list[NDArray[np.bool_]], table: list[Material]
) -> list[NDArray[np.uint8]]:
    """Append the palette of the painted triangles to `table`; return their material ids, mesh by mesh."""
    chosen = [np.zeros(int(paint.sum()), np.uint8) for paint in painted]
    count = sum(map(len, chosen))
    if not count:
        return chosen
    document.warn(
        "painted", "faces with a texture or vertex colours took the nearest palette colour to their mean", count
    )
    means = np.concatenate([wears.means[paint] for (_, wears), paint in zip(dressed, painted, strict=True)])
    areas = np.concatenate([_areas(surface)[paint] for (surface, _), paint in zip(dressed, painted, strict=True)])
    owners, names, mirrors = _owners(dressed, painted)
    ids = np.zeros(count, np.uint8)
    for mirror in sorted(set(mirrors)):
        faces = np.array(mirrors)[owners] == mirror
        free = MATERIAL_LIMIT - (len(table) - 1)
        if free < 1:
            raise DoesNotFitError(
                f"{document.path}: its uniform materials leave none of the {MATERIAL_LIMIT} to its painted surfaces; "
                "give materials that look alike one name in their voxrt_material property"
            )
        palette, rows = quantize(means[faces], areas[faces], min(PALETTE_SIZE, free))
        ids[faces] = rows + len(table)
        owned = owners[faces]
        for row, colour in enumerate(palette.tolist()):
            cover = np.bincount(owned[rows == row], areas[faces][rows == row], minlength=len(names))
            red, green, blue = colour
            name = f"{names[int(cover.argmax())]} #{red:02x}{green:02x}{blue:02x}"
            append_named(table, Material(name, (red, green, blue), mirror), "mirror")
    return np.split(ids, np.cumsum([len(part) for part in chosen])[:-1])


def _owners(
    dressed: list[tuple[Surface, Dress]], painted: list[NDArray[np.bool_]]
) -> tuple[NDArray[np.int64], list[str], list[bool]]:
    """Return, for the painted triangles, their paint's number, and the name and mirror flag of each paint."""
    numbers: dict[tuple[str, bool], int] = {}
    parts = []
    for (_, wears), paint in zip(dressed, painted, strict=True):
        if wears.coat is None:
            continue
        own = [numbers.setdefault((made.name, made.mirror), len(numbers)) for made in wears.coat.paints]
        parts.append(np.array(own, np.int64)[wears.coat.rows[paint]])
    return np.concatenate(parts), [name for name, _ in numbers], [mirror for _, mirror in numbers]


def _areas(surface: Surface) -> NDArray[np.float64]:
    """Return the area of each triangle, scaled to the largest so that nothing leaves the range of numbers."""
    scale = np.abs(surface.positions).max(initial=0.0) or 1.0
    a, b, c = (surface.positions[surface.triangles[:, corner]] / scale for corner in range(3))
    areas: NDArray[np.float64] = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return areas
