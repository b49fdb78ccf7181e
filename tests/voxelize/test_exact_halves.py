"""Voxels with exactly a half, or with less by far less than float64 shows: against fractions."""

import math
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from oracles.meshes import one_object, scene_of
from oracles.voxels import dense

from voxrt.voxelize import Grid, Mesh, voxelize

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))

from acid import checker

UNIT = checker.UNIT
TETRAHEDRON = [(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)]
PYRAMID = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 2, 1), (0, 3, 2)]
BLOCK = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4)]
BLOCK += [(2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def mesh_of(points, faces):
    return Mesh(np.array(points, float) / UNIT, np.array(faces, np.int32), np.ones(len(faces), np.uint8))


def triangles_of(points, faces):
    return [tuple(tuple(int(v) for v in points[i]) for i in face) for face in faces]


def halves(scene, depth=3):
    return dense(voxelize(scene, Grid(depth, (0.0, 0.0, 0.0), 1.0), rule="half", thin="drop", threads=1).voxels) != 0


def coarse_solid(rng):
    """A tetrahedron, a pyramid or a sheared box: corners at quarters or halves of voxels, faces at any angle."""
    unit = int(rng.choice([UNIT // 4, UNIT // 2, UNIT, UNIT * 3 // 2]))
    kind, corners = rng.integers(3), 8 * UNIT // unit
    if kind == 0:
        return rng.integers(0, corners + 1, (4, 3)) * unit, TETRAHEDRON
    o, a, b, c = rng.integers(0, corners // 4 + 1, (4, 3)) * unit
    if kind == 1:
        return np.array([o, o + a, o + a + b, o + b, o + c]), PYRAMID
    return np.array([o + i * a + j * b + k * c for k in (0, 1) for j in (0, 1) for i in (0, 1)]), BLOCK


def test_slanted_faces_edges_and_corners():
    rng, ties = np.random.default_rng(39), 0
    while ties < 20:
        points, faces = coarse_solid(rng)
        triangles = triangles_of(points, faces)
        if checker.volume6(triangles) == 0:
            continue
        fractions = checker.Mesh(triangles, 8).fractions()
        found = sum(2 * part == 1 for part in fractions.values())
        if found == 0:
            continue
        ties += found
        made = halves(one_object(mesh_of(points, faces)))
        assert {tuple(v) for v in np.argwhere(made).tolist()} == {v for v, part in fractions.items() if 2 * part >= 1}


@pytest.mark.parametrize("split", [((0, 1, 3), (0, 3, 2)), ((0, 1, 2), (1, 3, 2))])
def test_the_two_halves_of_a_block_add_up(split):
    """A block whose faces pass centres, cut along a slanted plane into two objects; a half more is of neither alone."""
    o, a, b, c = (np.array(v) * UNIT // 2 for v in ((1, 3, 1), (9, 2, 0), (-1, 8, 0), (1, 1, 13)))
    points = np.array([o + i * a + j * b + k * c for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    wedges = []
    for x, y, z in split:  # corners of the lower face
        faces = [(x, z, y), (x + 4, y + 4, z + 4)]
        for p, q in ((x, y), (y, z), (z, x)):
            faces += [(p, q, q + 4), (p, q + 4, p + 4)]
        wedges.append((points, faces))
    parts = [checker.Mesh(triangles_of(*wedge), 8).fractions() for wedge in wedges]
    sums = {v: sum(part.get(v, 0) for part in parts) for v in {*parts[0], *parts[1]}}
    assert sum(2 * total == 1 and all(v in part for part in parts) for v, total in sums.items()) > 3
    made = halves(scene_of(*(mesh_of(*wedge) for wedge in wedges)))
    assert {tuple(v) for v in np.argwhere(made).tolist()} == {v for v, total in sums.items() if 2 * total >= 1}


def bezout(numbers):
    """Integers whose products with `numbers` add up to their greatest common divisor."""
    total, factors = 0, []
    for number in numbers:
        a, b, x, y = total, int(number), (1, 0), (0, 1)
        while b:
            quotient = a // b
            a, b = b, a - quotient * b
            x, y = y, tuple(p - quotient * q for p, q in zip(x, y, strict=True))
        total, factors = a, [f * x[0] for f in factors] + [x[1]]
    return [f * (1 if total > 0 else -1) for f in factors]


def large_tetrahedron(rng, bits, beside):
    """One face passes `beside` / |n| above the centre of voxel (3, 4, 2); n is its normal, of 2 * `bits` bits."""
    while True:
        u, v = rng.integers(-(2**bits), 2**bits, (2, 3)).astype(object)
        normal = np.array([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
        length = math.sqrt(sum(int(n) ** 2 for n in normal))
        if math.gcd(*map(int, normal)) == 1 and length > 2 ** (2 * bits - 1):
            break
    step = np.array(bezout(normal), object)  # normal . step = 1
    uu, uv, vv, us, vs = u.dot(u), u.dot(v), v.dot(v), u.dot(step), v.dot(step)
    least = uu * vv - uv * uv
    step = step - round(Fraction(vv * us - uv * vs, least)) * u - round(Fraction(uu * vs - uv * us, least)) * v
    at = np.array([3, 4, 2], object) * UNIT + UNIT // 2 + beside * step
    base = [at - 8 * u - 8 * v, at + 16 * u - 8 * v, at - 8 * u + 16 * v]
    top = at - np.array([round(float(n) / length * 2 ** (bits + 2)) for n in normal], object)
    assert normal.dot(base[0] - (np.array([3, 4, 2], object) * UNIT + UNIT // 2)) == beside
    return [*base, top], [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]


@pytest.mark.parametrize("beside", [-1, 0, 1])
@pytest.mark.parametrize("bits", [15, 20, 24])
@pytest.mark.parametrize("seed", range(4))
def test_a_face_less_than_a_trillionth_from_the_centre(seed, bits, beside):
    """The half-space below a plane fills a half or more of a voxel if the centre lies in it."""
    points, faces = large_tetrahedron(np.random.default_rng(seed), bits, beside)
    made = halves(one_object(mesh_of(points, faces)))
    assert made[3, 4, 2] == (beside >= 0)
