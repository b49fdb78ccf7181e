"""The triangles of a scene with smooth normals, in voxels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.sim import _bake
from voxrt.voxelize.object_proxies import proxies

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize import Grid, Mesh, Scene
    from voxrt.voxelize.object_proxies import Geometry


def surface_triangles(scene: Scene, grid: Grid, geometry: Geometry) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Return the triangles of all objects that are voxelized from their triangles (``src/bake/placed_triangles.h``).

    The corners are float64, shape (T, 3, 3): voxels, grid frame. The normals are float32, shape (T, 3, 3): unit normals
    of the corners, the author's, turned to the triangle's side. Where the mesh has none, they are smooth over edges
    with an angle below 45 degrees.
    """
    shown = [item for item in scene.objects if proxies(item, geometry) is None and len(item.mesh.triangles)]
    meshes = {id(item.mesh): item.mesh for item in shown}
    numbers = {key: number for number, key in enumerate(meshes)}
    objects = [(numbers[id(item.mesh)], np.ascontiguousarray(item.transform[:3], np.float64)) for item in shown]
    return _bake.place_triangles([_arrays(mesh) for mesh in meshes.values()], objects, grid.origin, grid.voxel_size)


def _arrays(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]]:
    positions = np.ascontiguousarray(mesh.positions, np.float64)
    normals = mesh.normals
    directions = np.zeros((0, 3)) if normals is None else np.ascontiguousarray(normals.vectors, np.float64)
    rows = np.zeros((0, 3), np.int32) if normals is None else np.ascontiguousarray(normals.rows)
    return positions, np.ascontiguousarray(mesh.triangles), directions, rows
