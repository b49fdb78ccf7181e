"""The octants as cells, and pictures of them."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from hypothesis import given
from oracles.octree import unshared_words, walk
from oracles.random_worlds import dense_cubes
from PIL import Image

from voxrt import octree
from voxrt.octree.hidden import hidden_leaves
from voxrt.octree.leaves import Leaves
from voxrt.voxelize import EMPTY, DoesNotFitError, Material

RED, GREEN, BLUE = (220, 40, 40), (40, 200, 60), (50, 90, 230)
COLOURS = (RED, GREEN, BLUE)


def rom_of(cube):
    colours = [COLOURS[material % 3] for material in range(255)]
    materials = (EMPTY, *(Material(f"m{number}", colour) for number, colour in enumerate(colours, 1)))
    return octree.Rom("world", octree.from_dense(cube), materials)


@pytest.fixture(scope="module")
def _pyvista():
    pytest.importorskip("pyvista", reason="the extra voxrt[view] is not installed")


def all_leaves(tree):
    parts = list(octree.leaves(tree, solid_only=True, chunk=7))
    return Leaves(
        *(
            np.concatenate([np.zeros(shape, kind), *(getattr(part, name) for part in parts)])
            for name, shape, kind in (("corners", (0, 3), int), ("levels", 0, np.uint8), ("materials", 0, np.uint8))
        )
    )


@given(dense_cubes(max_depth=4))
def test_hidden_octants_are_those_with_solid_voxels_all_around(cube):
    for words in (octree.from_dense(cube).words, unshared_words(cube)):
        solid = all_leaves(octree.decode(words, "report", len(cube).bit_length() - 1))
        padded = np.pad(cube != 0, 1)
        expected = []
        for corner, level in zip(solid.corners, solid.levels, strict=True):
            low, high = corner + 1, corner + 1 + (1 << int(level))
            expected.append(padded[tuple(slice(a - 1, b + 1) for a, b in zip(low, high, strict=True))].all())
        assert hidden_leaves(solid).tolist() == expected


def test_hidden_octants_at_the_far_end_of_the_largest_world():
    last = (1 << 16) - 1
    corners = np.array([[last - 1, last, last], [last, last, last]], np.int32)
    alike = np.zeros(2, np.uint8)
    assert hidden_leaves(Leaves(corners, alike, alike + 1)).tolist() == [False, False]


@given(cube=dense_cubes())
@pytest.mark.usefixtures("_pyvista")
def test_cells_are_the_octants(cube):
    grid = octree.octants(rom_of(cube), surface=False)
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
    every, shown = octree.octants(rom, surface=False), octree.octants(rom)
    assert shown.n_cells + shown.field_data["hidden"][0] == every.n_cells
    half = octree.octants(rom, high=(len(cube), len(cube) // 2, len(cube)), surface=False)
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
    assert octree.describe(rom_of(three_towers()), (1, 2, 3)).splitlines()[1:] == [
        "word 0xFFFFFF01",
        "level 2: 4x4x4 voxels",
        "voxels x 0...3, y 0...3, z 0...3",
        "material 1: m1",
    ]


@pytest.mark.usefixtures("_pyvista")
def test_a_picture_shows_the_materials_colours(tmp_path):
    octree.plot(rom_of(three_towers()), size=(320, 240), screenshot=tmp_path / "towers.png")
    with Image.open(tmp_path / "towers.png") as picture:
        pixels = np.asarray(picture.convert("RGB"), float).reshape(-1, 3)
    assert picture.size == (320, 240)
    bright = pixels[pixels.max(axis=1) > 60]
    directions = bright / np.linalg.norm(bright, axis=1, keepdims=True)
    for colour in COLOURS:
        alike = directions @ (np.array(colour) / np.linalg.norm(colour)) > 0.999
        assert np.count_nonzero(alike) > 300
    background = (np.abs(pixels - EMPTY.colour) <= 2).all(axis=1)
    assert 0.2 < background.mean() < 0.95


@pytest.mark.usefixtures("_pyvista")
def test_levels_have_colours_of_their_own():
    rom = rom_of(three_towers())
    grid = octree.octants(rom)
    by_level = octree.picture(rom, grid, by="level", size=(160, 120))
    assert by_level.shape == (120, 160, 3)
    assert (by_level != octree.picture(rom, grid, size=(160, 120))).any()


@pytest.mark.usefixtures("_pyvista")
def test_an_empty_world_can_be_shown():
    rom = rom_of(np.zeros((4, 4, 4), np.uint8))
    grid = octree.octants(rom)
    assert grid.n_cells == 0
    assert octree.picture(rom, grid, size=(64, 48)).shape == (48, 64, 3)


@pytest.mark.usefixtures("_pyvista")
def test_too_many_octants(monkeypatch):
    monkeypatch.setattr(sys.modules["voxrt.octree.octants"], "OCTANT_LIMIT", 3)
    with pytest.raises(DoesNotFitError, match="world: more than 3 octants"):
        octree.octants(rom_of(three_towers()))


def test_without_pyvista(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(octree.ViewerError, match=r"pip install 'voxrt\[view\]'"):
        octree.octants(rom_of(three_towers()))
