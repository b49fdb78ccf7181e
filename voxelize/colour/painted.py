"""The last step of loading: a material for each paint, and no triangles that are air."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import isqrt
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from voxrt.voxelize.colour.paint import Coat, centroids, remaining, shade
from voxrt.voxelize.colour.palette import quantize
from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.scene import MATERIAL_LIMIT, Mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.colour.material_table import MaterialTable
    from voxrt.voxelize.colour.paint import Paint
    from voxrt.voxelize.notes import Notes

_SAMPLED_TRIANGLES = 1 << 10
_SAMPLES = 1 << 12

_Key: TypeAlias = tuple[str, bool]  # a paint's name and whether it is a mirror


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


@dataclass(eq=False, slots=True)
class _Wearers:
    """The triangles that wear paint of one name.

    Attributes
    ----------
    faces
        The number of a mesh, and its triangles.
    colours
        The sRGB colours that paint has where it is the same all over a mesh's triangles; else None among them.
    light, area
        The mean colour (linear) times the area; and the area.
    """

    faces: list[tuple[int, NDArray[np.intp]]] = field(default_factory=list)
    colours: set[tuple[int, int, int] | None] = field(default_factory=set)
    light: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    area: float = 0.0

    @property
    def uniform(self) -> bool:
        """Whether all of it has one colour."""
        return len(self.colours) == 1 and None not in self.colours


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
    painted: dict[_Key, _Wearers] = {}
    materials = [one.materials.copy() for one in unfinished]
    rows = [one.coat.rows.copy() if one.coat is not None else None for one in unfinished]
    for at, one in enumerate(unfinished):
        if one.coat is None:
            continue
        solid = remaining(one.coat)
        cut = int(((one.coat.rows >= 0) & ~solid).sum())
        notes.add("transparent", "painted faces that are transparent all over are air", cut)
        for row, paint in enumerate(one.coat.paints):
            faces = np.flatnonzero(solid & (one.coat.rows == row))
            if len(faces):
                wearers = painted.setdefault((paint.name, paint.mirror), _Wearers())
                wearers.faces.append((at, faces))
                wearers.colours.add(_only_colour(one.coat, paint, faces))
                _add_light(wearers, one, one.coat, paint, faces)
    for wearers, number in zip(painted.values(), _numbers(painted, table), strict=True):
        for at, faces in wearers.faces:
            materials[at][faces] = number
            own = rows[at]
            if wearers.uniform and own is not None:
                own[faces] = -1
    return [_mesh(*one) for one in zip(unfinished, materials, rows, strict=True)]


def _only_colour(coat: Coat, paint: Paint, faces: NDArray[np.intp]) -> tuple[int, int, int] | None:
    """Return the sRGB colour of paint that is the same on all of some triangles, else None."""
    first = coat.colours[faces[0], 0]
    if paint.texture is not None or not (coat.colours[faces] == first).all():
        return None
    red, green, blue = srgb_from_linear(first[:3].astype(np.float64) * paint.factor[:3]).tolist()
    return red, green, blue


def _add_light(wearers: _Wearers, one: Unfinished, coat: Coat, paint: Paint, faces: NDArray[np.intp]) -> None:
    """Add the mean colour of some triangles, from samples, by their area."""
    some = faces[:: -(-len(faces) // _SAMPLED_TRIANGLES)]
    weights = centroids(isqrt(_SAMPLES // len(some)))
    uv, mixed = weights @ coat.uv[some], weights @ coat.colours[some].astype(np.float64)
    texture = replace(paint.texture, nearest=True) if paint.texture is not None else None
    found = shade(paint, texture, uv.reshape(-1, 2), mixed.reshape(-1, 4))
    areas = _areas(one, some)
    share = np.repeat(areas / (areas.max() or 1.0) + 1e-9, len(weights)) * (1e-9 + (found[:, 3] >= paint.cutoff))
    area = float(areas.sum()) * len(faces) / len(some)
    wearers.light += share @ found[:, :3] / share.sum() * (area + 1e-300)
    wearers.area += area + 1e-300


def _numbers(painted: dict[_Key, _Wearers], table: MaterialTable) -> list[int]:
    """Append the materials of paints to `table`; return their ids. Paints that are too many share some."""
    free = MATERIAL_LIMIT - (len(table) - 1)
    if free < 1 and painted:
        raise DoesNotFitError(
            f"the uniform materials leave none of the {MATERIAL_LIMIT} to the painted surfaces; merge some in the asset"
        )
    if not all(wearers.uniform for wearers in painted.values()):
        free = -(-free // 2)  # the rest is for shades
    means = srgb_from_linear(np.array([one.light / one.area for one in painted.values()]).reshape(-1, 3))
    colours = [next(iter(one.colours)) or mean for one, mean in zip(painted.values(), means.tolist(), strict=True)]
    keys: list[object] = list(painted)
    if len(painted) > free:
        palette, rows = quantize(means, np.array([one.area for one in painted.values()]), free)
        colours = palette[rows].tolist()
        keys = [(int(row), mirror) for row, (_, mirror) in zip(rows, painted, strict=True)]
    return [
        table.id_of(("paint", key), name, (red, green, blue), mirror=mirror)
        for key, (name, mirror), (red, green, blue) in zip(keys, painted, colours, strict=True)
    ]


def _mesh(one: Unfinished, materials: NDArray[np.uint8], rows: NDArray[np.int32] | None) -> Mesh:
    coat = None
    if one.coat is not None and rows is not None and (rows[materials != 0] >= 0).any():
        coat = replace(one.coat, rows=rows)
    solid = materials != 0
    if solid.all():
        return Mesh(one.positions, one.triangles, materials, coat)
    if coat is not None:
        coat = Coat(coat.paints, coat.rows[solid], coat.uv[solid], coat.colours[solid])
    triangles = one.triangles[solid]
    used = np.zeros(len(one.positions), dtype=np.bool_)  # a vertex of air must not stretch the scene's bounds
    used[triangles] = True
    moved = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return Mesh(one.positions[used], moved[triangles], materials[solid], coat)


def _areas(one: Unfinished, faces: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the areas of some triangles, scaled to the mesh so that nothing leaves the range of numbers."""
    scale = float(np.abs(one.positions).max(initial=0.0)) or 1.0
    corners = one.positions[one.triangles[faces]].astype(np.float64) / scale
    along, across = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    dots = [np.einsum("ti,ti->t", p, q) for p, q in ((along, along), (across, across), (along, across))]
    areas: NDArray[np.float64] = np.sqrt(np.maximum(dots[0] * dots[1] - dots[2] ** 2, 0.0)) * min(scale, 1e100) ** 2
    return areas
