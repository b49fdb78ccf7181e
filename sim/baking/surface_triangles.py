"""The triangles of a scene with smooth normals, in voxels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.sim import _bake
from voxrt.voxelize.object_proxies import proxies

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize import CornerNormals, Grid, Mesh, Scene
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
        float32, shape (T, 3, 3): unit normals of the corners: the author's, turned to the triangle's side. Where the
        mesh has none, they are smooth over edges with an angle below 45 degrees.
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
        given = None if item.mesh.normals is None else _authored(item.mesh, item.mesh.normals)
        if given is None:
            own = _by_angle(item.mesh, positions, linear, normals_of)
        else:
            own, missing = _turned(given, linear), ~given.any(axis=2, keepdims=True)
            if missing.any():
                own = np.where(missing, _by_angle(item.mesh, positions, linear, normals_of), own)
        normals.append(own)
    return np.concatenate(corners), np.concatenate(normals)


def _authored(mesh: Mesh, normals: CornerNormals) -> NDArray[np.float64]:
    """Return the author's normals, float64, shape (T, 3, 3), on the side from which the triangle is counter-clockwise.

    Zeros where a corner has none.
    """
    found = normals.of_corners()
    sides = np.diff(mesh.positions.astype(np.float64)[mesh.triangles], axis=1)
    faces = np.cross(sides[:, 0], sides[:, 1])
    behind = np.einsum("tkc,tc->t", found, faces) < 0
    found[behind] = -found[behind]
    return found


def _by_angle(
    mesh: Mesh, positions: NDArray[np.float64], linear: NDArray[np.float64], known: dict[int, NDArray[np.float32]]
) -> NDArray[np.float32]:
    """Return normals in the grid's frame, from the angles between triangles there; `known` are those of mesh frames."""
    if not _keeps_angles(linear):
        found = _smooth(positions, mesh)
        return -found if np.linalg.det(linear) < 0 else found
    if id(mesh) not in known:
        known[id(mesh)] = _smooth(mesh.positions.astype(np.float64), mesh)
    return _unit(known[id(mesh)] @ linear.T.astype(np.float32))


def _turned(normals: NDArray[np.float64], linear: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return normals under a transform of positions: by its cofactors, which exist where it has no inverse."""
    largest = np.abs(linear).max() or 1.0
    a, b, c = linear / largest
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    outwards = -1.0 if a @ np.cross(b, c) < 0 else 1.0
    turned = normals @ (outwards * cofactors.T)
    lengths = np.linalg.norm(turned, axis=-1, keepdims=True)
    return np.where(lengths > 0, turned / np.where(lengths > 0, lengths, 1.0), 0.0).astype(np.float32)


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
