"""voxrt beside the checker: which voxels each fills, and random solids to compare them on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from acid.checker import UNIT, Mesh, bodies, is_closed, volume6
from acid.run_tool import voxrt
from acid.shapes import turned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from acid.checker import Point, Triangle, Voxel

TETRAHEDRON = ((0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3))
OCTAHEDRON = ((0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5))
SHAPES = [(4, TETRAHEDRON), (6, OCTAHEDRON)]
"""How many corners, and faces."""


def voxels_of(triangles: Sequence[Triangle], depth: int, origin: Point = (0, 0, 0), rule: str = "touch") -> set[Voxel]:
    """Return the voxels that voxrt fills."""
    points = np.array(triangles, float).reshape(-1, 3) / UNIT + np.array(origin, float)
    faces = np.arange(len(points)).reshape(-1, 3)
    return set(map(tuple, voxrt(rule)(points, faces, np.array(origin, float), 2**depth).tolist()))


def expected(triangles: Sequence[Triangle], depth: int) -> dict[str, set[Voxel]]:
    """Return by rule the voxels of solids; those of sheets, and of solids outside of the grid, by fewer rules."""
    mesh = Mesh(triangles, 2**depth)
    enclosing = all(is_closed(body) and volume6(body) for body in bodies(triangles))
    inside = all(0 <= v <= mesh.side * UNIT for t in triangles for p in t for v in p)
    found = {"touch": mesh.touch()} | ({"centre": mesh.centre(contact=True)} if enclosing else {})
    return found | ({"half": mesh.half(windings=True)} if enclosing and inside else {})


def are_apart(triangles: Sequence[Triangle]) -> bool:
    """Say whether the checker knows the bodies."""
    try:
        return bool(bodies(triangles))
    except ValueError:
        return False


def coordinates(depth: int) -> st.SearchStrategy[int]:
    """Numbers of the lattice; many lie on planes between voxels, and some outside of the grid."""
    plane = st.integers(-1, 2**depth + 1)
    return st.one_of(plane.map(lambda v: v * UNIT), st.integers(-UNIT // 2, 2**depth * UNIT + UNIT // 2))


def between(points: Sequence[Point]) -> st.SearchStrategy[Point]:
    """Means of four of some points: corners of what has these, points on its edges and faces, and inside."""
    four = st.lists(st.sampled_from(points), min_size=4, max_size=4)
    return four.map(lambda chosen: tuple(sum(values) // 4 for values in zip(*chosen, strict=True)))


@st.composite
def solids(draw: st.DrawFn, depths: tuple[int, int] = (1, 4), *, inside: bool = False) -> tuple[list[Triangle], int]:
    """Up to three closed pieces, which may face inwards: apart, with corners and edges in common, or in the first."""
    depth = draw(st.integers(*depths))
    how = draw(st.sampled_from(["apart", "sharing", "nested"]))
    number = coordinates(depth).map(lambda v: v // 4 * 4 if how == "nested" else v)
    if inside or draw(st.booleans()):
        number = number.map(lambda v: min(max(v, 0), 2**depth * UNIT))
    corner: st.SearchStrategy[Any] = st.tuples(number, number, number)
    triangles: list[Triangle] = []
    for count, faces in draw(st.lists(st.sampled_from(SHAPES), min_size=1, max_size=3)):
        points = draw(st.lists(corner, min_size=count, max_size=count, unique=True))
        if not triangles and how != "apart":
            corner = between(points) if how == "nested" else st.one_of(st.sampled_from(points), corner)
        piece = [tuple(points[i] for i in face) for face in faces]
        assume(volume6(piece) != 0)  # type: ignore[arg-type]
        triangles += turned(piece) if draw(st.booleans()) else piece  # type: ignore[arg-type]
    assume(len({frozenset(t) for t in triangles}) == len(triangles))
    assume(are_apart(triangles))
    return triangles, depth
