"""Point instancers: the placement of their copies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.usd.values import integers

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.warning_log import WarningLog


def placed_copies(
    prim: Usd.Prim, path: Path, time: Usd.TimeCode, log: WarningLog
) -> tuple[list[Usd.Prim], NDArray[np.int64], NDArray[np.float64], NDArray[np.int64]]:
    """Evaluate a point instancer. Masked copies are left out and counted.

    Return the root prims of the prototypes, the prototype of each copy (int64, shape (N,)), the transforms from the
    prototype root's own frame to the instancer's (float64, shape (N, 4, 4), column vectors), and each copy's index in
    the instancer's arrays (int64, shape (N,)). Raise AssetError where its arrays contradict each other, or a prototype
    does not exist.
    """
    instancer = UsdGeom.PointInstancer(prim)
    place = str(prim.GetPath())
    targets = instancer.GetPrototypesRel().GetForwardedTargets()
    prototypes = [prim.GetStage().GetPrimAtPath(target) for target in targets]
    for target, prototype in zip(targets, prototypes, strict=True):
        if not prototype:
            raise AssetError(path, f"prototype {target} does not exist", place=place, fix="repair its prototypes")
    indices = integers(instancer.GetProtoIndicesAttr(), time, path)
    if len(indices) and (indices.min() < 0 or indices.max() >= len(prototypes)):
        problem = f"protoIndices go from {indices.min()} to {indices.max()} and there are {len(prototypes)} prototypes"
        raise AssetError(path, problem, place=place, fix="export the instancer again")
    rows = instancer.ComputeInstanceTransformsAtTime(
        time, time, UsdGeom.PointInstancer.IncludeProtoXform, UsdGeom.PointInstancer.IgnoreMask
    )
    if len(rows) != len(indices):
        problem = (
            f"protoIndices has {len(indices)} entries and the positions, orientations or scales have other lengths"
        )
        raise AssetError(path, problem, place=place, fix="export the instancer again")
    transforms = np.array(rows, dtype=np.float64).reshape(-1, 4, 4).transpose(0, 2, 1)
    numbers = np.arange(len(indices))
    mask = np.array(instancer.ComputeMaskAtTime(time), dtype=bool)
    if len(mask):
        log.add("invisible", "masked copies of point instancers were left out", int((~mask).sum()))
        indices, transforms, numbers = indices[mask], transforms[mask], numbers[mask]
    return prototypes, indices, transforms, numbers
