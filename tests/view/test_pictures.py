"""The octants as cells, and pictures of them."""

from __future__ import annotations

import ctypes
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from oracles.octree import unshared_words, walk
from oracles.random_worlds import dense_cubes
from PIL import Image

from voxrt import octree, view
from voxrt.octree.leaf_arrays import Leaves
from voxrt.view.sides import covered_sides
from voxrt.voxelize import EMPTY, DoesNotFitError, Material

RED, GREEN, BLUE = (220, 40, 40), (40, 200, 60), (50, 90, 230)
COLOURS = (RED, GREEN, BLUE)


def rom_of(cube):
    colours = [COLOURS[material % 3] for material in range(255)]
    materials = (EMPTY, *(Material(f"m{number}", colour) for number, colour in enumerate(colours, 1)))
    return octree.Rom("world", octree.from_dense(cube), materials)


def all_leaves(tree):
    parts = list(octree.leaves(tree, solid_only=True, chunk=7))
    return Leaves(
        *(
            np.concatenate([np.zeros(shape, kind), *(getattr(part, name) for part in parts)])
            for name, shape, kind in (("corners", (0, 3), int), ("levels", 0, np.uint8), ("materials", 0, np.uint8))
        )
    )


@given(dense_cubes(max_depth=4))
def test_sides_are_covered_where_solid_voxels_are_all_along_them(cube):
    for words in (octree.from_dense(cube).words, unshared_words(cube)):
        solid = all_leaves(octree.decode(words, "report", len(cube).bit_length() - 1))
        padded = np.pad(cube != 0, 1)
        expected = []
        for corner, level in zip(solid.corners, solid.levels, strict=True):
            low, high = corner + 1, corner + 1 + (1 << int(level))
            inside = [slice(a, b) for a, b in zip(low, high, strict=True)]
            expected.append(
                [
                    padded[tuple(plane if axis == n else inside[n] for n in range(3))].all()
                    for axis in range(3)
                    for plane in (low[axis] - 1, high[axis])
                ]
            )
        np.testing.assert_array_equal(covered_sides(solid), np.reshape(expected, (-1, 6)))


def test_sides_at_the_far_end_of_the_largest_world():
    last = (1 << 16) - 1
    corners = np.array([[last - 1, last, last], [last, last, last]], np.int32)
    alike = np.zeros(2, np.uint8)
    assert covered_sides(Leaves(corners, alike, alike + 1)).sum(axis=0).tolist() == [1, 1, 0, 0, 0, 0]


@given(cube=dense_cubes())
@pytest.mark.usefixtures("_pyvista")
def test_cells_are_the_octants(cube):
    grid = view.octants(rom_of(cube), surface=False)
    sides = 1 << grid.cell_data["level"].astype(int)
    assert (sides**3).sum() == np.count_nonzero(cube)
    assert grid.field_data["hidden"].tolist() == [0]
    assert set(grid.celltypes.tolist()) <= {11}
    lowest = grid.points[grid.cells.reshape(-1, 9)[:, 1]].astype(int)
    seen = np.zeros_like(cube)
    for corner, side, material in zip(lowest, sides, grid.cell_data["material"], strict=True):
        box = tuple(slice(a, a + side) for a in corner)
        assert not seen[box].any()
        seen[box] = material
    np.testing.assert_array_equal(seen, cube)
    words = octree.from_dense(cube).words[grid.cell_data["address"]]
    np.testing.assert_array_equal(words, grid.cell_data["material"].astype(np.uint32) | 0xFFFFFF00)
    if cube.any():
        volumes = grid.compute_cell_sizes(length=False, area=False)["Volume"]
        np.testing.assert_array_equal(volumes, sides**3)
        filled = np.argwhere(cube)
        ends = np.stack([filled.min(axis=0), filled.max(axis=0) + 1], axis=1)
        np.testing.assert_array_equal(np.reshape(grid.bounds, (3, 2)), ends)


