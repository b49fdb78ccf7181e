"""Cutting polygons: area and boundary are kept, whatever the polygon."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt.voxelize.formats.triangulation import triangulate


def signed_area(points):
    x, y = points[:, 0], points[:, 1]
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def triangle_areas(points, triangles):
    a, b, c = (points[triangles[:, i], :2] for i in range(3))
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def flat(points):
    return np.column_stack([np.asarray(points, dtype=float), np.zeros(len(points))])


def whole(count):
    return np.array([count]), np.arange(count)


@st.composite
def star_polygons(draw):
    """Simple polygons, concave as a rule: radii around a centre by ascending angle."""
    radii = draw(st.lists(st.integers(1, 20), min_size=4, max_size=40))
    angles = 2 * np.pi * np.arange(len(radii)) / len(radii)
    return np.array(radii)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)


@given(star_polygons(), st.sampled_from([0, 1, 2]), st.booleans())
def test_area_and_orientation_are_kept_in_any_plane(polygon, axis, mirrored):
    points = flat(polygon[::-1] if mirrored else polygon)
    triangles, faces = triangulate(np.roll(points, axis, axis=1), *whole(len(points)))
    assert len(triangles) == len(points) - 2
    assert (faces == 0).all()
    areas = triangle_areas(points, triangles)
    # No triangle lies outside: all areas have the polygon's sign and sum to its area.
    assert (areas * (-1 if mirrored else 1) >= -1e-9).all()
    assert areas.sum() == pytest.approx(signed_area(points), rel=1e-9)


@pytest.mark.parametrize("turn", range(4))
def test_a_concave_quadrilateral_is_cut_at_its_reflex_corner(turn):
    points = flat(np.roll([[0, 0], [4, 0], [1, 1], [0, 4]], turn, axis=0))
    triangles, _ = triangulate(points, *whole(4))
    assert (triangle_areas(points, triangles) > 0).all()


def test_mixed_polygons_keep_their_order():
    points = flat([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [3, 0], [2, 1]])
    triangles, faces = triangulate(points, np.array([3, 4, 3]), np.array([4, 5, 6, 0, 1, 2, 3, 0, 1, 2]))
    assert faces.tolist() == [0, 1, 1, 2]
    assert triangles[0].tolist() == [4, 5, 6]
    assert triangles[3].tolist() == [0, 1, 2]


def test_a_polygon_without_area_is_cut_as_a_fan():
    triangles, _ = triangulate(np.zeros((6, 3)), *whole(6))
    assert len(triangles) == 4


def test_no_polygons():
    triangles, faces = triangulate(np.zeros((0, 3)), np.zeros(0, dtype=int), np.zeros(0, dtype=int))
    assert triangles.shape == (0, 3)
    assert faces.shape == (0,)
