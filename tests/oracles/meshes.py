"""Meshes with known answers, and scenes of them, made without the code under test."""

import numpy as np
from msgspec.structs import replace

from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject

MATERIALS = (EMPTY, *(Material(f"m{i}", (i, i, i)) for i in range(1, 256)))

_BOX = np.array(
    [
        [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4],
        [2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6],
    ],
    np.int32,
)  # fmt: skip


def box_mesh(low, high, material=1, *, inverted=False):
    unit = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], float)
    triangles = _BOX[:, ::-1].copy() if inverted else _BOX
    low, high = np.array(low, float), np.array(high, float)
    return Mesh(low + unit * (high - low), triangles, np.full(12, material, np.uint8))


def without(mesh, drop):
    """Give a mesh without some of its triangles."""
    keep = np.ones(len(mesh.triangles), bool)
    keep[drop] = False
    return Mesh(mesh.positions, mesh.triangles[keep], mesh.materials[keep])


def joined(*meshes):
    """Give one mesh of several, without welding."""
    firsts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes[:-1])])
    return Mesh(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate([mesh.triangles + first for mesh, first in zip(meshes, firsts, strict=True)]).astype(np.int32),
        np.concatenate([mesh.materials for mesh in meshes]),
    )


def icosphere(level, centre=(0, 0, 0), radius=1.0, material=1):
    g = (1 + 5**0.5) / 2
    points = [
        (-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
        (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1),
    ]  # fmt: skip
    points = [np.array(p) / np.linalg.norm(p) for p in points]
    faces = [
        (0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
        (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
        (8, 6, 7), (9, 8, 1),
    ]  # fmt: skip
    for _ in range(level):
        middle = {}

        def half(a, b, middle=middle):
            key = (min(a, b), max(a, b))
            if key not in middle:
                p = points[a] + points[b]
                points.append(p / np.linalg.norm(p))
                middle[key] = len(points) - 1
            return middle[key]

        split = []
        for a, b, c in faces:
            ab, bc, ca = half(a, b), half(b, c), half(c, a)
            split += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = split
    positions = np.array(points) * radius + np.array(centre, float)
    return Mesh(positions, np.array(faces, np.int32), np.full(len(faces), material, np.uint8))


def scene_of(*items):
    objects = [item if isinstance(item, SceneObject) else SceneObject("o", item) for item in items]
    named = tuple(replace(o, name=f"{o.name}{i}") for i, o in enumerate(objects))
    return Scene("test", named, MATERIALS)


def one_object(mesh, **how):
    return scene_of(SceneObject("o", mesh, **how))


def cut_box(low, high, rng, cuts):
    """Return positions, triangles and the side of each triangle of a box; each side is cut at planes of its own.

    `cuts`: the share of the planes at which it is.
    """
    corners = np.array([[(low, high)[i >> 2][0], (low, high)[i >> 1 & 1][1], (low, high)[i & 1][2]] for i in range(8)])
    positions, triangles, sides = [], [], []
    for side, quad in enumerate(([0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3])):
        a, b, _, d = (corners[vertex].astype(float) for vertex in quad)
        lengths = [int(np.abs(end - a).sum()) for end in (b, d)]
        u, v = ([0, *(i / n for i in range(1, n) if rng.random() < cuts), 1] for n in lengths)
        for i, j in np.ndindex(len(u) - 1, len(v) - 1):
            start = len(positions)
            ends = ((u[i], v[j]), (u[i + 1], v[j]), (u[i + 1], v[j + 1]), (u[i], v[j + 1]))
            positions += [a + s * (b - a) + t * (d - a) for s, t in ends]
            pair = [[0, 1, 2], [0, 2, 3]] if rng.random() < 0.5 else [[0, 1, 3], [1, 2, 3]]
            triangles += [[start + corner for corner in triangle] for triangle in pair]
            sides += [side, side]
    return np.array(positions), np.array(triangles), np.array(sides)
