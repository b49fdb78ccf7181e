"""A lone part of one material, whose voxels are found by shorter ways, has those that it has beside another part.

Beside another part all volumes are summed: these ways know nothing of sheets (column_sheets.h).
"""

import numpy as np
import pytest
from oracles.meshes import box_mesh, icosphere, joined, scene_of
from oracles.voxels import dense

from voxrt import octree
from voxrt.voxelize import Grid, Mesh, voxelize, voxelize_in_blocks

SIDE = 32
FAR = box_mesh((SIDE - 3, SIDE - 3, SIDE - 3), (SIDE - 1, SIDE - 1, SIDE - 1), 1)  # where none of the shapes is


def bumpy(rng):
    """A sphere whose sheets bend, or fold over others."""
    mesh = icosphere(3, (13, 13, 13), 8, 1)
    away = mesh.positions - 13
    waves = np.sin(away @ rng.normal(size=(3, 3)) * rng.choice([0.2, 0.6])).sum(axis=1, keepdims=True)
    return Mesh(13 + away * (1 + 0.12 * waves), mesh.triangles, mesh.materials)


def tilted_box(rng):
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    if np.linalg.det(turn) < 0:
        turn[0] *= -1
    mesh = box_mesh((-0.5,) * 3, (0.5,) * 3, 1)
    size = rng.choice([0.3, 1, 4, 12], 3)
    return Mesh(13 + (mesh.positions * size) @ turn, mesh.triangles, mesh.materials)


def lattice_box(rng):
    """Centres lie on its faces, and halves of voxels on either side of them."""
    low = 4 + rng.integers(0, 16, 3) / 2
    return box_mesh(low, low + rng.choice([0.5, 1, 1.5, 7.5], 3), 1)


def two_spheres(rng):
    """Spheres that cut each other, one inside out of the other, or side by side: several sheets per column."""
    return joined(
        icosphere(2, (11, 12, 13), 6.3, 1), icosphere(2, tuple(rng.uniform(10, 16, 3)), rng.uniform(0.5, 6.5), 1)
    )


def steep_cone(rng):
    mesh = icosphere(2, (0, 0, 0), 1, 1)
    return Mesh(mesh.positions * (2.2, 1.4, 10) + rng.uniform(12, 14, 3), mesh.triangles, mesh.materials)


def rough(rng):
    """Above a plane, slopes in all directions: a voxel with a half may be far from where the centre line crosses."""
    mesh = icosphere(3, (13, 13, 0), 8, 1)
    x, y, z = mesh.positions.T
    heights = np.where(z > 1e-6, 14 + rng.uniform(3, 9) * rng.random(len(z)) ** 2, 2.3)
    return Mesh(np.stack([x, y, heights], axis=1), mesh.triangles, mesh.materials)


def above_the_grid(rng):
    """What lies above the grid or below it is cut off."""
    mesh = icosphere(3, (13, 13, rng.choice([-1, SIDE])), 7, 1)
    return Mesh(mesh.positions + rng.uniform(0, 0.5, 3), mesh.triangles, mesh.materials)


@pytest.mark.parametrize("shape", [bumpy, tilted_box, lattice_box, two_spheres, steep_cone, rough, above_the_grid])
@pytest.mark.parametrize("rule", ["centre", "half"])
def test_a_part_has_the_same_voxels_alone_and_beside_another(shape, rule):
    for seed in range(12):
        mesh = shape(np.random.default_rng(seed))
        grid = Grid(5, (0.0, 0.0, 0.0), 1.0)
        far = dense(voxelize(scene_of(FAR), grid).voxels)
        for thin in ("keep", "drop"):
            alone = voxelize(scene_of(mesh), grid, rule=rule, thin=thin)
            beside = voxelize(scene_of(mesh, FAR), grid, rule=rule, thin=thin)
            np.testing.assert_array_equal(dense(alone.voxels), np.where(far, 0, dense(beside.voxels)))
            assert alone.objects[0].voxels == beside.objects[0].voxels == np.count_nonzero(dense(alone.voxels))


@pytest.mark.parametrize("thin", ["keep", "drop"])
def test_a_lone_part_in_blocks(thin):
    """Wide enough for several tiles, with a plate that is too thin for the rule."""
    mesh = joined(icosphere(3, (60, 70, 40), 50, 1), box_mesh((2, 3, 100), (126, 120, 100.3), 1))
    grid = Grid(7, (0.0, 0.0, 0.0), 1.0)
    for rule in ("centre", "half"):
        whole = voxelize(scene_of(mesh), grid, rule=rule, thin=thin, threads=2)
        tree = octree.Assembly(7)
        report = voxelize_in_blocks(
            scene_of(mesh),
            grid,
            lambda block, tree=tree: tree.add(octree.build(block)),
            block_side=64,
            rule=rule,
            thin=thin,
        )
        assert bytes(tree.octree().words) == bytes(octree.build(whole.voxels).words)
        assert report.objects == whole.objects
        assert whole.objects[0].voxels == np.count_nonzero(dense(whole.voxels))
