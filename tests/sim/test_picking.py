"""Picking in a world that is edited, against rays through its memory that is built anew."""

import numpy as np
import pytest

from voxrt import octree, sim
from voxrt.octree import Rom, Sphere, World
from voxrt.voxelize import EMPTY, Material

MATERIALS = (EMPTY, Material("stone", (120, 120, 120)), Material("gold", (250, 200, 60)))


def test_picks_are_the_rays_of_the_hardware_after_every_edit():
    rng = np.random.default_rng(1)
    world = World(Rom("world", octree.from_dense(rng.integers(0, 2, (16, 16, 16))), MATERIALS))
    seen = set()
    for _ in range(30):
        world.fill(Sphere(rng.integers(0, 256, 3) / 16, rng.integers(0, 80) / 16), int(rng.integers(0, 3)))
        origins = rng.integers(-160, 416, (20, 3)) / 16
        directions = rng.integers(-3, 4, (20, 3)) * 2.0 ** rng.integers(-4, 5)
        directions[~directions.any(axis=1)] = (0, -1, 0)
        hits = sim.cast_rays(world.rom().octree, origins, directions)
        for row, (origin, direction) in enumerate(zip(origins, directions, strict=True)):
            picked = sim.pick(world, origin, direction)
            assert (picked is not None) == hits.hit[row]
            if picked is None:
                continue
            assert (picked.voxel, picked.material) == (tuple(hits.voxel[row]), hits.material[row])
            axis = hits.face[row]
            if axis == sim.FACE_NONE:
                assert picked.beside is None
                seen.add("inside")
                continue
            expected = hits.voxel[row].copy()
            expected[axis] -= np.sign(direction[axis]).astype(int)
            assert picked.beside == tuple(expected)
            seen.add(axis)
    assert seen == {0, 1, 2, "inside"}


@pytest.mark.parametrize(
    ("origin", "direction", "problem"),
    [
        ((0, 0, 0), (0, 0, 0), r"directions\[0\] must not be zero"),
        ((0, 0, 0.1), (0, 0, 1), r"origins\[0\] must be multiples of 1/16 voxel"),
        ((0, 0, 0), (1, 0, 1 / 3), r"directions\[0\] must be integers below"),
        ((0, 0), (0, 0, 1), r"origin must have shape \(3,\)"),
    ],
)
def test_rays_that_no_register_holds_are_refused(origin, direction, problem):
    world = World(Rom("dot", octree.from_points([[1, 1, 1]], [1], depth=2), MATERIALS))
    with pytest.raises(ValueError, match=problem):
        sim.pick(world, origin, direction)
