"""Colliders that stand in for the surface of a mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.scene import BoxCollider, HullCollider, MeshCollider, SphereCollider

if TYPE_CHECKING:
    from voxrt.voxelize.gltf.extras import ColliderKind
    from voxrt.voxelize.gltf.meshes import Surface
    from voxrt.voxelize.scene import Collider


def collider_around(surface: Surface, kind: ColliderKind) -> Collider:
    """Return the collider of `kind` for `surface`, in its frame; the sphere is centred in the bounding box."""
    if kind == "mesh":
        return MeshCollider(surface.positions, surface.triangles)
    if kind == "hull":
        return HullCollider(surface.positions)
    minimum, maximum = surface.positions.min(axis=0), surface.positions.max(axis=0)
    if kind == "box":
        return BoxCollider(minimum, maximum)
    centre = minimum + (maximum - minimum) / 2
    return SphereCollider(centre, float(np.sqrt(((surface.positions - centre) ** 2).sum(axis=1).max())))
