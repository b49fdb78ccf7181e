"""Every instruction set gives the same voxels: those of exact tests, for triangles of all sizes."""

import numpy as np
import pytest
from oracles.meshes import icosphere, one_object
from oracles.voxels import UNIT, snap

from voxrt import octree
from voxrt.voxelize import Grid, Mesh, _native, fit_grid
from voxrt.voxelize.scene_parts import SceneParts
from voxrt.voxelize.voxelizer import voxels_of

SIZES = {"small": (6, 12), "large": (9, 400), "wide": (12, 4000), "upright": (10, 600), "beyond": (13, 8000)}


def parts_of(scene, grid, **choices):
    parts = SceneParts(scene, grid, thin="keep", geometry="auto", pow2="box", **choices)
    return _native.SceneParts(**parts.arrays()), parts.choices


def voxels_with(instructions, scene, grid, *, fill, rule="touch"):
    parts, how = parts_of(scene, grid, fill=fill, rule=rule)
    return voxels_of(grid.depth, _native.voxelize(parts, **how, threads=1, instructions=instructions))


def words_with(instructions, scene, grid, **choices):
    return octree.build(voxels_with(instructions, scene, grid, **choices)).words


def meets(corners, voxels):
    """Whether a triangle meets the open interior of voxels: thirteen separating axes, in integers of any size."""
    corners, low = corners.astype(object), voxels.astype(object) * UNIT
    edges = [corners[(i + 1) % 3] - corners[i] for i in range(3)]
    unit = np.eye(3, dtype=int).astype(object)
    axes = [*unit, np.cross(edges[0], edges[1]), *(np.cross(e, a) for e in edges for a in unit)]
    found = np.ones(len(voxels), bool)
    for axis in axes:
        if any(axis):
            reach, base = corners @ axis, low @ axis
            bottom, top = base + UNIT * sum(min(n, 0) for n in axis), base + UNIT * sum(max(n, 0) for n in axis)
            found &= np.array([bool(reach.max() > b and reach.min() < t) for b, t in zip(bottom, top, strict=True)])
    return found


def triangle_of(size, seed):
    """A triangle of one of the sizes, its corners on quarters of a voxel now and then."""
    depth, extent = SIZES[size]
    random = np.random.default_rng(seed)
    corners = random.integers(0, extent * UNIT, (3, 3))
    if seed % 3 == 0:
        corners -= corners % (UNIT // 4)
    if size == "upright":
        corners[2, :2] = corners[0, :2] + (corners[1, :2] - corners[0, :2]) // 3 + random.integers(-2, 3, 2)
    return Grid(depth, (0.0, 0.0, 0.0), 1.0), corners


@pytest.mark.parametrize("instructions", _native.INSTRUCTION_SETS)
@pytest.mark.parametrize("size", SIZES)
def test_a_triangle_covers_what_it_meets(size, instructions):
    for seed in range(6):
        grid, corners = triangle_of(size, seed)
        scene = one_object(Mesh(corners / UNIT, np.array([[0, 1, 2]], np.int32), np.ones(1, np.uint8)))
        np.testing.assert_array_equal(snap(corners / UNIT, np.eye(4), grid.origin, grid.voxel_size), corners)
        tree = octree.build(voxels_with(instructions, scene, grid, fill="surface"))
        random = np.random.default_rng(seed)
        weights = random.dirichlet((0.7, 0.7, 0.7), 300)
        near = np.rint(weights @ corners / UNIT + random.uniform(-2, 2, (300, 3))).astype(int)
        near = np.clip(near, 0, grid.size - 1)
        filled = octree.material_at(tree, near) != 0
        np.testing.assert_array_equal(filled, meets(corners, near), err_msg=f"seed {seed}")
        assert filled.any()
        assert not filled.all()


@pytest.mark.parametrize("fill", ["solid", "surface"])
@pytest.mark.parametrize("rule", ["touch", "centre", "half"])
def test_solids_are_the_same_with_every_instruction_set(rule, fill):
    for level, depth, turn in ((1, 10, 0.3), (2, 8, 1.1), (3, 6, 2.2)):
        turned = np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        ball = icosphere(level)
        scene = one_object(Mesh(ball.positions @ turned, ball.triangles, ball.materials))
        grid = fit_grid(scene, depth=depth)
        # Part of it lies below and beside the grid.
        for place in (grid, Grid(depth, tuple(o + 0.3 for o in grid.origin), grid.voxel_size)):
            all_words = [words_with(name, scene, place, rule=rule, fill=fill) for name in _native.INSTRUCTION_SETS]
            for words in all_words[1:]:
                np.testing.assert_array_equal(words, all_words[0])


def test_volumes_are_the_same_with_every_instruction_set():
    for level, depth in ((1, 6), (2, 8), (4, 5)):
        scene = one_object(icosphere(level))
        parts, _ = parts_of(scene, fit_grid(scene, depth=depth), fill="solid", rule="touch")
        found = [_native.find_volumes(parts, threads=1, instructions=name) for name in _native.INSTRUCTION_SETS]
        for volumes in found[1:]:
            for one, first in zip(volumes, found[0], strict=True):
                np.testing.assert_array_equal(one, first)


def test_an_instruction_set_that_is_not_there_is_refused():
    scene = one_object(icosphere(0))
    parts, how = parts_of(scene, fit_grid(scene, depth=3), fill="solid", rule="touch")
    with pytest.raises(ValueError, match="no instruction set 'mmx'"):
        _native.voxelize(parts, **how, threads=1, instructions="mmx")
