"""The last step of loading: a material for each appearance; triangles that are not opaque enough are dropped."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from voxrt.voxelize import _native
from voxrt.voxelize.colour.appearance import SurfaceAppearance
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.formats.opacity import OPAQUE_FROM, log_left_out
from voxrt.voxelize.mesh import Mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.corner_normals import CornerNormals
    from voxrt.voxelize.formats.material_table import MaterialTable
    from voxrt.voxelize.warning_log import WarningLog


class LoadedMesh(Struct, frozen=True, eq=False):
    """A mesh as a loader reads it: triangles with an appearance have no material yet."""

    # As in :class:`~voxrt.voxelize.scene.Mesh`.
    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]
    # uint8, shape (T,): material ids; 0 for triangles that are left out or have an appearance.
    materials: NDArray[np.uint8]
    appearance: SurfaceAppearance | None = None  # textures and vertex colours; None where the file gives none
    normals: CornerNormals | None = None  # the normals of its corners; None where the file gives none


def assign_materials(
    loaded: Sequence[LoadedMesh], table: MaterialTable, log: WarningLog, opaque_from: float = OPAQUE_FROM
) -> list[Mesh]:
    """Give each triangle with an appearance a material in its mean colour, and drop those that are cut away.

    An appearance of one colour becomes a plain material. The materials of appearances are appended to `table`. Return
    one mesh for each of `loaded`; it may have no triangles. Raise DoesNotFitError where the uniform materials leave no
    id for textures and vertex colours.
    """
    arrays = [
        (
            np.ascontiguousarray(one.positions),
            np.ascontiguousarray(one.triangles),
            np.ascontiguousarray(one.materials),
            one.appearance.arrays() if one.appearance is not None else None,
        )
        for one in loaded
    ]
    try:
        assigned = _native.assign_materials(arrays, table.native)
    except _native.TooManyMaterialsError as error:
        raise DoesNotFitError(str(error)) from None
    for one, (materials, _, cut) in zip(loaded, assigned, strict=True):
        if cut and one.appearance is not None:
            _log_cut(one.appearance, materials, log, opaque_from)
    return [_finished_mesh(one, materials, rows) for one, (materials, rows, _) in zip(loaded, assigned, strict=True)]


def _log_cut(surface: SurfaceAppearance, materials: NDArray[np.uint8], log: WarningLog, opaque_from: float) -> None:
    cut = (surface.rows >= 0) & (materials == 0)
    highest = surface.colours[:, :, 3].max(axis=1)
    for row, entry in enumerate(surface.entries):
        here = highest[cut & (surface.rows == row)] * entry.factor[3]
        clear = int((here <= 0).sum())
        log_left_out(log, 0.0, entry.cutoff, opaque_from, clear)
        log_left_out(log, 1.0, entry.cutoff, opaque_from, len(here) - clear)


def _finished_mesh(one: LoadedMesh, materials: NDArray[np.uint8], rows: NDArray[np.int32]) -> Mesh:
    surface = None
    if one.appearance is not None and (rows[materials != 0] >= 0).any():
        surface = replace(one.appearance, rows=rows)
    solid = materials != 0
    if solid.all():
        return Mesh(one.positions, one.triangles, materials, surface, normals=one.normals)
    if surface is not None:
        surface = SurfaceAppearance(surface.entries, surface.rows[solid], surface.uv[solid], surface.colours[solid])
    triangles = one.triangles[solid]
    used = np.zeros(len(one.positions), dtype=np.bool_)  # an unused vertex must not stretch the scene's bounds
    used[triangles] = True
    moved = np.cumsum(used, dtype=np.int32) - np.int32(1)
    normals = None if one.normals is None else one.normals.of_triangles(solid)
    return Mesh(one.positions[used], moved[triangles], materials[solid], surface, normals=normals)
