"""How much of each voxel objects fill: against exact volumes, and in files."""

from fractions import Fraction
from itertools import pairwise, product

import numpy as np
import pytest
from oracles.meshes import box_mesh, icosphere, joined, one_object, scene_of, without
from oracles.voxels import snap, volume6

import voxrt
from voxrt.voxelize import Grid, Mesh, SceneObject, SphereCollider, volume_fractions

UNIT = 4096


def clipped(faces, axis, value, sign):
    """A convex solid, faces of exact points, cut by a plane: what lies where sign * (coordinate - value) <= 0."""
    kept, rim = [], []
    for face in faces:
        out = []
        for p, q in pairwise([*face, face[0]]):
            a, b = sign * (p[axis] - value), sign * (q[axis] - value)
            if a <= 0:
                out.append(p)
            if a * b < 0:
                out.append(tuple(u + (v - u) * a / (a - b) for u, v in zip(p, q, strict=True)))
        if len(out) > 2:
            kept.append(out)
            rim += [p for p in out if p[axis] == value]
    return kept, rim


def volume_in(tetrahedron, voxel):
    """The volume of a tetrahedron in a voxel, exact: cut by six planes, summed by pyramids over one corner."""
    a, b, c, d = tetrahedron
    faces = [[a, b, c], [a, d, b], [b, d, c], [a, c, d]]
    for axis, side in product(range(3), (0, 1)):
        faces, rim = clipped(faces, axis, Fraction(voxel[axis] + side), 2 * side - 1)
        points = list(dict.fromkeys(rim))
        if len(points) > 2:  # the cut itself is a face: its points in order around their middle
            u, v = (axis + 1) % 3, (axis + 2) % 3
            middle = [sum(p[i] for p in points) / len(points) for i in (u, v)]
            points.sort(key=lambda p: np.arctan2(float(p[v] - middle[1]), float(p[u] - middle[0])))
            if not any(len(f) == len(points) and set(f) == set(points) for f in faces):
                faces.append(points)
    if not faces:
        return Fraction(0)
    top, total = faces[0][0], Fraction(0)
    for face in faces:
        for p, q in pairwise(face[1:]):
            m = [[x - t for x, t in zip(point, top, strict=True)] for point in (face[0], p, q)]
            total += abs(
                m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
            )
    return total / 6


@pytest.mark.parametrize("seed", range(12))
def test_tetrahedra_are_cut_exactly(seed):
    """Every voxel of a solid of one tetrahedron, in rationals."""
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 8 * UNIT, (4, 3)) if seed % 2 else rng.integers(0, 17, (4, 3)) * UNIT // 2
    if np.linalg.det(points[1:] - points[0]) < 0:
        points[[0, 1]] = points[[1, 0]]
    if abs(np.linalg.det((points[1:] - points[0]).astype(float))) < 1:
        return
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32)
    mesh = Mesh(points / UNIT, faces, np.ones(4, np.uint8))
    found = volume_fractions(one_object(mesh), Grid(3, (0.0, 0.0, 0.0), 1.0))
    exact = [tuple(Fraction(int(v), UNIT) for v in p) for p in points]
    for voxel, fraction in zip(found.voxels.tolist(), found.fractions.tolist(), strict=True):
        assert abs(Fraction(fraction) - volume_in(exact, voxel)) < Fraction(1, 2**40)
    assert abs(Fraction(found.volumes[0]) - abs(Fraction(int(volume6(points, faces)), 6 * UNIT**3))) < Fraction(
        1, 2**38
    )


def test_sums_are_the_volumes_of_meshes():
    ball, box = icosphere(3, (130.3, 120.1, 128.9), 100.0), box_mesh((3.25, 3.5, 3), (250.75, 90, 17.125))
    hollow = joined(ball, Mesh(ball.positions * 0.5 + 64, ball.triangles[:, ::-1], ball.materials))
    huge = box_mesh((-3000.5, 10.5, 20), (9000, 20.25, 30.5))  # cut off by the grid
    grid = Grid(8, (0.0, 0.0, 0.0), 1.0)
    found = volume_fractions(scene_of(ball, box, hollow, huge), grid)
    exact = [
        abs(float(Fraction(int(volume6(snap(one.positions, np.eye(4), grid.origin, 1.0), one.triangles)), 6 * UNIT**3)))
        for one in (ball, box, hollow)
    ]
    np.testing.assert_allclose(found.volumes, [*exact, 256 * 9.75 * 10.5], rtol=1e-12)
    assert found.without == ()


def test_objects_without_volume_are_named():
    ball = icosphere(2, (8, 8, 8), 5)
    round_one = SceneObject("round", ball, np.eye(4), (SphereCollider((8.0, 8.0, 8.0), 5.0),), 1)
    found = volume_fractions(scene_of(ball, without(ball, [0]), round_one), Grid(4, (0.0, 0.0, 0.0), 1.0))
    assert len(found.without) == 2
    assert np.isnan(found.volumes).tolist() == [False, True, True]


def test_files(tmp_path):
    scene = scene_of(box_mesh((2.5, 3, 4), (10, 12.25, 9)))
    grid = Grid(4, (1.0, 2.0, 3.0), 0.5)
    found = volume_fractions(scene, grid)
    voxrt.write_fractions(found, scene, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as archive:
        np.testing.assert_array_equal(archive["fractions"], found.fractions)
        np.testing.assert_array_equal(archive["voxels"], found.voxels)
    with pytest.raises(voxrt.OutputError, match=r"written as \.npz or \.vti"):
        voxrt.write_fractions(found, scene, tmp_path / "a.csv")
    pv = pytest.importorskip("pyvista", reason="PyVista is not installed")
    voxrt.write_fractions(found, scene, tmp_path / "a.vti")
    image = pv.read(tmp_path / "a.vti")
    assert image.cell_data["fraction"].sum() == pytest.approx(found.volumes[0], rel=1e-12)
    assert image.bounds[:2] == (1.0, 9.0)
