"""What one ray reads, against a walk from voxel to voxel."""

import numpy as np
import pytest
from oracles import ray
from oracles.adversary import adversarial_rays
from oracles.cuts import memory_of
from oracles.worlds import WORLDS

from voxrt import sim
from voxrt.octree import Octree
from voxrt.sim import _model


def octree_of(voxels, **cut):
    return Octree(len(voxels).bit_length() - 1, memory_of(voxels, **cut))


@pytest.mark.parametrize("cut", [{}, {"share": False}, {"split": True}], ids=str)
@pytest.mark.parametrize("name", WORLDS)
def test_a_ray_reads_the_words_that_the_walk_reads(name, cut):
    tree = octree_of(WORLDS[name], **cut)
    origins, directions = adversarial_rays(tree.size, 60, seed=tree.depth)
    for origin, direction in zip(origins.tolist(), directions.tolist(), strict=True):
        if not any(direction):
            continue
        path = sim.follow_ray(tree, tuple(origin), tuple(direction))
        scale = 16 * np.prod([abs(d) or 1 for d in direction], dtype=object)
        expected = [
            (*what, 0 if t is None else t * scale)
            for *what, t in ray.readings(tree.words, tree.depth, origin, direction)
        ]
        assert [
            (step.address, step.word, step.level, step.corner, step.axis, step.time) for step in path.readings
        ] == expected
        assert (path.material, path.face) == ray.trace(WORLDS[name], origin, direction)
        traced = _model.Memory(tree.words, tree.depth).trace(
            np.array([origin], np.int32), np.array([direction], np.int32)
        )
        assert len(path.readings) == traced.words_read
        assert path.cell == (tuple(traced.cell[0].tolist()) if path.material else None)
        for step in path.readings:
            place = path.point(step.time)
            if step.axis != sim.FACE_NONE:  # on the octant's near side, or within its block at the least
                assert place[step.axis] == round(place[step.axis])
            assert all(a - 1e-9 <= p <= b + 1e-9 for a, p, b in zip(step.corner, place, step.end, strict=True))


def test_times_of_far_rays_do_not_wrap():
    tree = octree_of(WORLDS["sparse noise"])
    origin, direction = (-(2**31), -(2**31) + 5, -(2**31) + 9), (2**20 - 1, 2**20 - 1, 2**20 - 1)
    path = sim.follow_ray(tree, origin, direction)
    assert path.readings[0].time == 2**31 * (2**20 - 1) ** 2 > 2**63
    assert path.readings[0].axis == 0


def test_a_pixels_ray_is_that_of_the_frame():
    voxels = WORLDS["sparse noise"]
    tree = octree_of(voxels)
    camera = sim.look_at((80, 60, 90), (16, 16, 16), size=(9, 7))
    for row, line in enumerate(sim.pixel_directions(camera, (9, 7)).tolist()):
        for column, direction in enumerate(line):
            path = sim.follow_pixel(tree, camera, (9, 7), (column, row))
            assert path.direction == tuple(direction)
            assert (path.material, path.face) == ray.trace(voxels, camera.position, direction)


def test_a_world_of_one_leaf_needs_no_reading():
    path = sim.follow_ray(Octree(1, np.array([0xFFFFFF07], np.uint32)), (-16, 8, 8), (1, 0, 0))
    assert (path.root, path.readings, path.material, path.face, path.cell) == (0xFFFFFF07, (), 7, 0, (0, 0, 0))


@pytest.mark.parametrize(
    ("follow", "problem"),
    [
        (lambda tree, camera: sim.follow_pixel(tree, camera, (9, 7), (9, 0)), "pixel 9,0 lies outside"),
        (lambda tree, camera: sim.follow_pixel(tree, camera, (9, 7), (0, -1)), "rows to 6"),
        (lambda tree, _: sim.follow_ray(tree, (0, 0, 0), (1, -(2**20), 0)), r"not below 2\*\*20"),
    ],
)
def test_refusals(follow, problem):
    with pytest.raises(sim.SimulatorError, match=problem):
        follow(octree_of(WORLDS["sparse noise"]), sim.look_at((80, 60, 90), (16, 16, 16), size=(9, 7)))
    with pytest.raises(ValueError, match="reaches 1048576 on axis z"):
        _model.Memory(np.array([0xFFFFFF07], np.uint32), 1).follow(
            np.zeros(3, np.int32), np.array([0, 0, 1 << 20], np.int32)
        )
