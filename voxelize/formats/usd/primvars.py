"""Primvars, interpolated to the corners of a prim's triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.usd.geometry import Surface
    from voxrt.voxelize.warning_log import WarningLog


def constant(prim: Usd.Prim, name: str, time: Usd.TimeCode) -> NDArray[np.float64] | None:
    """Return the value of a constant primvar, float64, shape (K,); None where there is none or it varies."""
    values = _flattened(prim, name, time)
    if values is None:
        return None
    return values[0] if (values == values[0]).all() else None


def exists(prim: Usd.Prim, name: str, time: Usd.TimeCode) -> bool:
    """Tell whether a prim has a primvar, its own or an ancestor's."""
    return _flattened(prim, name, time) is not None


def at_corners(
    prim: Usd.Prim, name: str, surface: Surface, time: Usd.TimeCode, log: WarningLog
) -> NDArray[np.float64] | None:
    """Return a primvar at the corners of a surface's triangles, by its interpolation: float64, shape (T, 3, K), finite.

    None, with a warning, where the number of values does not match the interpolation.
    """
    values = _flattened(prim, name, time)
    if values is None:
        return None
    return interpolated(name, values, _find(prim, name).GetInterpolation(), surface, log)


def interpolated(
    name: str, values: NDArray[np.float64], interpolation: str, surface: Surface, log: WarningLog
) -> NDArray[np.float64] | None:
    """Return values, float64, shape (N, K), at the corners of a surface's triangles, as :func:`at_corners` does."""
    broken = int((~np.isfinite(values)).any(axis=1).sum())
    log.add("primvar", f"values of primvars {name!r} that are not numbers were taken as 0", broken)
    values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
    if len(values) == 1 or interpolation == UsdGeom.Tokens.constant:
        return np.broadcast_to(values[0], (len(surface.triangles), 3, values.shape[1]))
    wanted, rows = {
        UsdGeom.Tokens.uniform: (surface.face_count, np.repeat(surface.faces[:, None], 3, axis=1)),
        UsdGeom.Tokens.faceVarying: (surface.corner_count, surface.corners),
    }.get(interpolation, (len(surface.positions), surface.triangles))
    if len(values) != wanted or (surface.corner_count == 0 and interpolation != UsdGeom.Tokens.uniform):
        log.add("primvar", f"primvars {name!r} with a wrong number of values were ignored")
        return None
    found: NDArray[np.float64] = values[rows]
    return found


def _find(prim: Usd.Prim, name: str) -> UsdGeom.Primvar:
    return UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(name)


def _flattened(prim: Usd.Prim, name: str, time: Usd.TimeCode) -> NDArray[np.float64] | None:
    primvar = _find(prim, name) if name else None
    if not primvar or not primvar.HasValue():
        return None
    value = primvar.ComputeFlattened(time)
    try:
        values = np.atleast_1d(np.array(value, dtype=np.float64))
    except (TypeError, ValueError):
        return None
    if values.ndim == 1:  # one number per value, or one value of several numbers
        values = values[:, None] if primvar.GetTypeName().isArray else values[None]
    return values if values.ndim == 2 and len(values) else None
