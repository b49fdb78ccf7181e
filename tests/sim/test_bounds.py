"""The box around a memory's solid voxels."""

import numpy as np
import pytest
from oracles import worlds
from oracles.cuts import memory_of

from voxrt.octree import Octree
from voxrt.sim import solid_bounds


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("share", [True, False])
def test_bounds_are_the_voxels_own(seed, share):
    voxels = worlds.noise(4, 0.001, seed) if seed % 2 else worlds.boxes(4, 1 + seed % 3, seed)
    found = solid_bounds(Octree(4, memory_of(voxels, share=share)))
    cells = np.argwhere(voxels)
    if not len(cells):
        assert found is None
        return
    np.testing.assert_array_equal(found[0], cells.min(axis=0))
    np.testing.assert_array_equal(found[1], cells.max(axis=0) + 1)


def test_a_memory_of_one_word():
    assert solid_bounds(Octree(3, np.array([0xFFFFFF00], np.uint32))) is None
    low, high = solid_bounds(Octree(3, np.array([0xFFFFFF09], np.uint32)))
    assert low.tolist() == [0, 0, 0]
    assert high.tolist() == [8, 8, 8]
