"""Proxies: the colliders that are voxelized in place of an object's triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from voxrt.voxelize.collider_shapes import BoxCollider

if TYPE_CHECKING:
    from voxrt.voxelize.collider_shapes import Collider
    from voxrt.voxelize.scene import SceneObject

Geometry: TypeAlias = Literal["auto", "render", "collider"]

GEOMETRIES: tuple[Geometry, ...] = ("auto", "render", "collider")


def proxies(item: SceneObject, geometry: Geometry) -> tuple[Collider, ...] | None:
    """Return the colliders that represent an object, or None where its triangles or its points are voxelized.

    With ``"collider"``, an object without colliders gets the box of its mesh, in its own frame, unless others represent
    it. Points stay points.
    """
    if item.hidden:
        return item.colliders if geometry == "collider" else ()
    if geometry == "render" or (not item.colliders and (geometry == "auto" or item.points is not None)):
        return None
    if item.colliders or item.represented or len(item.mesh.triangles) == 0:
        return item.colliders
    corners = item.mesh.positions[item.mesh.triangles.ravel()].astype(np.float64)
    return (BoxCollider(corners.min(axis=0), corners.max(axis=0)),)
