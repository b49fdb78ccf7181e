"""Assemblies of boxes that touch face to face, some inside out: the voxels are those of all boxes.

Boxes have corners on a small lattice, so that faces lie upon parts of others and corners on edges of others. Nothing
says which faces are a box: they are one mesh, with shared vertices or without.
"""

import numpy as np
import pytest
from oracles.meshes import cut_box
from oracles.voxels import dense

import voxrt
from voxrt.voxelize import Grid, voxelize


def welded(positions, triangles):
    places, number = np.unique(positions, axis=0, return_inverse=True)
    return places, number.reshape(-1)[triangles]


def touches(taken, low, high):
    """Whether a side of the box lies on what is taken."""
    for axis in range(3):
        grown = [list(low), list(high)]
        grown[0][axis], grown[1][axis] = max(0, low[axis] - 1), high[axis] + 1
        if taken[tuple(slice(*ends) for ends in zip(*grown, strict=True))].any():
            return True
    return False


def assembly(rng, side):
    """Return the boxes as meshes and the cells of the lattice that they take."""
    taken = np.zeros((side,) * 3, bool)
    parts = []
    cuts = rng.choice([0, 0, 0.2])
    count = rng.integers(2, 8)
    for _ in range(200):
        low = rng.integers(0, side, 3)
        high = np.minimum(low + rng.integers(1, side // 2 + 1, 3), side)
        place = tuple(slice(*ends) for ends in zip(low, high, strict=True))
        if len(parts) < count and not taken[place].any() and (not parts or touches(taken, low, high)):
            taken[place] = True
            positions, triangles = welded(*cut_box(low, high, rng, cuts)[:2])
            parts.append((positions, triangles[:, ::-1] if rng.random() < 0.4 else triangles))
    return parts, taken


def joined(parts, kind):
    starts = np.cumsum([0, *(len(positions) for positions, _ in parts[:-1])])
    positions = np.concatenate([positions for positions, _ in parts])
    triangles = np.concatenate([triangles + start for (_, triangles), start in zip(parts, starts, strict=True)])
    if kind == "soup":
        return positions[triangles].reshape(-1, 3), np.arange(triangles.size).reshape(-1, 3)
    return welded(positions, triangles) if kind == "welded" else (positions, triangles)


@pytest.mark.parametrize("kind", ["welded", "parted", "soup"])
@pytest.mark.parametrize("side", [4, 8, 16])
@pytest.mark.parametrize("seed", range(12))
def test_boxes_that_touch_are_their_union(seed, side, kind):
    rng = np.random.default_rng([seed, side])
    parts, taken = assembly(rng, side)
    positions, triangles = joined(parts, kind)
    scale = 16 // side
    scene = voxrt.mesh_scene(positions * scale, triangles)
    result = voxelize(scene, Grid(4, (0.0, 0.0, 0.0), 1.0))
    want = taken.repeat(scale, 0).repeat(scale, 1).repeat(scale, 2)
    np.testing.assert_array_equal(dense(result.voxels) != 0, want)
