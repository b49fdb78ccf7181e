"""How much surface there is, where it is, and which triangles have an area: natively as by NumPy and by fractions."""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from voxrt.voxelize import _native

CORNERS = tuple(product((-3.0, 0.0, 1.0, 2.5), repeat=3))


def random_cloud(seed, kind):
    """Return positions, of which triangles use some, triangles and transforms."""
    rng = np.random.default_rng(seed)
    positions = rng.normal(0, 5, (90, 3)).astype(kind)
    triangles = rng.integers(0, 80, (150, 3)).astype(np.int32)
    positions[80:] *= 1000
    return positions, triangles, rng.normal(0, 2, (4, 3, 4))


def placed_corners(cloud):
    """Return the corners of all triangles of all copies: shape (N, T, 3, 3)."""
    positions, triangles, transforms = cloud
    placed = np.einsum("nij,vj->nvi", transforms[..., :3], positions) + transforms[:, None, :, 3]
    return placed[:, triangles]


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_a_projected_area_is_that_along_the_axis_that_a_triangle_faces(kind):
    cloud = random_cloud(1, kind)
    areas, low, high = _native.projected_areas(cloud)
    corners = placed_corners(cloud)
    normals = np.cross(corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :])
    np.testing.assert_allclose(areas, np.abs(normals).max(axis=2).sum(axis=1) / 2, rtol=1e-9)
    np.testing.assert_allclose([low, high], [corners.min(axis=(0, 1, 2)), corners.max(axis=(0, 1, 2))], rtol=1e-12)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_areas_by_place_are_those_of_the_middles(kind):
    clouds = [random_cloud(seed, kind) for seed in (2, 3)]
    areas, width = _native.areas_by_place(clouds, 16)
    corners = np.concatenate([placed_corners(cloud).reshape(-1, 3, 3) for cloud in clouds])
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    assert width == pytest.approx((high - low).max())
    for axis in range(3):
        expected, _ = np.histogram(corners.mean(axis=1)[:, axis], 16, (low[axis], low[axis] + width), weights=area)
        np.testing.assert_allclose(areas[axis], expected, rtol=1e-9)


def test_areas_of_nothing_and_of_numbers_that_are_none():
    flat = (np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32), np.eye(4)[None, :3])
    assert not _native.areas_by_place([flat], 4)[0].any()
    assert not _native.areas_by_place([], 4)[0].any()
    far = (np.array([[0, 0, 0], [np.inf, 0, 0], [0, np.nan, 0]]), *flat[1:])
    assert not np.isfinite(_native.areas_by_place([far], 4)[0].sum())
    with pytest.raises(ValueError, match="bins"):
        _native.areas_by_place([flat], 0)
    for measure in (_native.projected_areas, lambda cloud: _native.areas_by_place([cloud], 4)):
        with pytest.raises(ValueError, match="index positions"):
            measure((flat[0], flat[1] + 1, flat[2]))
        with pytest.raises(ValueError, match="transforms"):
            measure((*flat[:2], np.eye(3)))


@pytest.mark.parametrize("power", [0, 1, -540, 530, -1020, -1072, 1020])
def test_triangles_without_area_are_those_of_fractions(power):
    """Bounds leave out the third corner where all three are on one line."""
    body = np.ldexp([[0, 0, 0], [0.25, 0, 0], [0, 0.25, 0]], power)
    for two, three in product(CORNERS[::3], CORNERS[1::4]):
        corners = np.ldexp([(0, 0, 0), two, three], power)
        u, v = ([Fraction(x) for x in row] for row in corners[1:].tolist())
        has_area = any(u[i - 2] * v[i - 1] != u[i - 1] * v[i - 2] for i in range(3))
        positions = np.vstack([body, corners])
        triangles = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
        _, high = _native.scene_bounds([(positions, triangles, np.eye(4)[None, :3])], 0)
        shown = positions if has_area else positions[:3]
        assert list(high) == shown.max(axis=0).tolist(), (two, three)
