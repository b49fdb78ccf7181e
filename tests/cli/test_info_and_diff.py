"""``voxrt info`` and ``voxrt diff``: what a memory holds, and what sets two apart."""

from __future__ import annotations

import json

import msgspec
import numpy as np
import pytest

from voxrt import Material, Rom
from voxrt.cli.results.memory_results import DiffResult, InfoResult
from voxrt.export import write_rom
from voxrt.octree import BOARDS, Region, from_dense
from voxrt.voxelize import EMPTY, Grid


@pytest.fixture
def worlds(folder):
    """Two memories of 8 voxels per side: an octant and a voxel; the same with the voxel elsewhere, another material."""
    names = (EMPTY, Material("stone", (200, 100, 50)), Material("glass", (1, 2, 3)))
    for name, place in (("before", (7, 0, 0)), ("after", (7, 7, 0))):
        world = np.zeros((8, 8, 8), np.uint8)
        world[:4, :4, :4] = 1
        world[place] = 2
        world[0, 0, 0] = 1 + (name == "after")
        write_rom(folder, Rom(name, from_dense(world), names, Grid(3, (1.0, 2.0, 3.0), 0.5)))
    return folder


@pytest.mark.usefixtures("worlds")
def test_info(voxrt):
    finished = voxrt.succeeds("info", "before.mem", "--json")
    result = msgspec.json.decode(finished.out, type=InfoResult, strict=True)
    assert (result.name, result.depth, result.words, result.blocks, result.voxels) == ("before", 3, 25, 3, 65)
    assert result.world is not None
    assert (result.world.origin, result.world.voxel_size) == ((1, 2, 3), 0.5)
    assert [(row.level, row.solid, row.empty) for row in result.levels] == [(3, 0, 0), (2, 1, 6), (1, 0, 7), (0, 1, 7)]
    assert result.bounds == ((0, 0, 0), (8, 4, 4))
    assert {board.name: board.fits for board in result.boards} == dict.fromkeys(BOARDS, True)
    assert [(row.id, row.name, row.voxels) for row in result.materials] == [
        (0, "empty", 512 - 65),
        (1, "stone", 64),
        (2, "glass", 1),
    ]


@pytest.mark.usefixtures("worlds")
def test_info_for_people(voxrt):
    finished = voxrt("info", "before.mem")
    assert (finished.code, finished.err) == (0, "")
    lines = [line.split() for line in finished.out.splitlines()]
    assert ["memory", "25", "words,", "0.1", "KiB;", "25", "words", "without", "sharing"] in lines
    assert ["1", "stone", "#c86432", "64"] in lines


@pytest.mark.usefixtures("worlds")
def test_diff(voxrt):
    finished = voxrt.succeeds("diff", "before.mem", "after.mem", "--json")
    result = msgspec.json.decode(finished.out, type=DiffResult, strict=True)
    regions = (
        Region(((0, 0, 0), (1, 1, 1)), 0, 0, 1),
        Region(((7, 0, 0), (8, 1, 1)), 0, 1, 0),
        Region(((7, 7, 0), (8, 8, 1)), 1, 0, 0),
    )
    assert result == DiffResult(3, 1, 1, 1, ((0, 0, 0), (8, 8, 1)), regions)


@pytest.mark.usefixtures("worlds")
def test_diff_tells_people_where(voxrt):
    lines = [line.split() for line in voxrt("diff", "before.mem", "after.mem").out.splitlines()]
    assert ["differ", "3", "voxels"] in lines
    assert ["region", "7,7,0", "up", "to", "8,8,1:", "1", "appeared"] in lines


def test_diff_tells_people_of_every_region(voxrt, folder):
    world = np.zeros((16, 16, 16), np.uint8)
    write_rom(folder, Rom("none", from_dense(world), (EMPTY, Material("stone", (9, 9, 9)))))
    world[:2, :2, 4:10] = 1
    world[4:16:2, 4:16:2, 15] = 1
    write_rom(folder, Rom("many", from_dense(world), (EMPTY, Material("stone", (9, 9, 9)))))
    out = voxrt("diff", "none.mem", "many.mem").out
    assert "0,0,4 up to 2,2,10: 24 appeared" in out
    assert out.count("region") == 37


@pytest.mark.usefixtures("worlds")
def test_diff_finds_nothing(voxrt):
    assert json.loads(voxrt("diff", "before.mem", "before.mem", "--json").out)["voxels"] == 0


def test_diff_of_two_depths(voxrt, worlds):
    write_rom(worlds, Rom("small", from_dense(np.ones((4, 4, 4), np.uint8)), (EMPTY, Material("stone", (0, 0, 0)))))
    voxrt.fails(2, "depth 3", "diff", "before.mem", "small.mem")


@pytest.mark.parametrize("command", ["info", "diff"])
def test_no_memory(voxrt, command):
    voxrt.fails(3, "nothing.mem", command, *["nothing.mem"] * (1 + (command == "diff")))
