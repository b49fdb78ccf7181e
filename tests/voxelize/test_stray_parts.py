"""Parts far away from nearly all of the surface are named; faces without area do not stretch the grid."""

import numpy as np
import pytest
from msgspec.structs import replace
from oracles.meshes import MATERIALS, box_mesh, icosphere, joined

from voxrt.voxelize import Mesh, Scene, SceneObject, fit_grid
from voxrt.voxelize.stray_parts import find_stray_parts

BOX = box_mesh((0, 0, 0), (16, 16, 16))
CHIP = Mesh([[1000, 0, 0], [1001, 0, 0], [1000, 1, 0]], [[0, 1, 2]], [1])


def scene_with(*objects):
    return Scene("far", objects, MATERIALS)


def moved(x, y, z):
    transform = np.eye(4)
    transform[:3, 3] = x, y, z
    return transform


def test_a_stray_triangle_is_found_in_the_object_and_beside_it():
    one = find_stray_parts(scene_with(SceneObject("scan", joined(BOX, CHIP))), "auto")
    two = find_stray_parts(scene_with(SceneObject("body", BOX), SceneObject("chip", CHIP)), "auto")
    for found, names, whole in ((one, ("scan",), ()), (two, ("chip",), ("chip",))):
        assert (found.low, found.high, found.width) == ((0, 0, 0), (16, 16, 16), 1001)
        assert (found.names, found.whole, found.place[0]) == (names, whole, 1001)
        assert found.share == pytest.approx(6 * 256 / (6 * 256 + 0.5))


def test_a_stray_triangle_as_large_as_a_side_is_found():
    chip = Mesh([[9000, 0, 0], [9016, 0, 0], [9000, 16, 0]], [[0, 1, 2]], [1])
    found = find_stray_parts(scene_with(SceneObject("scan", joined(BOX, chip))), "auto")
    assert (found.low, found.high, found.place[0]) == ((0, 0, 0), (16, 16, 16), 9016)
    assert found.share == pytest.approx(12 / 13)


@pytest.mark.parametrize("subdivisions", [3, 7])  # fewer triangles than are looked at first, and more
def test_copies_are_looked_at_where_they_stand(subdivisions):
    ball = icosphere(subdivisions, (0, 0, 0), 8)
    near, far = (
        SceneObject("near", ball),
        SceneObject("far", replace(CHIP, positions=CHIP.positions / 50), moved(0, 900, 0)),
    )
    assert find_stray_parts(scene_with(near, SceneObject("beside", ball, moved(20, 0, 0)), far), "auto").whole == (
        "far",
    )
    assert find_stray_parts(scene_with(near, SceneObject("beside", ball, moved(200, 0, 0))), "auto") is None


@pytest.mark.parametrize("number", range(10))
def test_a_triangle_of_almost_a_hundredth_is_found_wherever_it_stands_in_a_mesh(number):
    """A look at every fifth triangle, say, must not count it five times."""
    ball = icosphere(6, (0, 0, 0), 8)
    chip = Mesh([[400, 0, 0], [403.8, 0, 0], [400, 3.8, 0]], [[0, 1, 2]], [1])
    scan = joined(ball, chip)
    scan = replace(scan, triangles=np.roll(scan.triangles, number + 1, axis=0))
    found = find_stray_parts(scene_with(SceneObject("scan", scan)), "auto")
    assert found is not None
    assert found.place[0] == 403.8
    assert 0.99 < found.share < 0.992


def test_what_is_wide_or_hidden_or_a_tenth_of_the_surface_is_no_stray():
    ground = SceneObject("ground", box_mesh((-500, -1, -500), (500, 0, 500)))
    assert find_stray_parts(scene_with(ground, SceneObject("body", BOX)), "auto") is None
    hidden = SceneObject("chip", CHIP, hidden=True)
    assert find_stray_parts(scene_with(SceneObject("body", BOX), hidden), "auto") is None
    other = SceneObject("other", BOX, moved(900, 0, 0))
    assert find_stray_parts(scene_with(*[SceneObject("body", BOX)] * 9, other), "auto") is None


@pytest.mark.parametrize("corners", [[8, 9, 9], [8, 9, 10], [8, 8, 8]])
def test_faces_without_area_do_not_stretch_the_grid(corners):
    positions = np.vstack([BOX.positions, [[1000, 0, 0], [1001, 2, 0], [1003, 6, 0]]])
    mesh = Mesh(positions, np.vstack([BOX.triangles, [corners]]), np.append(BOX.materials, 1))
    assert fit_grid(scene_with(SceneObject("box", mesh)), depth=4).voxel_size == 1
    alone = Mesh(positions[8:], [[0, 1, 2]], [1])
    assert fit_grid(scene_with(SceneObject("line", alone)), depth=1).voxel_size == 3


def test_what_stretches_no_grid_is_no_stray_part():
    line = Mesh([[900, 0, 0], [900, 0, 0], [0, 0, 0]], [[0, 1, 2]], [1])
    scene = scene_with(SceneObject("body", joined(BOX, line)))
    assert fit_grid(scene, depth=4).voxel_size == 1
    assert find_stray_parts(scene, "auto") is None
    alone = scene_with(SceneObject("body", BOX), SceneObject("line", line))
    assert find_stray_parts(alone, "auto").names == ("line",)
