"""Whose normals baked light takes: the author's where there are any, turned with the object."""

import numpy as np
import pytest
from msgspec.structs import replace
from oracles.meshes import icosphere

from voxrt.sim.baking.bake import surface_triangles
from voxrt.voxelize import EMPTY, CornerNormals, Grid, Material, Scene, SceneObject

GRID = Grid(5, (0, 0, 0), 0.5)
WHITE = (EMPTY, Material("white", (255, 255, 255)))
STRETCH = np.diag([3.0, 1.0, 0.5, 1.0])
MIRROR = np.diag([1.0, -2.0, 1.0, 1.0])
SHEAR = np.array([[1, 0.7, 0, 4], [0, 1, 0, 5], [0.2, 0, 1, 6], [0, 0, 0, 1.0]])


def normals_of(mesh, transform):
    scene = Scene("s", (SceneObject("s", mesh, transform),), WHITE)
    return surface_triangles(scene, GRID, "auto")[1]


def analytic(mesh, transform):
    """The normals of an ellipsoid: gradients of |inverse(transform) p|^2 - r^2, which do not know of normals."""
    inverse = np.linalg.inv(transform)
    points = mesh.positions @ transform[:3, :3].T + transform[:3, 3]
    local = points @ inverse[:3, :3].T + inverse[:3, 3]
    gradients = 2 * local @ inverse[:3, :3]
    return (gradients / np.linalg.norm(gradients, axis=1, keepdims=True))[mesh.triangles]


@pytest.mark.parametrize("transform", [np.eye(4), STRETCH, MIRROR, SHEAR, SHEAR @ MIRROR])
@pytest.mark.parametrize("sign", [1, -1])
def test_authored_normals_turn_as_a_surface_does(transform, sign):
    ball = icosphere(1)  # so coarse that normals by angle differ
    own = CornerNormals(sign * 7.0 * ball.positions, ball.triangles)
    found = normals_of(replace(ball, normals=own), transform)
    np.testing.assert_allclose(found, analytic(ball, transform), atol=1e-6)


@pytest.mark.parametrize("transform", [np.eye(4), STRETCH, MIRROR])
def test_corners_without_a_normal_take_it_by_angle(transform):
    ball = icosphere(1)
    rows = ball.triangles.copy()
    rows[::2, 1] = -1
    vectors = ball.positions + np.array([0.3, 0, 0])  # tilted, so that they are told from those by angle
    by_angle = normals_of(ball, transform)
    tilted = normals_of(replace(ball, normals=CornerNormals(vectors, ball.triangles)), transform)
    both = normals_of(replace(ball, normals=CornerNormals(vectors, rows)), transform)
    np.testing.assert_array_equal(both[::2, 1], by_angle[::2, 1])
    np.testing.assert_array_equal(both[1::2], tilted[1::2])
    assert np.abs(tilted - by_angle).max() > 0.1


def test_an_object_without_thickness():
    ball = icosphere(1)
    flat = np.diag([1.0, 0.0, 1.0, 1.0])
    found = normals_of(replace(ball, normals=CornerNormals(ball.positions, ball.triangles)), flat)
    assert np.isfinite(found).all()
    lengths = np.linalg.norm(found, axis=2)
    assert (np.isclose(lengths, 1) | (lengths == 0)).all()
    assert (np.abs(found[:, :, 1][lengths > 0.5]) > 0.999).all()
