"""Bad values are refused in one line before anything is done; exact conversions are made."""

from __future__ import annotations

import numpy as np
import pytest

import voxrt
from voxrt import BuildOptions, export, octree, sim
from voxrt.octree import Octree, Rom, from_points
from voxrt.voxelize import EMPTY, DoesNotFitError, Grid, Material

TREE = from_points([[1, 2, 3]], [1], 2)
ROM = Rom("dot", TREE, (EMPTY, Material("red", (255, 0, 0))))
CAMERA = sim.frame_scene(ROM, (8, 8))


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("engine", "gpu", "engine must be 'rtl' or 'model', not 'gpu'"),
        ("fill", "half", "fill must be 'solid', 'surface', 'auto' or 'together'"),
        ("geometry", None, "geometry must be"),
        ("dialect", "vhdl", "dialect must be"),
        ("up", "w", "up must be 'x', 'y' or 'z'"),
        ("depth", 0, "depth must be an integer 1 … 16, not 0"),
        ("depth", 7.5, "depth must be an integer 1 … 16, not 7.5"),
        ("depth", "7", "depth must be an integer"),
        ("voxel_size", 0, "voxel_size must be a finite number above 0"),
        ("voxel_size", float("nan"), "voxel_size must be a finite number"),
        ("unit", -1, "unit must be"),
        ("time", "now", "time must be"),
        ("colours", 255, "colours must be an integer 1 … 254, not 255"),
        ("budget", 0, "budget must be an integer"),
        ("budget", "abacus", "budget must be 'icepi-zero', 'pynq-z1', .* or 'ulx3s-85f-sdram'"),
        ("interior", 300, "interior must be an integer 1 … 255, not 300"),
        ("size", (0, 5), r"size\[0\] must be an integer 1 … 16384, not 0"),
        ("size", 640, "size must be a width and a height"),
        ("size", (640.5, 480), r"size\[0\] must be"),
        ("variants", "red", "variants must be a sequence of strings"),
        ("variants", [1], r"variants\[0\] must be a string"),
        ("strict", "yes", "strict must be True or False"),
        ("preview", 3, "preview must be True or False"),
        ("threads", -1, "threads must be"),
        ("animation", 0, "animation must be a string"),
    ],
)
def test_options(option, value, message):
    with pytest.raises((ValueError, TypeError), match=f"^{message}") as refused:
        BuildOptions(**{option: value})
    assert "\n" not in str(refused.value)
    with pytest.raises((ValueError, TypeError), match=f"^{message}"):
        voxrt.build("examples/house.obj", **{option: value})


def test_depth_and_voxel_size_exclude_each_other():
    with pytest.raises(ValueError, match="depth and voxel_size exclude each other"):
        BuildOptions(depth=3, voxel_size=0.5)


def test_unknown_options():
    with pytest.raises(TypeError, match="depht"):
        voxrt.build("examples/house.obj", depht=3)


