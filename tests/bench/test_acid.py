"""The acid test of voxelizers: voxrt against its checker in fractions, on its cases and on random meshes."""

import ast
import re
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from oracles.voxels import dense

from voxrt.voxelize import EMPTY, Grid, Material, Mesh, Scene, SceneObject, voxelize

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.append(str(BENCH))

from acid import checker  # noqa: E402 - found there
from acid.cases import CASES  # noqa: E402
from acid.shapes import ball, box, cube, rotation, star, turned  # noqa: E402

UNIT = checker.UNIT


def voxels_of(triangles, depth, origin=(0, 0, 0), rule="touch"):
    points = np.array(triangles, float).reshape(-1, 3) / UNIT + np.array(origin, float)
    corners = np.arange(len(points), dtype=np.int32).reshape(-1, 3)
    mesh = Mesh(points, corners, np.ones(len(corners), np.uint8))
    scene = Scene("case", (SceneObject("case", mesh),), (EMPTY, Material("stone", (150, 150, 150))))
    grid = Grid(depth, tuple(map(float, origin)), 1.0)
    result = voxelize(scene, grid, rule=rule, thin="drop", threads=1)
    return {tuple(voxel) for voxel in np.argwhere(dense(result.voxels)).tolist()}


def expected(triangles, depth):
    """By rule, the voxels of solids; only by touch, those of sheets."""
    mesh = checker.Mesh(triangles, 2**depth)
    pieces = checker.oriented(triangles)
    enclosing = all(checker.is_closed(piece) and checker.volume6(piece) for piece in pieces)
    inside = all(0 <= v <= mesh.side * UNIT for t in triangles for p in t for v in p)
    found = {"touch": mesh.touch()} | ({"centre": mesh.centre(contact=True)} if enclosing else {})
    return found | ({"half": mesh.half(windings=True)} if enclosing and inside else {})


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_voxrt_is_right_on_every_case(case):
    for rule, voxels in expected(case.surface, case.depth).items():
        assert voxels_of(case.triangles, case.depth, case.origin, rule) == voxels, rule


