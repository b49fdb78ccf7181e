"""The acid test of voxelizers: voxrt against its checker in fractions, on its cases and on random meshes."""

import ast
import re
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.append(str(BENCH))

from acid import checker  # noqa: E402 - found there
from acid.cases import CASES  # noqa: E402
from acid.comparison import OCTAHEDRON, TETRAHEDRON, expected, solids, voxels_of  # noqa: E402
from acid.shapes import ball, box, cube, faces_of, rotation, slab_with_notch, star, turned  # noqa: E402

UNIT = checker.UNIT


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_voxrt_is_right_on_every_case(case):
    for rule, voxels in expected(case.surface, case.depth).items():
        assert voxels_of(case.triangles, case.depth, case.origin, rule) == voxels, rule


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
@given(solids(inside=True))
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


def test_a_body_within_another_is_a_cavity_where_it_faces_inwards():
    hollow = checker.Mesh(cube(2, 14) + turned(cube(5, 11)), 16)
    assert len(hollow.touch()) == 12**3 - 6**3
    inverted = checker.Mesh(turned(cube(2, 14)) + cube(5, 11), 16)
    assert inverted.touch() == hollow.touch()
    assert checker.Mesh(cube(2, 14) + cube(5, 11), 16).touch() == checker.Mesh(cube(2, 14), 16).touch()
    beside = checker.Mesh(cube(1, 4) + turned(cube(9, 12)), 16)
    assert len(beside.touch()) == 2 * 3**3


INSCRIBED = [(14, 7, 10), (2, 7, 10), (7, 2, 10), (7, 14, 10), (7, 10, 2), (7, 10, 14)]
WEDGE = [(2, 2, 2), (2, 2, 14), (9, 5, 8), (5, 9, 8)]
TOUCHING = {
    "corners on sides": (cube(2, 14), faces_of(INSCRIBED, OCTAHEDRON), True),
    "an edge on an edge": (cube(2, 14), faces_of(WEDGE, TETRAHEDRON), True),
    "a side on a side": (cube(2, 14), box((4, 4, 8), (8, 8, 14)), False),
    "through a side": (cube(2, 14), box((4, 4, 8), (8, 8, 15)), False),
    "through a notch, its corners inside": (slab_with_notch(), box((3, 5, 4), (13, 11, 6)), False),
    "beside it at an edge": (cube(2, 8), box((8, 8, 2), (14, 14, 8)), False),
}


@pytest.mark.parametrize(("outer", "inner", "is_cavity"), TOUCHING.values(), ids=TOUCHING)
def test_a_cavity_touches_what_it_is_in_at_most_at_corners_and_edges(outer, inner, is_cavity):
    both = checker.Mesh(outer + turned(inner), 16)
    assert voxels_of(outer + turned(inner), 4) == both.touch()
    whole, part = (sum(checker.Mesh(mesh, 16).fractions().values()) for mesh in (outer, inner))
    assert sum(both.fractions(windings=True).values()) == (whole - part if is_cavity else whole + part)


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
