"""Colliders that stand in for the surface of a mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.scene import BoxCollider, HullCollider, MeshCollider, SphereCollider

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.extras import ColliderKind
    from voxrt.voxelize.scene import Collider, Mesh


def collider_around(mesh: Mesh, kind: ColliderKind) -> Collider:
    """Return the collider of `kind` around `mesh`, in its frame; the sphere is centred in the bounding box."""
    if kind == "mesh":
        return MeshCollider(mesh.positions, mesh.triangles)
    corners = mesh.positions[np.unique(mesh.triangles)].astype(np.float64)
    if kind == "hull":
        return HullCollider(corners)
    minimum, maximum = corners.min(axis=0), corners.max(axis=0)
    if kind == "box":
        return BoxCollider(minimum, maximum)
    centre = minimum + (maximum - minimum) / 2
    return SphereCollider(centre, float(np.sqrt(((corners - centre) ** 2).sum(axis=1).max())))


def collider_points(collider: Collider) -> NDArray[np.floating]:
    """Return points, shape (N, 3), between which `collider` lies."""
    if isinstance(collider, BoxCollider):
        return np.stack([collider.minimum, collider.maximum])
    if isinstance(collider, SphereCollider):
        return np.stack([collider.centre - collider.radius, collider.centre + collider.radius])
    return collider.positions
