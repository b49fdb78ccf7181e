"""OpenVDB grids: fakes with the iterators of its Python module, and the module itself where it is installed."""

from dataclasses import dataclass, field
from itertools import product

import numpy as np
import pytest

from voxrt import octree
from voxrt.voxelize import DoesNotFitError


@dataclass
class Item:
    min: tuple[int, int, int]
    max: tuple[int, int, int]
    value: object


@dataclass
class Grid:
    gridClass: str = "unknown"  # noqa: N815 - names of OpenVDB
    on: list[Item] = field(default_factory=list)
    off: list[Item] = field(default_factory=list)

    def citerOnValues(self):  # noqa: N802
        return iter(self.on)

    def citerOffValues(self):  # noqa: N802
        return iter(self.off)


def voxel(place, value):
    return Item(place, place, value)


def test_tiles_and_voxels_of_material_ids():
    grid = Grid(on=[Item((-8, 0, 0), (-1, 7, 7), 3), voxel((0, 1, 2), 200), voxel((1, 0, 0), 0)])
    tree, origin = octree.from_vdb(grid)
    assert origin == (-8, 0, 0)
    expected = np.zeros((16, 16, 16), np.uint8)
    expected[:8, :8, :8] = 3
    expected[8, 1, 2] = 200
    np.testing.assert_array_equal(octree.to_dense(tree), expected)


def test_a_level_set_is_solid_where_it_is_negative_active_or_not():
    ball = {place: sum((c - 7) ** 2 for c in place) ** 0.5 - 5.5 for place in product(range(15), repeat=3)}
    band = {place: value for place, value in ball.items() if abs(value) < 2}
    grid = Grid("level set", [voxel(*item) for item in band.items()])
    grid.off = [voxel(place, max(-2.0, min(2.0, value))) for place, value in ball.items() if place not in band]
    tree, origin = octree.from_vdb(grid)
    assert origin == (2, 2, 2)
    found = octree.to_dense(tree)[:11, :11, :11]
    for place in product(range(2, 13), repeat=3):
        assert found[tuple(c - 2 for c in place)] == (ball[place] < 0)


def test_other_numbers_are_solid_where_active_and_above_zero():
    grid = Grid(on=[voxel((5, 5, 5), 0.25), voxel((6, 5, 5), -1.0)], off=[voxel((9, 9, 9), 1.0)])
    tree, origin = octree.from_vdb(grid)
    assert (octree.census(tree).solid_voxels, origin) == (1, (5, 5, 5))
    assert octree.census(octree.from_vdb(Grid(on=[Item((0, 0, 0), (7, 7, 7), True)]))[0]).voxels == {1: 512}


@pytest.mark.parametrize(
    ("item", "problem"),
    [
        (voxel((1, 2, 3), 256), "256 at .1, 2, 3. of the OpenVDB grid is no material id"),
        (voxel((1, 2, 3), (0.5, 0.5, 0.5)), "grid of vectors"),
        (voxel((1, 2, 3), 0), "nothing in the OpenVDB grid is solid"),
    ],
)
def test_what_is_no_solid_is_refused(item, problem):
    with pytest.raises(ValueError, match=problem):
        octree.from_vdb(Grid(on=[item]))


def test_what_is_too_large_is_refused():
    with pytest.raises(DoesNotFitError, match="resample"):
        octree.from_vdb(Grid(on=[Item((0, 0, 0), (4095, 4095, 4095), 1)]))
    with pytest.raises(DoesNotFitError, match="100001 from end to end"):
        octree.from_vdb(Grid(on=[voxel((0, 0, 0), 1), voxel((100_000, 0, 0), 1)]))


def test_a_sphere_of_openvdb():
    openvdb = pytest.importorskip("openvdb", reason="OpenVDB's Python module is not installed")
    grid = openvdb.createLevelSetSphere(radius=20, center=(3, 4, 5), voxelSize=1.0)
    tree, _ = octree.from_vdb(grid)
    assert octree.census(tree).solid_voxels == pytest.approx(4 / 3 * np.pi * 20**3, rel=0.01)
