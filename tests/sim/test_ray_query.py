"""Many rays at once, against walks from voxel to voxel in other arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from oracles import ray
from oracles.adversary import adversarial_rays
from oracles.cuts import memory_of
from oracles.ray_batch import trace_batch
from oracles.worlds import WORLDS

from voxrt import sim
from voxrt.octree import Octree, from_points
from voxrt.sim import ray_query


def octree_of(voxels):
    return Octree(len(voxels).bit_length() - 1, memory_of(voxels))


@pytest.mark.parametrize("name", WORLDS)
def test_hits_are_those_of_the_walk(name, monkeypatch):
    monkeypatch.setattr(ray_query, "_CHUNK", 97)
    tree = octree_of(WORLDS[name])
    origins, directions = adversarial_rays(tree.size, 300, seed=3)
    moving = directions.any(axis=1)
    origins, directions = origins[moving], directions[moving]
    hits = sim.cast_rays(tree, origins / 16, directions)
    material, face, cell = trace_batch(WORLDS[name], origins, directions)
    np.testing.assert_array_equal(hits.material, material)
    np.testing.assert_array_equal(hits.face, face)
    np.testing.assert_array_equal(hits.voxel, cell)
    np.testing.assert_array_equal(hits.hit, material > 0)
    assert hits.hit.any() == WORLDS[name].any()
    for row in np.flatnonzero(hits.hit):
        walk = ray.cells(tree.size, origins[row], directions[row])
        t = next(t for place, _, t in walk if place == tuple(cell[row]))
        assert hits.parameter[row] == float(t or Fraction(0))
    length = np.linalg.norm(directions[hits.hit].astype(float), axis=1)
    np.testing.assert_allclose(hits.distance[hits.hit], hits.parameter[hits.hit] * length)
    assert np.isinf(hits.distance[~hits.hit]).all()


def test_directions_of_any_length_are_one_ray():
    tree = octree_of(WORLDS["sparse noise"])
    origins, directions = adversarial_rays(tree.size, 200, seed=9)
    directions = directions[directions.any(axis=1)]
    origins = origins[: len(directions)] / 16
    plain = sim.cast_rays(tree, origins, directions)
    for power in (-1000, -3, 5):
        scaled = sim.cast_rays(tree, origins, np.ldexp(directions.astype(float), power))
        np.testing.assert_array_equal(scaled.voxel, plain.voxel)
        np.testing.assert_array_equal(scaled.face, plain.face)
    np.testing.assert_array_equal(sim.cast_rays(tree, origins, directions / 2).parameter, plain.parameter * 2)


def test_one_origin_or_direction_serves_all_rays():
    tree = from_points([[5, 2, 2]], [7], 3)
    hits = sim.cast_rays(tree, (0, 2.5, 2.5), [(1, 0, 0), (0, 1, 0), (1, 0.5, 0)])
    assert hits.hit.tolist() == [True, False, False]
    hits = sim.cast_rays(tree, [(0, 2.5, 2.5), (5.5, 2.5, 2.5), (9, 2.5, 2.5)], (1, 0, 0), threads=1)
    assert hits.hit.tolist() == [True, True, False]
    assert hits.face.tolist() == [0, sim.FACE_NONE, sim.FACE_NONE]
    assert hits.distance.tolist() == [5.0, 0.0, float("inf")]
    assert sim.cast_rays(tree, np.zeros((0, 3)), np.zeros((0, 3))).hit.shape == (0,)


@pytest.mark.parametrize(
    ("origins", "directions", "message"),
    [
        ([0, 0, 0], [0, 0, 0], r"directions\[0\] must not be zero"),
        ([0, 0, 0], [[1, 0, 0], [0, 0, 0]], r"directions\[1\] must not be zero"),
        ([0, 0, 0.01], [1, 0, 0], r"origins\[0\] must be multiples of 1/16 voxel"),
        ([0, 0, 1 << 27], [1, 0, 0], r"origins\[0\] must be multiples of 1/16 voxel below 2\*\*27"),
        ([0, 0, 0], [0.1, 0.2, 0.3], r"directions\[0\] must be integers below 2\*\*20.*np\.rint"),
        ([0, 0, 0], [1 << 20, 1, 0], r"directions\[0\] must be integers below 2\*\*20"),
        ([0, 0, 0], [1, 0, float("nan")], r"directions\[0, 2\] must be a finite number"),
        ([[0, 0, 0]] * 2, [[1, 0, 0]] * 3, "2 origins do not go with 3 directions"),
        ([[0, 0]], [1, 0, 0], r"origins must have shape \(N, 3\)"),
    ],
)
def test_refusals(origins, directions, message):
    with pytest.raises(ValueError, match=message):
        sim.cast_rays(octree_of(WORLDS["sparse noise"]), origins, directions)
