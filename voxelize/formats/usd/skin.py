"""Meshes deformed by a skeleton or blend shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from pxr import Usd, UsdGeom, UsdSkel, Vt

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.warning_log import WarningLog

PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)


class Deformed(Struct, frozen=True, eq=False):
    """A mesh's points at one time: float64, shape (V, 3), in the frame of the prim `frame`."""

    positions: NDArray[np.float64]
    frame: Usd.Prim


def deformed_meshes(stage: Usd.Stage, time: Usd.TimeCode, log: WarningLog) -> dict[str, Deformed]:
    """Return the posed points of every mesh that is bound to a skeleton, by prim path.

    Joints blend linearly (UsdSkel's ``classicLinear``); meshes that request dual quaternions are counted in `log`.
    """
    posed: dict[str, Deformed] = {}
    cache = UsdSkel.Cache()
    for prim in Usd.PrimRange(stage.GetPseudoRoot(), PREDICATE):
        if not prim.IsA(UsdSkel.Root):
            continue
        root = UsdSkel.Root(prim)
        cache.Populate(root, PREDICATE)
        for binding in cache.ComputeSkelBindings(root, PREDICATE):
            skeleton = cache.GetSkelQuery(binding.GetSkeleton())
            for skin in binding.GetSkinningTargets():
                if skin.GetPrim().IsA(UsdGeom.Mesh):
                    found = _pose(skeleton, skin, time, log)
                    if found is not None:
                        posed[str(skin.GetPrim().GetPath())] = found
    return posed


def _pose(
    skeleton: UsdSkel.SkeletonQuery, skin: UsdSkel.SkinningQuery, time: Usd.TimeCode, log: WarningLog
) -> Deformed | None:
    prim = skin.GetPrim()
    value = UsdGeom.Mesh(prim).GetPointsAttr().Get(time)
    if not isinstance(value, Vt.Vec3fArray):
        return None
    points = Vt.Vec3fArray(value)
    moved = skin.HasBlendShapes() and _blend(skeleton, skin, time, points)
    frame = prim
    if skin.HasJointInfluences():
        joints = skeleton.ComputeSkinningTransforms(time)
        if joints and skin.ComputeSkinnedPoints(joints, points, time):
            moved, frame = True, skeleton.GetPrim()
            if skin.GetSkinningMethod() == UsdSkel.Tokens.dualQuaternion:
                log.add("skinning", "dual quaternion skinning was replaced by linear blending")
        else:
            log.add("skinning", "meshes whose skeleton has no pose are shown at rest")
    return Deformed(np.array(points, dtype=np.float64).reshape(-1, 3), frame) if moved else None


def _blend(
    skeleton: UsdSkel.SkeletonQuery, skin: UsdSkel.SkinningQuery, time: Usd.TimeCode, points: Vt.Vec3fArray
) -> bool:
    """Add the blend shapes to `points` in place; return False where no animation gives weights."""
    animation = skeleton.GetAnimQuery()
    weights = animation.ComputeBlendShapeWeights(time) if animation else None
    if not weights:
        return False
    by_name = dict(zip(animation.GetBlendShapeOrder(), weights, strict=False))
    own = Vt.FloatArray([by_name.get(name, 0.0) for name in skin.GetBlendShapeOrder()])
    shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(skin.GetPrim()))
    sub_weights, shape_indices, sub_indices = shapes.ComputeSubShapeWeights(own)
    return bool(
        shapes.ComputeDeformedPoints(
            sub_weights,
            shape_indices,
            sub_indices,
            shapes.ComputeBlendShapePointIndices(),
            shapes.ComputeSubShapePointOffsets(),
            points,
        )
    )