def test_exact_conversions_are_made():
    options = BuildOptions(depth=np.int64(7), size=[64.0, np.uint16(48)], variants=["red"], voxel_size=None, time=1)
    assert (options.depth, options.size, options.variants, options.time) == (7, (64, 48), ("red",), 1.0)
    assert type(options.depth) is int
    assert octree.from_dense([[[1.0, 0], [0, 2]]]).depth == 1
    assert octree.material_at(TREE, [[1.0, 2.0, 3.0]]).tolist() == [1]
    assert octree.to_dense(TREE, [1, 2, 3], np.array([2.0, 3, 4])).tolist() == [[[1]]]
    assert sim.follow_ray(TREE, [24.0, 40.0, 0.0], np.array([0, 0, 1])).cell == (1, 2, 3)
    assert Rom("dot", TREE, [EMPTY, Material("red", (255, 0, 0))]).materials == ROM.materials


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: voxrt.render(TREE), TypeError, "rom must be a Rom, not Octree"),
        (lambda: voxrt.render(ROM, engine="gpu"), ValueError, "engine must be 'rtl' or 'model'"),
        (lambda: voxrt.render(ROM, size=(0, 5), engine="model"), ValueError, r"size\[0\] must be an integer"),
        (
            lambda: voxrt.render(ROM, size=(5,), engine="model"),
            ValueError,
            "size must be a width and a height in pixels",
        ),
        (lambda: sim.render(ROM, CAMERA, (8, 8), engine="model", threads=-1), ValueError, "threads must be"),
        (lambda: sim.frame_scene(TREE, (8, 8)), TypeError, "rom must be a Rom"),
        (lambda: voxrt.aim_camera(ROM, (8, 8), look=(0, 0, 0.5)), ValueError, r"look\[2\] must be an integer"),
        (lambda: voxrt.aim_camera(ROM, (8, 8), look=(0, 0, 1 << 15)), ValueError, r"look\[2\] must be an integer"),
        (lambda: sim.follow_ray(TREE, (0, 0, 0.5), (1, 0, 0)), ValueError, r"origin\[2\] must be an integer"),
        (lambda: sim.follow_ray(TREE, (0, 0, 0), (1, 0.5, 0)), ValueError, r"direction\[1\] must be an integer"),
        (lambda: sim.follow_ray(TREE, (0, 0, 0), (0, 0, 0)), ValueError, "direction must not be zero"),
        (lambda: sim.follow_ray(ROM, (0, 0, 0), (1, 0, 0)), TypeError, "octree must be a Octree"),
        (lambda: sim.follow_pixel(TREE, CAMERA, (8, 8), (1.5, 0)), ValueError, r"pixel\[0\] must be an integer"),
        (lambda: octree.material_at(TREE, [[0.5, 1, 1]]), ValueError, r"points\[0, 0\] must be an integer"),
        (lambda: octree.material_at(TREE, [[1, 1]]), ValueError, r"points must have shape \(..., 3\)"),
        (lambda: octree.octant_at(TREE, (0, 0, 1.5)), ValueError, r"voxel\[2\] must be an integer"),
        (lambda: octree.count_in_box(TREE, (0, 0), (1, 1)), ValueError, r"low must have shape \(3,\)"),
        (lambda: octree.count_in_box(TREE, (2, 0, 0), (1, 1, 1)), ValueError, "the box ends at"),
        (lambda: octree.leaves(TREE, (2, 0, 0), (1, 1, 1)), ValueError, "the box ends at"),
        (lambda: octree.leaves(TREE, chunk=0), ValueError, "chunk must be an integer"),
        (lambda: octree.coarsen(TREE, -1), ValueError, "level must be an integer 0 … 2, not -1"),
        (lambda: octree.coarsen(TREE, 1.5), ValueError, "level must be an integer"),
        (lambda: octree.fit(TREE, 0), ValueError, "words must be an integer"),
        (lambda: octree.fit(TREE, 100, colours=[[0, 0, 300]]), ValueError, r"colours\[0, 2\] must be"),
        (lambda: octree.fill_hidden(TREE, TREE, 300), ValueError, "material must be an integer 1 … 255, not 300"),
        (lambda: octree.from_points([[0, 0, 0]], [300], 2), ValueError, r"materials\[0\] must be an integer 1 … 255"),
        (lambda: octree.from_points([[0, 0, 9]], [1], 2), ValueError, r"points\[0, 2\] must be an integer 0 … 3"),
        (lambda: octree.from_dense(np.ones((2, 2, 2), bool)), TypeError, "materials must be an array of integers"),
        (lambda: octree.census(ROM), TypeError, "octree must be a Octree"),
        (lambda: octree.diff(TREE, ROM), TypeError, "second must be a Octree"),
        (lambda: Rom("dot", TREE, (EMPTY,)), ValueError, "materials end at id 0, and the octree uses 1"),
        (lambda: Rom("dot", TREE, ()), ValueError, "materials must have 1 to 256 entries"),
        (lambda: Rom("dot", TREE.words, ROM.materials), TypeError, "octree must be a Octree"),
        (lambda: Rom("dot", TREE, ROM.materials, Grid(3, (0, 0, 0), 1.0)), ValueError, "grid has depth 3"),
        (lambda: export.default_materials(300), ValueError, "highest must be an integer 0 … 255, not 300"),
        (lambda: voxrt.convert(TREE, "a.mem"), TypeError, "memory must be a Rom"),
        (lambda: voxrt.build(7), TypeError, "asset must be a file's path, a Scene"),
        (
            lambda: voxrt.build(np.eye(3), [[0, 1, 2]]),
            TypeError,
            r"asset must be .*, not ndarray; for arrays: build\(\(vertices, faces\)\), or voxelize_mesh",
        ),
        (lambda: voxrt.build([np.eye(3), [[0, 1, 2]]]), TypeError, "asset must be .*, not list; for arrays: build"),
        (
            lambda: voxrt.build((np.eye(3), [[0, 1, 2]], (255, 0, 0))),
            TypeError,
            "asset must be .*, not tuple; for arra",
        ),
        (lambda: voxrt.build("a.obj", 8), TypeError, "output must be the path of a folder or of a file, not int"),
        (lambda: voxrt.build("a.obj", options={"depth": 3}), TypeError, "options must be a BuildOptions"),
        (lambda: voxrt.save_picture(np.zeros((4, 4)), "a.png"), ValueError, "picture must have shape"),
    ],
)
def test_arguments(call, error, message):
    with pytest.raises(error, match=f"^{message}") as refused:
        call()
    assert "\n" not in str(refused.value)


def test_large_arrays_are_made_only_if_asked_for():
    wide = Octree(11, np.array([0xFFFFFF01], np.uint32))
    with pytest.raises(DoesNotFitError, match=r"takes 8,589,934,592 bytes \(8\.0 GiB\).*limit=8589934592") as refused:
        octree.to_dense(wide)
    assert "low, high" in str(refused.value)
    with pytest.raises(DoesNotFitError, match="octants instead"):
        octree.to_points(wide)
    assert octree.to_dense(wide, (5, 5, 5), (7, 7, 7)).tolist() == np.ones((2, 2, 2)).tolist()
    with pytest.raises(DoesNotFitError, match="limit=64"):
        octree.to_dense(TREE, limit=63)
    assert octree.to_dense(TREE, limit=64).shape == (4, 4, 4)


def test_an_option_that_is_not_there_is_named():
    with pytest.raises(TypeError, match=r"build\(\) has no option 'fil'; it has .*fill"):
        voxrt.build("any.obj", fil="solid")


@pytest.mark.parametrize("grid", [{"depth": 4, "bounds": (0, 0, 0, 1e300, 1, 1)}, {"voxel_size": 1e200}])
def test_grids_whose_squares_overflow_are_empty(grid):
    corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]
    with pytest.raises(DoesNotFitError, match="the memory is empty"):
        voxrt.build((corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]), **grid)
