"""Cubes, spheres, cylinders, cones, capsules and planes as triangle meshes whose vertices lie on the true surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Surface: TypeAlias = tuple[NDArray[np.float64], NDArray[np.int32]]

SEGMENTS = 128
"""Segments per circle: a chord is at most 0.03 % of the radius away from it, 0.15 voxels where 1024 voxels span
the circle."""

_AXES = {"X": 0, "Y": 1, "Z": 2}

VOXEL_MARK = np.array([[0.25, 0.25, 0.25], [0.75, 0.75, 0.25], [0.75, 0.25, 0.75], [0.25, 0.75, 0.75]])
"""float64, shape (4, 3): the corners of a tetrahedron in the middle of a voxel, which meets that voxel alone."""

VOXEL_MARK_TRIANGLES = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], np.int32)
"""int32, shape (4, 3): its faces, counter-clockwise seen from outside."""


def cube(size: float) -> Surface:
    """Return a cube of side `size` about the origin."""
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) * (size / 2)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners, np.array(triangles, dtype=np.int32)


def plane(width: float, length: float, axis: str) -> Surface:
    """Return a rectangle about the origin with its normal along `axis`.

    Source: the UsdGeomPlane schema: `width` lies along x (along z for the x axis), `length` along y (along z for the
    y axis).
    """
    half_width, half_length = width / 2, length / 2
    flat = np.array([[-half_width, -half_length], [half_width, -half_length], [half_width, half_length]])
    flat = np.vstack([flat, [[-half_width, half_length]]])
    points = np.zeros((4, 3))
    across, along = {"X": (2, 1), "Y": (0, 2), "Z": (0, 1)}[axis]
    points[:, across], points[:, along] = flat[:, 0], flat[:, 1]
    triangles = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    return points, triangles if axis == "Z" else triangles[:, ::-1].copy()


def revolved(profile: NDArray[np.float64], axis: str) -> Surface:
    """Return a closed surface of revolution about `axis`, ``"X"``, ``"Y"`` or ``"Z"``.

    `profile`, float64, shape (N, 2), has (radius, height) from bottom to top; the first and last radius are 0.
    """
    angles = 2 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    # Exact zeros and ones on the axes, so that the bounds are the true ones.
    cosine, sine = np.round(np.cos(angles), 15), np.round(np.sin(angles), 15)
    rings = profile[1:-1]
    points = np.zeros((2 + len(rings) * SEGMENTS, 3))
    points[0, 2], points[1, 2] = profile[0, 1], profile[-1, 1]
    around = points[2:].reshape(len(rings), SEGMENTS, 3)
    around[:, :, 0] = rings[:, :1] * cosine
    around[:, :, 1] = rings[:, :1] * sine
    around[:, :, 2] = rings[:, 1:]
    here = np.arange(SEGMENTS)
    there = (here + 1) % SEGMENTS
    pieces = [np.stack([np.zeros_like(here), 2 + there, 2 + here], axis=1)]
    for ring in range(len(rings) - 1):
        low, high = 2 + ring * SEGMENTS, 2 + (ring + 1) * SEGMENTS
        pieces.append(np.stack([low + here, low + there, high + there], axis=1))
        pieces.append(np.stack([low + here, high + there, high + here], axis=1))
    top = 2 + (len(rings) - 1) * SEGMENTS
    pieces.append(np.stack([np.ones_like(here), top + here, top + there], axis=1))
    turn = (_AXES[axis] + 1) % 3  # a cyclic turn of the axes mirrors nothing
    return np.roll(points, turn, axis=1), np.concatenate(pieces).astype(np.int32)


def sphere(radius: float) -> Surface:
    """Return a ball about the origin."""
    return revolved(_arc(radius, -np.pi / 2, np.pi / 2, 0.0), "Z")


def cylinder(bottom: float, top: float, height: float, axis: str) -> Surface:
    """Return a cylinder or a truncated cone about the origin, by the radii of its ends."""
    half = height / 2
    return revolved(np.array([[0, -half], [bottom, -half], [top, half], [0, half]], dtype=np.float64), axis)


def cone(radius: float, height: float, axis: str) -> Surface:
    """Return a cone about the origin, its tip on the positive side of `axis`."""
    half = height / 2
    return revolved(np.array([[0, -half], [radius, -half], [0, half]], dtype=np.float64), axis)


def capsule(bottom: float, top: float, height: float, axis: str) -> Surface:
    """Return a cylinder of `height` between two half balls, about the middle of the cylinder."""
    low = _arc(bottom, -np.pi / 2, 0.0, -height / 2)
    high = _arc(top, 0.0, np.pi / 2, height / 2)
    return revolved(np.concatenate([low, high]), axis)


def _arc(radius: float, start: float, stop: float, centre: float) -> NDArray[np.float64]:
    """Part of a circle as (radius, height), each half turn in SEGMENTS / 2 steps."""
    steps = round(SEGMENTS * (stop - start) / (2 * np.pi))
    angles = np.linspace(start, stop, steps + 1)
    profile = np.stack([radius * np.cos(angles), centre + radius * np.sin(angles)], axis=1)
    profile[np.abs(np.abs(angles) - np.pi / 2) < 1e-12, 0] = 0.0
    return profile
