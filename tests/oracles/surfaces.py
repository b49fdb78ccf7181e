"""Measures of a scene's surface, from its triangles alone."""

import numpy as np


def scene_triangles(scene):
    """float64, shape (T, 3, 3): every triangle's corners in the scene frame, mirrored ones turned back."""
    pieces = []
    for one in scene.objects:
        turn = one.transform[:3, :3]
        triangles = (one.mesh.positions @ turn.T + one.transform[:3, 3])[one.mesh.triangles]
        pieces.append(triangles[:, ::-1] if np.linalg.det(turn) < 0 else triangles)
    return np.concatenate(pieces)


def bounds(triangles):
    """float64, shape (2, 3)."""
    corners = triangles.reshape(-1, 3)
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


def area(triangles):
    """The sum of all triangles' areas."""
    a, b, c = triangles.transpose(1, 0, 2)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def volume(triangles):
    """What a closed surface encloses, by the divergence theorem; positive when it is wound outwards."""
    a, b, c = (triangles - triangles.reshape(-1, 3).mean(axis=0)).transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)