def coordinates(depth):
    """Numbers of the lattice; many lie on planes between voxels, and some outside of the grid."""
    plane = st.integers(-1, 2**depth + 1)
    return st.one_of(plane.map(lambda v: v * UNIT), st.integers(-UNIT // 2, 2**depth * UNIT + UNIT // 2))


SHAPES = {
    4: [(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)],
    6: [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)],
}


BOTH = st.booleans()


@st.composite
def solids(draw, inside=BOTH):
    """Up to three tetrahedra, or an octahedron that may cut itself: (triangles, depth)."""
    depth = draw(st.integers(1, 4))
    within = draw(inside)
    number = coordinates(depth).map(lambda v: min(max(v, 0), 2**depth * UNIT)) if within else coordinates(depth)
    point = st.tuples(number, number, number)
    triangles = []
    for count in draw(st.sampled_from([(4,), (4, 4), (4, 4, 4), (6,)])):
        points = draw(st.lists(point, min_size=count, max_size=count, unique=True))
        piece = [tuple(points[i] for i in face) for face in SHAPES[count]]
        assume(checker.volume6(piece) != 0)
        triangles += turned(piece) if draw(st.booleans()) else piece
    assume(len({frozenset(t) for t in triangles}) == len(triangles))
    return triangles, depth


@settings(max_examples=40)
@given(solids())
def test_voxrt_is_right_on_random_solids(solid):
    triangles, depth = solid
    for rule, voxels in expected(triangles, depth).items():
        assert voxels_of(triangles, depth, rule=rule) == voxels, rule


@settings(max_examples=30)
@given(solids(), st.data())
def test_faces_of_a_closed_piece_may_be_turned(solid, data):
    triangles, depth = solid
    assume(len(checker.oriented(triangles)) == 1)
    some = data.draw(st.sets(st.integers(0, len(triangles) - 1)))
    mixed = [t[::-1] if i in some else t for i, t in enumerate(triangles)]
    assert voxels_of(mixed, depth) == checker.Mesh(triangles, 2**depth).touch()


@settings(max_examples=20)
@given(solids(st.just(True)))
def test_fractions_add_up_to_the_volume(solid):
    triangles, depth = solid
    assume(len(triangles) == 4)
    mesh = checker.Mesh(triangles, 2**depth)
    fractions = mesh.fractions()
    assert sum(fractions.values()) == Fraction(abs(checker.volume6(triangles)), 6 * UNIT**3)
    assert all(0 < part <= 1 for part in fractions.values())
    assert set(fractions) <= mesh.touch()


def test_what_overlaps_counts_once():
    first, second = cube(2, 10), cube(6, 14)
    crossing = checker.Mesh(first + second, 16)
    assert sum(crossing.fractions().values()) == 2 * 8**3 - 4**3
    assert sum(crossing.fractions(windings=True).values()) == 2 * 8**3
    one, other = box((2.3, 2, 2), (9.1, 9, 9), rotation((1, 2, 3), 20)), ball((9, 8, 8), 4, 4, 6)
    apart = [sum(checker.Mesh(mesh, 16).fractions().values()) for mesh in (one, other)]
    both = checker.Mesh(one + other, 16).fractions()
    assert max(apart) < sum(both.values()) < sum(apart)
    assert max(both.values()) == 1


def test_faces_without_an_area_add_nothing():
    bow_tie = star([(0.5, 0.5), (4.5, 4.5), (4.5, 0.5), (0.5, 4.5)], 0, 4)  # its middle lies on two of its sides
    mesh = checker.Mesh(bow_tie, 8)
    assert checker.volume6(bow_tie) == sum(mesh.fractions(windings=True).values()) == 0
    assert sum(mesh.fractions().values()) == 8 * 4
    assert mesh.fractions()[2, 2, 0] == Fraction(1, 2)
    a, b, c, d, e = (0, 0, 8), (0, 0, 33), (1, 0, 0), (0, 51, 55), (0, 0, 5)  # a, b and e lie on a vertical line
    faces = [(a, d, c), (d, b, c), (b, a, c), (d, a, e), (b, d, e), (a, b, e)]
    upright = [tuple(tuple(v * UNIT for v in p) for p in face) for face in faces]
    assert (0, 0, 20) in checker.Mesh(upright, 64).touch() == voxels_of(upright, 6)


def test_bounds_of_the_rules():
    mesh = checker.Mesh(cube(3.5, 12.5), 16)
    assert len(mesh.centre(contact=True)) == 10**3
    assert len(mesh.centre(contact=False)) == 8**3
    assert len(mesh.half()) == 10**3 - 8 - 12 * 8
    assert mesh.surface_within(Fraction(1, 2)) == mesh.surface(contact=True) - mesh.centre(contact=False)
    walls = checker.Mesh(cube(3, 13), 16)
    assert walls.surface(contact=False) == set()
    assert len(walls.surface(contact=True)) == 12**3 - 8**3
    assert walls.touch() == walls.centre(contact=True) == walls.half()


def test_a_piece_within_another_is_a_cavity_where_it_faces_inwards():
    hollow = checker.Mesh(cube(2, 14) + turned(cube(5, 11)), 16)
    assert len(hollow.touch()) == 12**3 - 6**3
    inverted = checker.Mesh(turned(cube(2, 14)) + cube(5, 11), 16)
    assert inverted.touch() == hollow.touch()
    assert checker.Mesh(cube(2, 14) + cube(5, 11), 16).touch() == checker.Mesh(cube(2, 14), 16).touch()
    beside = checker.Mesh(cube(1, 4) + turned(cube(9, 12)), 16)
    assert len(beside.touch()) == 2 * 3**3


def test_the_checker_stands_alone():
    source = (BENCH / "acid" / "checker.py").read_text(encoding="utf-8")
    assert len(source.splitlines()) <= 300
    imported = {
        name.partition(".")[0]
        for node in ast.walk(ast.parse(source))
        for name in ([a.name for a in node.names] if isinstance(node, ast.Import) else [getattr(node, "module", "")])
        if isinstance(node, ast.Import | ast.ImportFrom)
    }
    assert imported <= set(sys.stdlib_module_names)


def test_each_case_names_an_issue():
    assert len(CASES) >= 60
    assert len({case.name for case in CASES}) == len(CASES)
    assert all(re.fullmatch(r"[\w.-]+/[\w.-]+#\d+", case.issue) for case in CASES)
