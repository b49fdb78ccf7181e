"""The light that points receive: against rational rays, on every instruction set and any number of threads."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import ray
from oracles.random_worlds import dense_cubes

from voxrt.octree import from_dense
from voxrt.sim import _bake
from voxrt.sim._bake import sky_directions, sun_direction

METHODS = ("rays", "sweep")


def receive(cube, voxels, normals, directions, *, threads=1, method="automatic", instructions=""):
    tree = from_dense(cube)
    return _bake.receive_light(
        tree.words,
        tree.depth,
        np.asarray(voxels, np.int32),
        np.asarray(normals, np.int16),
        directions.steps,
        directions.units,
        directions.weights,
        threads,
        method,
        instructions,
    )


def by_hand(cube, voxels, normals, directions):
    """Sum the light ray by ray; the voxel in which a ray starts is empty."""
    received, full = [], []
    for voxel, normal in zip(voxels, normals, strict=True):
        sums = [0, 0]
        for step, unit, weight in zip(directions.steps, directions.units, directions.weights, strict=True):
            facing = max(0, int(np.dot(normal.astype(int), unit.astype(int))))
            sums[1] += facing
            if facing and ray.trace(cube, 16 * voxel + 8, step)[0] == 0:
                sums[0] += facing * int(weight)
        received.append(sums[0])
        full.append(sums[1])
    return received, full


def empty_voxels_near(cube, rng, count):
    solid = np.argwhere(cube != 0)
    low, high = solid.min(axis=0) - 3, solid.max(axis=0) + 4
    found = rng.integers(low, high, (4 * count, 3))
    inside = ((found >= 0) & (found < len(cube))).all(axis=1)
    blocked = inside & (cube[tuple(np.clip(found, 0, len(cube) - 1).T)] != 0)
    return found[~blocked][:count]


def unit_normals(rng, count):
    made = rng.normal(size=(count, 3))
    return np.rint(16384 * made / np.linalg.norm(made, axis=1, keepdims=True)).astype(np.int16)


@settings(max_examples=25, deadline=None)
@given(cube=dense_cubes(max_depth=4), seed=st.integers(0, 2**32 - 1), samples=st.integers(1, 10))
def test_light_is_the_sum_of_rational_rays(cube, seed, samples):
    if not cube.any():
        return
    rng = np.random.default_rng(seed)
    voxels = empty_voxels_near(cube, rng, 12)
    normals = unit_normals(rng, len(voxels))
    directions = sky_directions(samples)
    expected = by_hand(cube, voxels, normals, directions)
    for method in METHODS:
        for instructions in _bake.INSTRUCTION_SETS:
            found = receive(cube, voxels, normals, directions, method=method, instructions=instructions)
            assert (found.received.tolist(), found.full.tolist()) == expected, (method, instructions)


@settings(max_examples=20, deadline=None)
@given(cube=dense_cubes(max_depth=4), seed=st.integers(0, 2**32 - 1), axis=st.sampled_from([None, 0, 1, 2]))
def test_the_sun_is_a_rational_ray_of_any_direction(cube, seed, axis):
    if not cube.any():
        return
    rng = np.random.default_rng(seed)
    voxels = empty_voxels_near(cube, rng, 40)
    normals = unit_normals(rng, len(voxels))
    sun = rng.normal(size=3) if axis is None else np.eye(3)[axis] * rng.choice([-1, 1])
    directions = sun_direction(tuple(sun))
    found = receive(cube, voxels, normals, directions)
    assert (found.received.tolist(), found.full.tolist()) == by_hand(cube, voxels, normals, directions)


def test_light_does_not_depend_on_threads():
    rng = np.random.default_rng(5)
    cube = (rng.random((64, 64, 64)) < 0.01).astype(np.uint8)
    voxels = empty_voxels_near(cube, rng, 40_000)
    normals = unit_normals(rng, len(voxels))
    for method in METHODS:
        one, many = (
            receive(cube, voxels, normals, sky_directions(16), threads=threads, method=method) for threads in (1, 5)
        )
        assert one.received.tobytes() == many.received.tobytes()
        assert one.full.tobytes() == many.full.tobytes()
        assert one.received.any()


def test_what_cannot_be_traced_is_refused():
    cube = np.ones((4, 4, 4), np.uint8)
    up = sun_direction((0, 1, 0))
    with pytest.raises(ValueError, match="point 0 lies more than 4 voxels from the box of the solid voxels"):
        receive(cube, [[0, 8, 0]], [[0, 16384, 0]], up)
    with pytest.raises(ValueError, match="this processor has no instruction set 'abacus'"):
        receive(cube, [[0, 4, 0]], [[0, 16384, 0]], up, instructions="abacus")
    with pytest.raises(ValueError, match="a sweep takes steps of at most 16"):
        receive(cube, [[0, 4, 0]], [[0, 16384, 0]], sun_direction((1, 2, 3)), method="sweep")


@pytest.mark.parametrize("samples", [1, 3, 64, 500])
def test_sky_directions_are_all_different_and_even(samples):
    steps = sky_directions(samples).steps
    assert len(np.unique(steps, axis=0)) == 2 * samples
    units = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    # The cosine-weighted sum over the half space of any normal, which is 1/4 of the sphere's for an even spread.
    if samples >= 64:
        for normal in np.random.default_rng(0).normal(size=(50, 3)):
            share = np.maximum(units @ normal, 0).mean() / np.linalg.norm(normal)
            assert share == pytest.approx(0.25, abs=0.015)
