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

_CREASE = 45.0
"""Degrees: triangles that meet at a smaller angle are one smooth surface."""

_FARTHEST = 1e9  # voxels


def surface_triangles(scene: Scene, grid: Grid, geometry: Geometry) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Return the triangles of all objects that are voxelized from their triangles.

    Parameters
    ----------
    scene, grid, geometry
        As :func:`voxrt.voxelize.voxelize` takes them.

    Returns
    -------
    corners
        float64, shape (T, 3, 3): voxels, grid frame.
    normals
        float32, shape (T, 3, 3): unit normals of the corners. Where the mesh has none, they are smooth over edges with
        an angle below 45 degrees.
    """
    normals_of: dict[int, NDArray[np.float32]] = {}
    corners, normals = [np.zeros((0, 3, 3))], [np.zeros((0, 3, 3), np.float32)]
    for item in scene.objects:
        if proxies(item, geometry) is not None or not len(item.mesh.triangles):
            continue
        linear = item.transform[:3, :3] / grid.voxel_size
        positions = item.mesh.positions.astype(np.float64) @ linear.T
        positions += (item.transform[:3, 3] - grid.origin) / grid.voxel_size
        positions = np.clip(np.nan_to_num(positions), -_FARTHEST, _FARTHEST)
        corners.append(positions[item.mesh.triangles])
        if not _keeps_angles(linear):
            normals.append(_smooth(positions, item.mesh))
            if np.linalg.det(linear) < 0:
                normals[-1] = -normals[-1]
            continue
        if id(item.mesh) not in normals_of:
            normals_of[id(item.mesh)] = _smooth(item.mesh.positions.astype(np.float64), item.mesh)
        turned = normals_of[id(item.mesh)] @ linear.T.astype(np.float32)
        normals.append(_unit(turned))
    return np.concatenate(corners), np.concatenate(normals)


def _smooth(positions: NDArray[np.float64], mesh: Mesh) -> NDArray[np.float32]:
    return _bake.corner_normals(np.ascontiguousarray(positions), mesh.triangles, float(np.cos(np.radians(_CREASE))))


def _keeps_angles(linear: NDArray[np.float64]) -> bool:
    """Whether a transform turns, mirrors and scales evenly."""
    squares = linear.T @ linear
    scale = np.trace(squares) / 3
    return bool(np.abs(squares - scale * np.eye(3)).max() <= 1e-6 * scale)


def _unit(vectors: NDArray[np.float32]) -> NDArray[np.float32]:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(lengths > 0, vectors / np.maximum(lengths, np.finfo(np.float32).tiny), 0).astype(np.float32)
