"""The last step of loading: a material for each paint, and no triangles that are air."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import isqrt
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from voxrt.voxelize.colour import srgb_from_linear
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.paint import Coat, centroids, remaining, shade
from voxrt.voxelize.palette import quantize
from voxrt.voxelize.scene import MATERIAL_LIMIT, Mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.material_table import MaterialTable
    from voxrt.voxelize.notes import Notes
    from voxrt.voxelize.paint import Paint

_SAMPLED_TRIANGLES = 1 << 10
_SAMPLES = 1 << 12

# A paint's name, whether it is a mirror, and its sRGB colour where it is the same all over.
_Key: TypeAlias = tuple[str, bool, tuple[int, int, int] | None]


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

    positions: NDArray[np.float64]
    triangles: NDArray[np.int32]
    materials: NDArray[np.uint8]
    coat: Coat | None = None


@dataclass(eq=False, slots=True)
class _Wearer:
    """The triangles that share a material, in all meshes."""

    faces: list[tuple[int, NDArray[np.intp]]] = field(default_factory=list)
    light: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    area: float = 0.0


def finish(unfinished: Sequence[Unfinished], table: MaterialTable, notes: Notes) -> list[Mesh]:
    """Give painted triangles the material of their paint, in its mean colour, and drop those that are air.

    Paint of one colour is no paint any more afterwards.

    Parameters
    ----------
    unfinished
        All meshes of the scene.
    table
        The scene's materials; those of paints are appended.
    notes
        Where cut-away triangles are counted.

    Returns
    -------
    A mesh for each, maybe without triangles.

    Raises
    ------
    DoesNotFitError
        The uniform materials leave no id to the painted surfaces.
    """
    wearers: dict[_Key, _Wearer] = {}
    materials = [one.materials.copy() for one in unfinished]
    coats = [one.coat for one in unfinished]
    for at, one in enumerate(unfinished):
        if one.coat is None:
            continue
        solid = remaining(one.coat)
        cut = int(((one.coat.rows >= 0) & ~solid).sum())
        notes.add("transparent", "painted faces that are transparent all over are air", cut)
        rows = np.where(solid, one.coat.rows, -1).astype(np.int32)
        for row, paint in enumerate(one.coat.paints):
            faces = np.flatnonzero(rows == row)
            if len(faces):
                colour = _only_colour(one.coat, paint, faces)
                wearer = wearers.setdefault((paint.name, paint.mirror, colour), _Wearer())
                wearer.faces.append((at, faces))
                _add_light(wearer, one, one.coat, paint, faces)
                if colour is not None:
                    rows[faces] = -1
        coats[at] = replace(one.coat, rows=rows) if (rows >= 0).any() else None
    for wearer, number in zip(wearers.values(), _numbers(wearers, table), strict=True):
        for at, faces in wearer.faces:
            materials[at][faces] = number
    return [_mesh(one, own, coat) for one, own, coat in zip(unfinished, materials, coats, strict=True)]


def _only_colour(coat: Coat, paint: Paint, faces: NDArray[np.intp]) -> tuple[int, int, int] | None:
    """Return the sRGB colour of paint that is the same on all of some triangles, else None."""
    first = coat.colours[faces[0], 0]
    if paint.texture is not None or not (coat.colours[faces] == first).all():
        return None
    red, green, blue = srgb_from_linear(first[:3].astype(np.float64) * paint.factor[:3]).tolist()
    return red, green, blue


def _add_light(wearer: _Wearer, one: Unfinished, coat: Coat, paint: Paint, faces: NDArray[np.intp]) -> None:
    """Add the mean colour of some triangles, from samples, by their area."""
    some = faces[:: -(-len(faces) // _SAMPLED_TRIANGLES)]
    weights = centroids(isqrt(_SAMPLES // len(some)))
    uv, mixed = weights @ coat.uv[some], weights @ coat.colours[some].astype(np.float64)
    texture = replace(paint.texture, nearest=True) if paint.texture is not None else None
    found = shade(paint, texture, uv.reshape(-1, 2), mixed.reshape(-1, 4))
    areas = _areas(one, some)
    share = np.repeat(areas / (areas.max() or 1.0) + 1e-9, len(weights)) * (1e-9 + (found[:, 3] >= paint.cutoff))
    area = float(areas.sum()) * len(faces) / len(some)
    wearer.light += share @ found[:, :3] / share.sum() * (area + 1e-300)
    wearer.area += area + 1e-300


def _numbers(wearers: dict[_Key, _Wearer], table: MaterialTable) -> list[int]:
    """Append the materials of paints to `table`; return their ids. Paints that are too many share some."""
    free = MATERIAL_LIMIT - (len(table) - 1)
    if free < 1 and wearers:
        raise DoesNotFitError(
            f"the uniform materials leave none of the {MATERIAL_LIMIT} to the painted surfaces; merge some in the asset"
        )
    if any(colour is None for _, _, colour in wearers):
        free = -(-free // 2)  # the rest is for shades
    colours = srgb_from_linear(np.array([one.light / one.area for one in wearers.values()]).reshape(-1, 3))
    if len(wearers) <= free:
        found = [tuple(colour) for colour in colours.tolist()]
        keys: list[object] = list(wearers)
    else:
        palette, rows = quantize(colours, np.array([one.area for one in wearers.values()]), free)
        found = [tuple(palette[row].tolist()) for row in rows]
        keys = [(int(row), mirror) for row, (_, mirror, _) in zip(rows, wearers, strict=True)]
    return [
        table.id_of(("paint", key), name, colour, mirror=mirror)
        for key, (name, mirror, _), colour in zip(keys, wearers, found, strict=True)
    ]


def _mesh(one: Unfinished, materials: NDArray[np.uint8], coat: Coat | None) -> Mesh:
    solid = materials != 0
    if solid.all():
        return Mesh(one.positions, one.triangles, materials, coat)
    if coat is not None:
        coat = Coat(coat.paints, coat.rows[solid], coat.uv[solid], coat.colours[solid])
    triangles = one.triangles[solid]
    used = np.zeros(len(one.positions), dtype=np.bool_)  # a vertex of air must not stretch the scene's bounds
    used[triangles] = True
    rows = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return Mesh(one.positions[used], rows[triangles], materials[solid], coat)


def _areas(one: Unfinished, faces: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the areas of some triangles, scaled to the mesh so that nothing leaves the range of numbers."""
    scale = float(np.abs(one.positions).max(initial=0.0)) or 1.0
    corners = one.positions[one.triangles[faces]] / scale
    along, across = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    dots = [np.einsum("ti,ti->t", p, q) for p, q in ((along, along), (across, across), (along, across))]
    areas: NDArray[np.float64] = np.sqrt(np.maximum(dots[0] * dots[1] - dots[2] ** 2, 0.0)) * min(scale, 1e100) ** 2
    return areas
