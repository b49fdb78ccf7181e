"""UsdPhysics collision shapes as colliders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom, UsdPhysics

from voxrt.voxelize.scene import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.notes import Notes
    from voxrt.voxelize.usd.geometry import Surface


def colliders_of(prim: Usd.Prim, surface: Surface, time: Usd.TimeCode, notes: Notes) -> tuple[Collider, ...]:
    """Return the prim's collision shape, in its own frame; empty where it has none or it is disabled."""
    if not prim.HasAPI(UsdPhysics.CollisionAPI):
        return ()
    if UsdPhysics.CollisionAPI(prim).GetCollisionEnabledAttr().Get(time) is False:
        return ()
    positions = surface.positions[np.unique(surface.triangles)]
    kind = prim.GetTypeName()
    if kind == "Plane":
        notes.add("collider", "an endless collision plane was taken as the rectangle that is drawn")
        return ()
    if kind == "Sphere":
        return (SphereCollider(np.zeros(3), float(UsdGeom.Sphere(prim).GetRadiusAttr().Get(time))),)
    if kind == "Cube":
        return (BoxCollider(positions.min(axis=0), positions.max(axis=0)),)
    return (_of_mesh(prim, surface, positions, time, notes) if prim.IsA(UsdGeom.Mesh) else HullCollider(positions),)


def _of_mesh(
    prim: Usd.Prim, surface: Surface, positions: NDArray[np.float64], time: Usd.TimeCode, notes: Notes
) -> Collider:
    approximation = UsdPhysics.Tokens.none
    if prim.HasAPI(UsdPhysics.MeshCollisionAPI):
        approximation = UsdPhysics.MeshCollisionAPI(prim).GetApproximationAttr().Get(time)
    if approximation == UsdPhysics.Tokens.boundingCube:
        return BoxCollider(positions.min(axis=0), positions.max(axis=0))
    if approximation == UsdPhysics.Tokens.boundingSphere:
        centre = (positions.min(axis=0) + positions.max(axis=0)) / 2
        return SphereCollider(centre, float(np.linalg.norm(positions - centre, axis=1).max()))
    if approximation == UsdPhysics.Tokens.convexDecomposition:
        notes.add("collider", "a collider of convex parts was taken as the one hull around them")
        return HullCollider(positions)
    if approximation == UsdPhysics.Tokens.convexHull:
        return HullCollider(positions)
    if approximation not in (UsdPhysics.Tokens.none, UsdPhysics.Tokens.meshSimplification):
        notes.add("collider", f"collider approximation {approximation!r} is unknown; the mesh stands in")
    return MeshCollider(surface.positions, surface.triangles)
