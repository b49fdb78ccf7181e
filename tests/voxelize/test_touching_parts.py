"""Closed parts of one object that touch at a vertex or an edge, with vertices on the edge, some inside out.

Boxes on planes between voxels have as many voxels as their volume says.
"""

import numpy as np
import pytest
from oracles.voxels import dense

import voxrt
from voxrt.voxelize import Grid, volume_fractions, voxelize

QUADS = {
    "x-": [0, 1, 3, 2],
    "x+": [4, 6, 7, 5],
    "y-": [0, 4, 5, 1],
    "y+": [2, 3, 7, 6],
    "z-": [0, 2, 6, 4],
    "z+": [1, 5, 7, 3],
}


def box(low, high, split="", edge=(8, 8)):
    """A box of 8 vertices; the face `split` has a ninth on the vertical edge, between its ends."""
    corners = [[(low, high)[i >> 2][0], (low, high)[i >> 1 & 1][1], (low, high)[i & 1][2]] for i in range(8)]
    positions = [*corners, [*edge, (low[2] + high[2]) / 2]]
    triangles = []
    for name, quad in QUADS.items():
        face = list(quad)
        if name == split:
            on_edge = [tuple(positions[vertex][:2]) == edge for vertex in quad]
            at = next(i for i in range(4) if on_edge[i] and on_edge[(i + 1) % 4])
            face = [8, *quad[at + 1 :], *quad[: at + 1]]
        triangles += [[face[0], face[i], face[i + 1]] for i in range(1, len(face) - 1)]
    return np.array(positions, float), np.array(triangles)


def cut_box(low, high, rng):
    """A box whose faces are cut into rectangles, each face for itself, so that their corners stand on its edges."""
    corners, _ = box(low, high)
    positions, triangles = [], []
    for quad in QUADS.values():
        a, b, _, d = (corners[vertex] for vertex in quad)
        u, v = (np.array([0, *sorted(set(rng.random(2).round(1)) - {0.0, 1.0}), 1]) for _ in range(2))
        for i, j in np.ndindex(len(u) - 1, len(v) - 1):
            ends = ((u[i], v[j]), (u[i + 1], v[j]), (u[i + 1], v[j + 1]), (u[i], v[j + 1]))
            start = len(positions)
            positions += [a + s * (b - a) + t * (d - a) for s, t in ends]
            triangles += [[start, start + 1, start + 2], [start, start + 2, start + 3]]
    return np.array(positions), np.array(triangles)


def turned(part):
    return part[0], part[1][:, ::-1]


GRID = Grid(4, (0.0, 0.0, 0.0), 1.0)


def scene_of(*parts):
    """One mesh with shared vertices."""
    starts = np.cumsum([0, *(len(positions) for positions, _ in parts)])
    positions, number = np.unique(np.concatenate([part[0] for part in parts]), axis=0, return_inverse=True)
    triangles = np.concatenate([triangles + start for (_, triangles), start in zip(parts, starts, strict=False)])
    return voxrt.mesh_scene(positions, number.reshape(-1)[triangles])


def built(*parts):
    """Voxels of the parts in a grid of 16 voxels per side, and kinds of warnings."""
    result = voxelize(scene_of(*parts), GRID)
    return int((dense(result.voxels) != 0).sum()), {warning.kind: warning.count for warning in result.warnings}


def volume_of(*parts):
    return float(volume_fractions(scene_of(*parts), GRID).volumes[0])


LOW, BESIDE, ABOVE = ([0, 0, 0], [8, 8, 8]), ([8, 8, 0], [16, 16, 8]), ([8, 8, 8], [14, 14, 14])


@pytest.mark.parametrize("first", ["", "x+", "y+"])
@pytest.mark.parametrize("second", ["", "x-", "y-"])
@pytest.mark.parametrize("inside_out", [None, 0, 1])
def test_parts_that_share_an_edge(first, second, inside_out):
    """What cannot be told from a surface that crosses the edge is kept, and named."""
    parts = [box(*LOW, first), box(*BESIDE, second)]
    if inside_out is not None:
        parts[inside_out] = turned(parts[inside_out])
    voxels, warned = built(*parts)
    crosses = (first[:1], second[:1]) in {("x", "x"), ("y", "y")}
    if inside_out is None:
        assert (voxels, warned) == (1024, {})
    elif crosses:
        assert (voxels > 1024, warned) == (True, {"inward-parts": 1})
    else:
        assert voxels == 1024
        assert set(warned) == {"turned-pieces"}


