"""UsdPhysics collision shapes as colliders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom, UsdPhysics

from voxrt.voxelize.collider_shapes import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.usd.geometry import Surface
    from voxrt.voxelize.warning_log import WarningLog


def colliders_of(prim: Usd.Prim, surface: Surface, time: Usd.TimeCode, log: WarningLog) -> tuple[Collider, ...]:
    """Return the prim's collision shape, in its own frame; empty where it has none or it is disabled."""
    authored = UsdPhysics.CollisionAPI(prim) if prim.HasAPI(UsdPhysics.CollisionAPI) else None
    if authored is None or authored.GetCollisionEnabledAttr().Get(time) is False:
        return ()
    positions = surface.positions[np.unique(surface.triangles)]
    kind = prim.GetTypeName()
    if kind == "Plane":
        log.add("collider", "infinite collision planes were replaced by their visible rectangle")
        return ()
    if kind == "Sphere":
        return (SphereCollider(np.zeros(3), float(positions[:, 0].max())),)
    if kind == "Cube":
        return (BoxCollider(positions.min(axis=0), positions.max(axis=0)),)
    if not prim.IsA(UsdGeom.Mesh):
        return (HullCollider(positions),)
    return _of_mesh(prim, surface, positions, time, log)


def _of_mesh(
    prim: Usd.Prim, surface: Surface, positions: NDArray[np.float64], time: Usd.TimeCode, log: WarningLog
) -> tuple[Collider, ...]:
    approximation = UsdPhysics.Tokens.none
    if prim.HasAPI(UsdPhysics.MeshCollisionAPI):
        approximation = UsdPhysics.MeshCollisionAPI(prim).GetApproximationAttr().Get(time)
    if approximation == UsdPhysics.Tokens.boundingCube:
        return (BoxCollider(positions.min(axis=0), positions.max(axis=0)),)
    if approximation == UsdPhysics.Tokens.boundingSphere:
        centre = (positions.min(axis=0) + positions.max(axis=0)) / 2
        return (SphereCollider(centre, float(np.linalg.norm(positions - centre, axis=1).max())),)
    if approximation == UsdPhysics.Tokens.convexDecomposition:
        log.add("collider", "convex decompositions were replaced by one hull per connected part of the mesh")
        return tuple(HullCollider(part) for part in connected_parts(surface.positions, surface.triangles))
    if approximation == UsdPhysics.Tokens.convexHull:
        return (HullCollider(positions),)
    if approximation not in (UsdPhysics.Tokens.none, UsdPhysics.Tokens.meshSimplification):
        log.add("collider", f"collider approximation {approximation!r} is unknown; the mesh itself was used")
    return (MeshCollider(surface.positions, surface.triangles),)


def connected_parts(positions: NDArray[np.float64], triangles: NDArray[np.int32]) -> list[NDArray[np.float64]]:
    """Return the vertices of each connected part of a surface: float64, shape (V, 3). Equal positions are one vertex.

    Each label becomes the lowest among its neighbours, then that label's label, until nothing changes: a few rounds.
    """
    _, welded = np.unique(positions, axis=0, return_inverse=True)
    corners = welded.reshape(-1)[triangles]
    labels = np.arange(len(positions))
    while True:
        lowest = labels.copy()
        least = labels[corners].min(axis=1)
        for corner in range(3):
            np.minimum.at(lowest, corners[:, corner], least)
        lowest = lowest[lowest]
        if (lowest == labels).all():
            break
        labels = lowest
    part_of = labels[corners[:, 0]]
    return [positions[np.unique(triangles[part_of == part])] for part in np.unique(part_of)]
