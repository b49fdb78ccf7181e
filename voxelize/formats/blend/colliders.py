"""Rigid-body shapes as colliders.

As in Blender's physics, the size of a box, a ball, a capsule, a cylinder or a cone is that of the object's bounding
box, its middle is the object's origin, and its axis is the object's z axis.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.collider_shapes import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.formats.round_shapes import capsule_points, cylinder_points

if TYPE_CHECKING:
    from voxrt.voxelize.formats.blend.meshes import MeshArrays
    from voxrt.voxelize.warning_log import WarningLog


def rigid_collider(body: Any, arrays: MeshArrays, log: WarningLog) -> Collider | None:  # noqa: PLR0911 - one each
    """Return the collider of a rigid body (bpy.types.RigidBodyObject) with these triangles; None for none."""
    points = arrays.positions[np.unique(arrays.triangles)].astype(np.float64)
    half = (points.max(axis=0) - points.min(axis=0)) / 2
    radius, height = max(half[0], half[2]), half[1]  # y is Blender's z
    match body.collision_shape:
        case "BOX":
            return BoxCollider(-half, half)
        case "SPHERE":
            return SphereCollider(np.zeros(3), float(half.max()))
        case "CAPSULE":
            return HullCollider(capsule_points(radius, radius, 2 * max(height - radius, 0.0)))
        case "CYLINDER":
            return HullCollider(cylinder_points(radius, radius, 2 * height))
        case "CONE":
            return HullCollider(cylinder_points(0.0, radius, 2 * height))
        case "CONVEX_HULL":
            return HullCollider(points)
        case "MESH":
            return MeshCollider(arrays.positions, arrays.triangles)
        case "COMPOUND":  # its shapes are those of its children
            return None
        case other:
            log.add("collider", f"rigid bodies of the unknown shape {other} have no collider")
            return None
