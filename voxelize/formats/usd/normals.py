"""The normals of a USD mesh: the primvar ``normals``, which goes before the attribute of this name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom

from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.formats.usd import primvars

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.usd.geometry import Surface
    from voxrt.voxelize.warning_log import WarningLog

_ROW = 3


def authored_normals(prim: Usd.Prim, surface: Surface, time: Usd.TimeCode, log: WarningLog) -> CornerNormals | None:
    """Return the normals of a mesh in its rest pose; None where it has none of its own."""
    if not prim.IsA(UsdGeom.Mesh):
        return None
    found = primvars.at_corners(prim, "normals", surface, time, log)
    if found is None:
        found = _of_attribute(UsdGeom.Mesh(prim), surface, time, log)
    if found is None or found.shape[2] != _ROW:
        return None
    rows = np.arange(3 * len(found), dtype=np.int32).reshape(-1, 3)
    return CornerNormals(found.reshape(-1, _ROW).astype(np.float32), rows)


def _of_attribute(
    mesh: UsdGeom.Mesh, surface: Surface, time: Usd.TimeCode, log: WarningLog
) -> NDArray[np.float64] | None:
    value = mesh.GetNormalsAttr().Get(time)
    if not value:
        return None
    vectors = np.array(value, dtype=np.float64).reshape(-1, _ROW)
    return primvars.interpolated("normals", vectors, mesh.GetNormalsInterpolation(), surface, log)
