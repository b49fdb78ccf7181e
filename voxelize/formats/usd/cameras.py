"""The cameras of a stage."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np
from pxr import Gf, Usd, UsdGeom

from voxrt.voxelize.formats.camera_viewpoint import camera_viewpoint
from voxrt.voxelize.formats.usd.skin import PREDICATE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.scene import Viewpoint
    from voxrt.voxelize.warning_log import WarningLog


def read_cameras(
    stage: Usd.Stage, time: Usd.TimeCode, to_scene: NDArray[np.float64], log: WarningLog
) -> tuple[Viewpoint, ...]:
    """Return the visible perspective cameras of a stage at a time, in the order of traversal.

    The angle of view is that of the vertical aperture and the focal length. What these pictures cannot show (planes
    that clip, an aperture off the axis) is counted in `log`. A camera has its prim's name, or its path where several
    prims have that name. `to_scene`, float64, shape (4, 4), takes the stage's frame to the scene's.
    """
    transforms = UsdGeom.XformCache(time)
    prims = [
        prim
        for prim in Usd.PrimRange(stage.GetPseudoRoot(), PREDICATE)
        if prim.IsA(UsdGeom.Camera) and UsdGeom.Imageable(prim).ComputeVisibility(time) != UsdGeom.Tokens.invisible
    ]
    repeats = Counter(prim.GetName() for prim in prims)
    found = []
    for prim in prims:
        schema = UsdGeom.Camera(prim)
        camera = schema.GetCamera(time)
        if camera.projection != Gf.Camera.Perspective:
            log.add("camera", "cameras without perspective were left out")
            continue
        name = prim.GetName() if repeats[prim.GetName()] == 1 else str(prim.GetPath())
        with np.errstate(over="ignore", invalid="ignore"):
            placed = to_scene @ np.array(transforms.GetLocalToWorldTransform(prim), dtype=np.float64).T
        viewpoint = camera_viewpoint(name, placed, camera.GetFieldOfView(Gf.Camera.FOVVertical))
        if viewpoint is None:
            log.add("camera", "cameras whose transform or field of view makes no picture were left out")
            continue
        found.append(viewpoint)
        if schema.GetClippingRangeAttr().HasAuthoredValue() or camera.clippingPlanes:
            log.add("camera", "clipping ranges and planes of cameras were ignored")
        if camera.horizontalApertureOffset or camera.verticalApertureOffset:
            log.add("camera", "aperture offsets of cameras were ignored")
    return tuple(found)
