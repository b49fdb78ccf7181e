"""The last step of loading: a palette for painted triangles, and no triangles that are air."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.paint import Coat, mean_colours
from voxrt.voxelize.palette import quantize
from voxrt.voxelize.scene import MATERIAL_LIMIT, Mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.material_table import MaterialTable
    from voxrt.voxelize.notes import Notes

PALETTE_SIZE = 64
"""How many colours painted surfaces get, where the materials leave as many."""


@dataclass(frozen=True, eq=False, slots=True)
class Unfinished:
    """A mesh whose painted triangles have no material yet.

    Attributes
    ----------
    positions, triangles
        As in :class:`~voxrt.voxelize.scene.Mesh`.
    materials
        uint8, shape (T,): material ids; 0 where a triangle is air, or painted.
    coat
        The paint; None where there is none.
    """

    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]
    materials: NDArray[np.uint8]
    coat: Coat | None = None


def finish(unfinished: Sequence[Unfinished], table: MaterialTable, notes: Notes) -> list[Mesh]:
    """Give painted triangles the palette entry nearest to their mean colour and drop those that are air.

    Parameters
    ----------
    unfinished
        All meshes of the scene: they share one palette.
    table
        The scene's materials; the palette is appended.
    notes
        Where painted and cut-away triangles are counted.

    Returns
    -------
    A mesh for each, maybe without triangles.

    Raises
    ------
    DoesNotFitError
        The uniform materials leave no id to the palette.
    """
    means = [mean_colours(one.coat) if one.coat is not None else None for one in unfinished]
    painted = [
        np.zeros(len(one.triangles), dtype=np.bool_)
        if mean is None or one.coat is None
        else mean[1] & (one.coat.rows >= 0)
        for one, mean in zip(unfinished, means, strict=True)
    ]
    ids = _palette(unfinished, means, painted, table)
    count = int(sum(len(part) for part in ids))
    notes.add("painted", "faces with a texture or vertex colours took the nearest palette colour to their mean", count)
    finished = []
    for one, faces, own in zip(unfinished, painted, ids, strict=True):
        if one.coat is not None:
            cut = int(((one.coat.rows >= 0) & ~faces).sum())
            notes.add("transparent", "painted faces that are transparent all over are air", cut)
        materials = one.materials.copy()
        materials[faces] = own
        solid = materials != 0
        finished.append(_mesh(one, materials, solid))
    return finished


def _mesh(one: Unfinished, materials: NDArray[np.uint8], solid: NDArray[np.bool_]) -> Mesh:
    if solid.all():
        return Mesh(one.positions, one.triangles, materials, one.coat)
    coat = one.coat
    if coat is not None:
        coat = Coat(coat.paints, coat.rows[solid], coat.uv[solid], coat.colours[solid])
    triangles = one.triangles[solid]
    used = np.zeros(len(one.positions), dtype=np.bool_)  # a vertex of air must not stretch the scene's bounds
    used[triangles] = True
    rows = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return Mesh(one.positions[used], rows[triangles], materials[solid], coat)


def _palette(
    unfinished: Sequence[Unfinished],
    means: list[tuple[NDArray[np.float64], NDArray[np.bool_]] | None],
    painted: list[NDArray[np.bool_]],
    table: MaterialTable,
) -> list[NDArray[np.uint8]]:
    """Append the palette to `table`; return the painted triangles' ids, mesh by mesh."""
    sizes = [int(faces.sum()) for faces in painted]
    if not sum(sizes):
        return [np.zeros(0, dtype=np.uint8) for _ in sizes]
    colours = np.concatenate([mean[0][faces] for mean, faces in zip(means, painted, strict=True) if mean is not None])
    areas = np.concatenate([_areas(one, faces) for one, faces in zip(unfinished, painted, strict=True)])
    labels: dict[tuple[str, bool], int] = {}
    owners = np.concatenate(
        [
            np.array([labels.setdefault((paint.name, paint.mirror), len(labels)) for paint in one.coat.paints])[
                one.coat.rows[faces]
            ]
            for one, faces in zip(unfinished, painted, strict=True)
            if one.coat is not None
        ]
    )
    ids = np.zeros(len(colours), dtype=np.uint8)
    for mirror in sorted({mirror for _, mirror in labels}):
        names = [name if kind == mirror else "" for name, kind in labels]
        faces = np.array([kind == mirror for _, kind in labels])[owners]
        ids[faces] = _entries(colours[faces], areas[faces], owners[faces], names, table, mirror=mirror)
    return np.split(ids, np.cumsum(sizes)[:-1])


def _entries(
    colours: NDArray[np.float64],
    areas: NDArray[np.float64],
    owners: NDArray[np.int64],
    names: list[str],
    table: MaterialTable,
    *,
    mirror: bool,
) -> NDArray[np.uint8]:
    """Append a palette of `colours` to `table`, each named after the paint it covers most of; return their ids."""
    free = MATERIAL_LIMIT - (len(table) - 1)
    if free < 1:
        raise DoesNotFitError(
            f"the uniform materials leave none of the {MATERIAL_LIMIT} to the painted surfaces; merge some in the asset"
        )
    palette, rows = quantize(colours, areas, min(PALETTE_SIZE, free))
    cover = np.bincount(rows.astype(np.int64) * len(names) + owners, areas, minlength=len(palette) * len(names))
    most = cover.reshape(len(palette), len(names)).argmax(axis=1).tolist()
    by_row = np.zeros(len(palette), dtype=np.uint8)
    for row, (red, green, blue) in enumerate(palette.tolist()):
        name = f"{names[most[row]]} #{red:02x}{green:02x}{blue:02x}"
        key = ("palette", red, green, blue, mirror)
        by_row[row] = table.id_of(key, name, (red, green, blue), mirror=mirror)
    return by_row[rows]


def _areas(one: Unfinished, faces: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the areas of some triangles, scaled to the mesh so that nothing leaves the range of numbers."""
    scale = float(np.abs(one.positions).max(initial=0.0)) or 1.0
    corners = one.positions[one.triangles[faces]].astype(np.float64) / scale
    along, across = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    dots = [np.einsum("ti,ti->t", p, q) for p, q in ((along, along), (across, across), (along, across))]
    areas: NDArray[np.float64] = np.sqrt(np.maximum(dots[0] * dots[1] - dots[2] ** 2, 0.0)) * min(scale, 1e100) ** 2
    return areas
