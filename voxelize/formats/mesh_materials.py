"""The last step of loading: a material for each appearance; fully transparent triangles are dropped."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import isqrt
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from voxrt.voxelize.colour.appearance import SurfaceAppearance, centroids, shade, visible_triangles
from voxrt.voxelize.colour.palette import quantize
from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.materials import MATERIAL_LIMIT
from voxrt.voxelize.mesh import Mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.colour.appearance import Appearance
    from voxrt.voxelize.corner_normals import CornerNormals
    from voxrt.voxelize.formats.material_table import MaterialTable
    from voxrt.voxelize.warning_log import WarningLog

_SAMPLED_TRIANGLES = 1 << 10
_SAMPLES = 1 << 12

_Key: TypeAlias = tuple[str, bool]  # an appearance's name, and whether it is a mirror


@dataclass(frozen=True, eq=False, slots=True)
class LoadedMesh:
    """A mesh as a loader reads it: triangles with an appearance have no material yet.

    Attributes
    ----------
    positions, triangles
        As in :class:`~voxrt.voxelize.scene.Mesh`.
    materials
        uint8, shape (T,): material ids; 0 for triangles that are fully transparent or have an appearance.
    appearance
        Textures and vertex colours; None where the file gives none.
    normals
        The normals of its corners; None where the file gives none.
    """

    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]
    materials: NDArray[np.uint8]
    appearance: SurfaceAppearance | None = None
    normals: CornerNormals | None = None


@dataclass(eq=False, slots=True)
class _Usage:
    """The triangles whose appearances have one name.

    Attributes
    ----------
    faces
        The index of a mesh, and its triangles.
    colours
        The sRGB colour on each mesh's triangles; None where it varies over them.
    light, area
        The sum of mean colour (linear) times area, and the sum of areas.
    """

    faces: list[tuple[int, NDArray[np.intp]]] = field(default_factory=list)
    colours: set[tuple[int, int, int] | None] = field(default_factory=set)
    light: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    area: float = 0.0

    @property
    def uniform(self) -> bool:
        """Whether all of it has one colour."""
        return len(self.colours) == 1 and None not in self.colours


def assign_materials(loaded: Sequence[LoadedMesh], table: MaterialTable, log: WarningLog) -> list[Mesh]:
    """Give each triangle with an appearance a material in its mean colour, and drop fully transparent triangles.

    An appearance of one colour becomes a plain material.

    Parameters
    ----------
    loaded
        All meshes of the scene.
    table
        The scene's materials; those of appearances are appended.
    log
        Counts the triangles that are dropped.

    Returns
    -------
    One mesh for each of `loaded`; it may have no triangles.

    Raises
    ------
    DoesNotFitError
        The uniform materials leave no id for textures and vertex colours.
    """
    usages: dict[_Key, _Usage] = {}
    materials = [one.materials.copy() for one in loaded]
    rows = [one.appearance.rows.copy() if one.appearance is not None else None for one in loaded]
    for at, one in enumerate(loaded):
        if one.appearance is None:
            continue
        solid = visible_triangles(one.appearance)
        cut = int(((one.appearance.rows >= 0) & ~solid).sum())
        log.add("transparent", "fully transparent faces were left out", cut)
        for row, appearance in enumerate(one.appearance.entries):
            faces = np.flatnonzero(solid & (one.appearance.rows == row))
            if len(faces):
                usage = usages.setdefault((appearance.name, appearance.mirror), _Usage())
                usage.faces.append((at, faces))
                usage.colours.add(_only_colour(one.appearance, appearance, faces))
                _add_light(usage, one, one.appearance, appearance, faces)
    for usage, number in zip(usages.values(), _numbers(usages, table), strict=True):
        for at, faces in usage.faces:
            materials[at][faces] = number
            own = rows[at]
            if usage.uniform and own is not None:
                own[faces] = -1
    return [_finished_mesh(*one) for one in zip(loaded, materials, rows, strict=True)]


def _only_colour(
    surface: SurfaceAppearance, appearance: Appearance, faces: NDArray[np.intp]
) -> tuple[int, int, int] | None:
    """Return the sRGB colour of an appearance on some triangles; None where it varies over them."""
    first = surface.colours[faces[0], 0]
    if appearance.texture is not None or not (surface.colours[faces] == first).all():
        return None
    red, green, blue = srgb_from_linear(first[:3].astype(np.float64) * appearance.factor[:3]).tolist()
    return red, green, blue


def _add_light(
    usage: _Usage,
    one: LoadedMesh,
    surface: SurfaceAppearance,
    appearance: Appearance,
    faces: NDArray[np.intp],
) -> None:
    """Add the mean colour of some triangles, sampled and weighted by area."""
    some = faces[:: -(-len(faces) // _SAMPLED_TRIANGLES)]
    weights = centroids(isqrt(_SAMPLES // len(some)))
    uv, mixed = weights @ surface.uv[some], weights @ surface.colours[some].astype(np.float64)
    texture = replace(appearance.texture, nearest=True) if appearance.texture is not None else None
    found = shade(appearance, texture, uv.reshape(-1, 2), mixed.reshape(-1, 4))
    areas = _areas(one, some)
    share = np.repeat(areas / (areas.max() or 1.0) + 1e-9, len(weights)) * (1e-9 + (found[:, 3] >= appearance.cutoff))
    area = float(areas.sum()) * len(faces) / len(some)
    usage.light += share @ found[:, :3] / share.sum() * (area + 1e-300)
    usage.area += area + 1e-300


def _numbers(usages: dict[_Key, _Usage], table: MaterialTable) -> list[int]:
    """Append the materials of appearances to `table` and return their ids; too many appearances share materials."""
    free = MATERIAL_LIMIT - (len(table) - 1)
    if free < 1 and usages:
        raise DoesNotFitError(
            f"the uniform materials take all {MATERIAL_LIMIT} ids and leave none for textures and vertex colours; "
            "merge some in the asset"
        )
    if not all(usage.uniform for usage in usages.values()):
        free = -(-free // 2)  # the other half is for assign_colours
    means = srgb_from_linear(np.array([one.light / one.area for one in usages.values()]).reshape(-1, 3))
    colours = [next(iter(one.colours)) or mean for one, mean in zip(usages.values(), means.tolist(), strict=True)]
    keys: list[object] = list(usages)
    if len(usages) > free:
        palette, rows = quantize(means, np.array([one.area for one in usages.values()]), free)
        colours = palette[rows].tolist()
        keys = [(int(row), mirror) for row, (_, mirror) in zip(rows, usages, strict=True)]
    return [
        table.id_of(("appearance", key), name, (red, green, blue), mirror=mirror)
        for key, (name, mirror), (red, green, blue) in zip(keys, usages, colours, strict=True)
    ]


def _finished_mesh(one: LoadedMesh, materials: NDArray[np.uint8], rows: NDArray[np.int32] | None) -> Mesh:
    surface = None
    if one.appearance is not None and rows is not None and (rows[materials != 0] >= 0).any():
        surface = replace(one.appearance, rows=rows)
    solid = materials != 0
    if solid.all():
        return Mesh(one.positions, one.triangles, materials, surface, normals=one.normals)
    if surface is not None:
        surface = SurfaceAppearance(
            surface.entries,
            surface.rows[solid],
            surface.uv[solid],
            surface.colours[solid],
        )
    triangles = one.triangles[solid]
    used = np.zeros(len(one.positions), dtype=np.bool_)  # an unused vertex must not stretch the scene's bounds
    used[triangles] = True
    moved = np.cumsum(used, dtype=np.int32) - np.int32(1)
    normals = None if one.normals is None else one.normals.of_triangles(solid)
    return Mesh(one.positions[used], moved[triangles], materials[solid], surface, normals=normals)


def _areas(one: LoadedMesh, faces: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the areas of some triangles, scaled by the size of the mesh so that nothing overflows."""
    scale = float(np.abs(one.positions).max(initial=0.0)) or 1.0
    corners = one.positions[one.triangles[faces]].astype(np.float64) / scale
    along, across = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    dots = [np.einsum("ti,ti->t", p, q) for p, q in ((along, along), (across, across), (along, across))]
    areas: NDArray[np.float64] = np.sqrt(np.maximum(dots[0] * dots[1] - dots[2] ** 2, 0.0)) * min(scale, 1e100) ** 2
    return areas