@given(cube=dense_cubes())
@pytest.mark.usefixtures("_pyvista")
def test_octants_shown_and_hidden_are_all(cube):
    rom = rom_of(cube)
    every, shown = view.octants(rom, surface=False), view.octants(rom)
    assert shown.n_cells + shown.field_data["hidden"][0] == every.n_cells
    half = view.octants(rom, high=(len(cube), len(cube) // 2, len(cube)), surface=False)
    assert half.n_cells <= every.n_cells


@given(dense_cubes(max_depth=4))
def test_octant_at_a_voxel(cube):
    tree = octree.from_dense(cube)
    for voxel in np.ndindex(2, 2, 2):
        place = tuple(int(v) * (tree.size - 1) for v in voxel)
        octant = octree.octant_at(tree, place)
        assert octant.word == tree.words[octant.address] == 0xFFFFFF00 | walk(tree.words, tree.depth, place)
        assert all(a <= p < b for a, p, b in zip(octant.corner, place, octant.end, strict=True))
        box = tuple(slice(a, b) for a, b in zip(octant.corner, octant.end, strict=True))
        assert (cube[box] == octant.material).all()
        assert octant.end[0] - octant.corner[0] == 1 << octant.level


def test_no_octant_outside():
    tree = octree.from_dense(np.ones((2, 2, 2), np.uint8))
    with pytest.raises(ValueError, match="outside the world of 2 voxels"):
        octree.octant_at(tree, (0, 2, 0))


def three_towers():
    cube = np.zeros((16, 16, 16), np.uint8)
    for number, height in enumerate((4, 12, 8)):
        cube[5 * number : 5 * number + 4, :height, :4] = number + 1
    return cube


def test_description():
    assert view.Pane(rom_of(three_towers())).describe((1, 2, 3)).splitlines()[1:] == [
        "word 0xFFFFFF01",
        "level 2: 4x4x4 voxels",
        "voxels x 0...3, y 0...3, z 0...3",
        "material 1: m1",
    ]


@given(cube=dense_cubes(max_depth=4), data=st.data())
@pytest.mark.usefixtures("_pyvista")
def test_a_cut_goes_through_octants(cube, data):
    high = data.draw(st.tuples(*[st.integers(1, len(cube))] * 3))
    grid = view.octants(rom_of(cube), high=high, cut=True)
    every = view.octants(rom_of(cube), high=high, cut=True, surface=False)
    left = cube[tuple(slice(end) for end in high)]
    assert grid.n_cells + grid.field_data["hidden"][0] == every.n_cells
    volumes = every.compute_cell_sizes(length=False, area=False)["Volume"] if every.n_cells else np.zeros(0)
    assert round(volumes.sum()) == np.count_nonzero(left)
    # What can be seen closes: each open side's area, by direction, is that of the voxels left.
    sides, cells = view.open_sides(every)
    points = np.asarray(every.points, float).reshape(-1, 3)
    corner, right, _, up = (points[sides[:, i]] for i in range(4))
    facing = np.cross(right - corner, up - corner) if len(sides) else np.zeros((0, 3))
    assert (facing.sum(axis=0) == 0).all() or len(set(every.cell_data["level"].tolist())) > 1
    padded = np.pad(left != 0, 1)
    for axis in range(3):
        for direction in (-1, 1):
            seen = np.count_nonzero(padded & ~np.roll(padded, -direction, axis))
            assert np.maximum(direction * facing[:, axis], 0).sum() >= seen
    assert set(cells.tolist()) <= set(range(every.n_cells))


@given(cube=dense_cubes(max_depth=4))
def test_owners_of_octants(cube):
    owned = octree.Owners(octree.from_dense(cube), tuple(f"object {n}" for n in range(255)))
    tree = octree.from_dense((cube != 0).astype(np.uint8))  # fewer, larger octants
    solid = all_leaves(tree)
    for corner, level, owner in zip(solid.corners, solid.levels, owned.of(solid), strict=True):
        voxels = cube[tuple(slice(c, c + (1 << int(level))) for c in corner)]
        assert owner == (int(voxels[0, 0, 0]) - 1 if (voxels == voxels[0, 0, 0]).all() else -1)
        assert owned.name_at(tuple(corner.tolist())) == f"object {voxels[0, 0, 0] - 1}"


def share_of(pixels, colour):
    """The part of a picture's pixels that have a colour's hue."""
    flat = np.asarray(pixels, float).reshape(-1, 3)
    bright = flat[flat.max(axis=1) > 60]
    directions = bright / np.linalg.norm(bright, axis=1, keepdims=True)
    return np.count_nonzero(directions @ (np.array(colour) / np.linalg.norm(colour)) > 0.999) / len(flat)


@pytest.mark.usefixtures("_canvas")
def test_a_picture_shows_the_materials_colours(tmp_path):
    view.plot(rom_of(three_towers()), size=(320, 240), screenshot=tmp_path / "towers.png")
    with Image.open(tmp_path / "towers.png") as picture:
        pixels = np.asarray(picture.convert("RGB"))
    assert picture.size == (320, 240)
    for colour in COLOURS:
        assert share_of(pixels, colour) > 0.004
    background = (np.abs(pixels.astype(int) - EMPTY.colour) <= 2).all(axis=2)
    assert 0.2 < background.mean() < 0.95


@pytest.mark.usefixtures("_canvas")
def test_two_memories_are_shown_side_by_side():
    towers = rom_of(three_towers())
    red = replace(towers, octree=octree.from_dense((three_towers() != 0).astype(np.uint8)))
    both = view.picture([view.Pane(towers), view.Pane(red)], (320, 120))
    left, right = both[:, :160], both[:, 160:]
    assert share_of(left, GREEN) > 0.004
    assert share_of(right, GREEN) == 0
    assert share_of(right, RED) > 2 * share_of(left, RED)


@pytest.mark.usefixtures("_canvas")
def test_levels_and_owners_have_colours_of_their_own():
    rom = rom_of(three_towers())
    owners = octree.Owners(rom.octree, ("low", "high", "middle"))
    pictures = [
        view.picture([view.Pane(rom, by=by, owners=owners)], (160, 120)) for by in ("material", "level", "owner")
    ]
    for first, second in ((0, 1), (0, 2), (1, 2)):
        assert (pictures[first] != pictures[second]).any()


@pytest.mark.usefixtures("_canvas")
def test_a_mesh_is_drawn_over_the_octants():
    rom = rom_of(three_towers())
    triangle = np.array([[[0.0, 0, 16], [16, 0, 16], [8, 16, 16]]])
    plain, covered = (view.picture([view.Pane(rom, triangles=triangles)], (160, 120)) for triangles in (None, triangle))
    assert 0.001 < (plain != covered).any(axis=2).mean() < 0.3


@pytest.mark.usefixtures("_canvas")
def test_an_empty_world_can_be_shown():
    rom = rom_of(np.zeros((4, 4, 4), np.uint8))
    assert view.octants(rom).n_cells == 0
    for by in ("material", "level"):
        assert view.picture([view.Pane(rom, by=by)], (64, 48)).shape == (48, 64, 3)
    assert len(list(view.turntable([view.Pane(rom)], (64, 48), 2))) == 2


@pytest.mark.usefixtures("_canvas")
def test_a_turntable_comes_around():
    cube = three_towers()
    cube = np.maximum(cube, np.where(cube[::-1, :, ::-1], cube[::-1, :, ::-1], 0))  # alike after half a turn
    pictures = list(view.turntable([view.Pane(rom_of(cube))], (120, 90), 4))
    shapes = [(picture[20:] != EMPTY.colour).any(axis=2) for picture in pictures]
    assert np.mean(shapes[0] != shapes[1]) > 0.01
    assert np.mean(shapes[0] != shapes[2]) < 0.01
    assert np.mean(shapes[1] != shapes[3]) < 0.01


def test_too_many_octants(monkeypatch):
    monkeypatch.setattr(sys.modules["voxrt.octree.leaf_arrays"], "LEAF_LIMIT", 3)
    with pytest.raises(DoesNotFitError, match="more than 3 octants"):
        view.Pane(rom_of(three_towers())).solid()


def test_without_pyvista(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(view.ViewerError, match=r"pip install pyvista"):
        view.octants(rom_of(three_towers()))


@pytest.mark.skipif(sys.platform != "linux", reason="other systems bring their own")
@pytest.mark.usefixtures("_pyvista")
def test_without_a_library_to_draw_by(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr(ctypes, "CDLL", lambda name: (_ for _ in ()).throw(OSError(name)))
    with pytest.raises(view.ViewerError, match="apt install libegl1"):
        view.picture([view.Pane(rom_of(three_towers()))], (64, 48))
