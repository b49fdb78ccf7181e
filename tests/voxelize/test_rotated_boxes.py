"""Boxes in float32, rotated, glued at faces, edges and seams or crossing, some inside out or with turned faces.

Rounding puts faces that were meant to lie upon one another slightly apart, or through each other. The voxels are those
of all boxes: a voxel has to be solid where it meets a box that is smaller by some units of rounding, and empty where it
does not meet one that is larger by as much.
"""

import numpy as np
import pytest
from msgspec.structs import replace
from oracles.meshes import cut_box
from oracles.voxels import dense

import voxrt
from voxrt.voxelize import Grid, voxelize

DEPTH = 5
SIDE = 2**DEPTH


def rotation(rng):
    matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


def placed(rng, side, crossing):
    """Return the lowest and highest corners of boxes on a lattice that touch, or cross where they may."""
    boxes = []
    taken = np.zeros((side,) * 3, bool)
    for _ in range(200):
        low = rng.integers(0, side, 3)
        high = np.minimum(low + rng.integers(1, side // 2 + 1, 3), side)
        place = tuple(slice(*ends) for ends in zip(low, high, strict=True))
        near = taken[tuple(slice(max(0, a - 1), b + 1) for a, b in zip(low, high, strict=True))].any()
        nested = any(
            (np.maximum(a, low) == low).all() and (np.minimum(b, high) == high).all() for a, b in boxes
        ) or any((np.maximum(a, low) == a).all() and (np.minimum(b, high) == b).all() for a, b in boxes)
        if len(boxes) < 6 and (not boxes or near) and not nested and (crossing or not taken[place].any()):
            taken[place] = True
            boxes.append((low, high))
    return boxes


def turned(triangles, sides, rng, how):
    if how == "parts":
        return triangles[:, ::-1] if rng.random() < 0.4 else triangles
    faces = rng.random(6)[sides] < 0.3 if how == "sides" else rng.random(len(sides)) < 0.3
    return np.where(faces[:, None], triangles[:, ::-1], triangles)


def meets(boxes, matrix, grid, margin):
    """Tell which voxels meet a box that is larger by `margin` voxels: separating axes."""
    cells = np.stack(np.meshgrid(*(np.arange(SIDE) + 0.5,) * 3, indexing="ij"), -1)
    axes = [*np.eye(3), *matrix.T, *(np.cross(a, b) for a in np.eye(3) for b in matrix.T)]
    found = np.zeros((SIDE,) * 3, bool)
    for low, high in boxes:
        centre = ((low + high) / 2 @ matrix.T - grid.origin) / grid.voxel_size
        half = (high - low) / 2 / grid.voxel_size + margin
        overlap = np.ones_like(found)
        for axis in (axis / np.linalg.norm(axis) for axis in axes if np.linalg.norm(axis) > 1e-9):
            reach = np.abs(axis).sum() / 2 + half @ np.abs(matrix.T @ axis)
            overlap &= np.abs((cells - centre) @ axis) < reach
        found |= overlap
    return found


def assert_union(seed, crossing, how, shift=0.0):
    rng = np.random.default_rng([seed, crossing])
    side, cuts = rng.choice([4, 8, 16]), rng.choice([0, 0.2])
    boxes, matrix = placed(rng, side, crossing), rotation(rng)
    parts = [cut_box(low, high, rng, cuts) for low, high in boxes]
    starts = np.cumsum([0, *(len(part[0]) for part in parts[:-1])])
    positions = np.concatenate([part[0] for part in parts]) @ matrix.T
    triangles = np.concatenate(
        [turned(own, sides, rng, how) + start for (_, own, sides), start in zip(parts, starts, strict=True)]
    )
    positions = (positions + shift).astype(np.float32)
    low, high = positions.min(0).astype(float), positions.max(0).astype(float)
    grid = Grid(DEPTH, tuple(low), (high - low).max() / SIDE)
    margin = 0.002 + 3 * np.spacing(np.abs(positions).max()) / grid.voxel_size
    solid = dense(voxelize(voxrt.mesh_scene(positions, triangles), grid).voxels) != 0
    assert not (meets(boxes, matrix, replace(grid, origin=tuple(low - shift)), -margin) & ~solid).any()
    assert not (solid & ~meets(boxes, matrix, replace(grid, origin=tuple(low - shift)), margin)).any()


@pytest.mark.parametrize("how", ["parts", "sides", "faces"])
@pytest.mark.parametrize("crossing", [False, True])
@pytest.mark.parametrize("seed", range(16))
def test_rotated_boxes_are_their_union(seed, crossing, how):
    assert_union(seed, crossing, how)


@pytest.mark.parametrize("crossing", [False, True])
@pytest.mark.parametrize("seed", range(16))
def test_so_they_are_far_from_the_origin_where_float32_is_coarser(seed, crossing):
    assert_union(seed, crossing, "sides", shift=3000.0)
