"""The deepest grids: voxels in far corners."""

import numpy as np
import pytest
from oracles.meshes import box_mesh, joined, one_object

from voxrt import octree
from voxrt.voxelize import Grid, voxelize


@pytest.mark.parametrize("depth", [15, 16])
def test_the_deepest_grids_have_their_voxels_where_they_belong(depth):
    far = (1 << depth) - 1
    corners = [(0, 0, 0), (far - 3, far - 2, far - 1), (far // 2, 300, far - 9), (257, far - 70, 255)]
    boxes = [box_mesh(low, [c + 2 for c in low]) for low in map(np.array, corners)]
    scene = one_object(joined(*boxes))
    voxels = voxelize(scene, Grid(depth, (0.0, 0.0, 0.0), 1.0)).voxels
    step = np.indices((2, 2, 2)).reshape(3, -1).T
    points = np.concatenate([step + low for low in corners])
    points = points[(points <= far).all(axis=1)]
    expected = octree.from_points(points, np.ones(len(points), int), depth)
    assert bytes(octree.build(voxels).words) == bytes(expected.words)