@pytest.mark.parametrize("inside_out", [0, 1])
def test_parts_that_share_a_vertex(inside_out):
    parts = [box(*LOW), box(*ABOVE)]
    assert built(*parts) == (512 + 216, {})
    assert built(*(turned(part) for part in parts)) == (512 + 216, {})
    parts[inside_out] = turned(parts[inside_out])
    assert built(*parts) == (512 + 216, {"turned-pieces": 1})


def test_cavities_that_touch_the_wall_at_a_vertex_stay():
    corners = np.array([[16, 16, 16], [2, 6, 6], [6, 2, 6], [6, 6, 2]], float)
    inwards = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    voxels, warned = built(box([0, 0, 0], [16, 16, 16]), (corners, inwards))
    assert (0 < 16**3 - voxels < np.linalg.det(corners[1:] - corners[0]) / -6, warned) == (True, {})
    assert built(box([0, 0, 0], [16, 16, 16]), turned(box([2, 2, 2], [14, 14, 14]))) == (16**3 - 12**3, {})


TETRAHEDRON = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]])


@pytest.mark.parametrize(
    "corners",
    [
        [[8, 0, 0], [2, 2, 2], [2, 8, 2], [2, 2, 8]],
        [[4, 4, 8], [2, 2, 2], [8, 2, 2], [2, 8, 2]],
        [[6, 0, 0], [10, 0, 0], [2, 8, 2], [2, 2, 8]],
        [[4, 0, 4], [4, 4, 0], [2, 2, 2], [1, 3, 5]],
    ],
    ids=["corner on edge", "corner on face", "edge on edge", "corners on faces"],
)
def test_cavities_that_touch_edges_and_faces_stay(corners):
    outer = np.array([[0, 0, 0], [16, 0, 0], [0, 16, 0], [0, 0, 16]], float), TETRAHEDRON
    cavity = np.array(corners, float)
    volume = np.linalg.det(cavity[1:] - cavity[0]) / 6
    parts = outer, (cavity, TETRAHEDRON if volume < 0 else TETRAHEDRON[:, ::-1])
    assert volume_of(*parts) == pytest.approx(16**3 / 6 - abs(volume), rel=1e-12)
    assert built(*parts)[1] == {}


def lathed(*rims):
    """Rectangles at given heights, each joined to the next; the first is closed, the last is a line or a point."""
    square = np.array([[0, 0], [0, 1], [1, 1], [1, 0]], float)
    corners = [np.column_stack([low + square * np.subtract(high, low), np.full(4, z)]) for low, high, z in rims]
    turns = [(4 * rim + i, 4 * rim + (i + 1) % 4) for rim in range(len(rims) - 1) for i in range(4)]
    quads = [(0, 1, 2, 3), *((a, a + 4, b + 4, b) for a, b in turns)]
    return np.concatenate(corners), np.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)])


BLOCK = ((0, 0), (16, 16), 0), ((0, 0), (16, 16), 16)


def test_a_cavity_whose_ridge_crosses_the_ridge_of_a_dent_stays():
    dented = lathed(*BLOCK, ((2, 4), (14, 12), 16), ((4, 8), (12, 8), 10))
    cavity = lathed(((4, 4), (12, 12), 4), ((8, 5), (8, 11), 10))
    assert volume_of(dented, turned(cavity)) == pytest.approx(volume_of(dented) - volume_of(cavity), rel=1e-12)


def test_a_cavity_is_none_where_a_dent_passes_through_its_wall():
    """The dent crosses the wall along edges that lie in the wall: no edge passes through a face."""
    dented = lathed(*BLOCK, ((5, 5), (11, 11), 16), ((6, 7), (8, 9), 8), ((7, 8), (7, 8), 4))
    block = box([3, 3, 2], [13, 13, 8])
    assert built(dented, turned(block)) == (built(dented, block)[0], {"turned-pieces": 1})


@pytest.mark.parametrize("seed", range(20))
def test_boxes_with_seams_some_inside_out_are_solid(seed):
    rng = np.random.default_rng(seed)
    taken = np.zeros((16, 16, 16), bool)
    parts = []
    for _ in range(6):
        low = rng.integers(0, 12, 3)
        high = np.minimum(low + rng.integers(2, 8, 3), 16)
        place = tuple(slice(*ends) for ends in zip(low, high, strict=True))
        if not taken[place].any():
            taken[place] = True
            part = cut_box(low.tolist(), high.tolist(), rng)
            parts.append(turned(part) if rng.random() < 0.4 else part)
    voxels, warned = built(*parts)
    assert voxels == taken.sum()
    assert set(warned) <= {"turned-pieces", "turned-faces"}
