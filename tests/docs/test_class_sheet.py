"""The class sheet: its commands print what it shows, and its answers are what voxrt and whole numbers say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from fakes.commands import EXAMPLES

import voxrt as api

SHEET = (Path(__file__).resolve().parents[2] / "docs" / "class-sheet.md").read_text(encoding="utf-8")
TEXT = " ".join(SHEET.split())
COMMANDS = [
    (words.split(), shown.splitlines())
    for block in re.findall(r"```console\n(.*?)```", SHEET, re.DOTALL)
    for words, shown in re.findall(r"\$ voxrt (.*)\n((?:  .*\n)*)", block)
]


def test_the_commands_print_what_the_sheet_shows(voxrt, folder):
    verilated = pytest.importorskip("voxrt.sim._rtl", reason="there is no verilated ray tracer")
    (folder / "examples").symlink_to(EXAMPLES)
    assert len(COMMANDS) >= 9
    for words, shown in COMMANDS:
        if "--config" in words and words[-1] not in verilated.CONFIGS:
            continue
        done = voxrt.succeeds(*words)
        printed = iter((done.out + done.err).splitlines())
        for line in shown:  # in this order, with others between them
            begin = line.removesuffix("...")
            assert any(one.startswith(begin) and (begin != line or one == line) for one in printed), (words, line)


@pytest.fixture(scope="module")
def courtyard():
    return {depth: api.build(EXAMPLES / "courtyard.glb", depth=depth) for depth in (4, 5, 6, 7)}


@pytest.fixture(scope="module")
def house():
    return {depth: api.build(EXAMPLES / "house.obj", depth=depth) for depth in (4, 5, 6)}


@pytest.fixture(scope="module")
def small():
    import quadtree

    rows = re.findall(r"^    y = \d   (.*)$", SHEET, re.MULTILINE)
    return quadtree.build([row.replace(" ", "") for row in rows])


def test_growth_of_the_courtyard(courtyard):
    words = {depth: len(built.octree.words) for depth, built in courtyard.items()}
    solid = {depth: built.solid_voxels for depth, built in courtyard.items()}
    for depth in courtyard:
        cells = f"{8**depth:,}"
        assert f"| {depth} | {2**depth} | {cells} | {solid[depth]:,} | {words[depth]:,} |" in TEXT
    assert f"solid voxels by {solid[7] / solid[6]:.1f}, words by {words[7] / words[6]:.1f}." in TEXT
    assert f"4 · {words[7]:,} = {4 * words[7]:,} bytes, so it is {8**7 / (4 * words[7]):.0f} times smaller" in TEXT
    unshared = [1 + 8 * api.rom_info(courtyard[depth].rom).unshared_blocks for depth in (6, 7)]
    assert words[7] / words[6] < unshared[1] / unshared[0] < 4


def test_words_of_the_small_world(small):
    shown = {0xFFFFFF00: "empty", 0xFFFFFF01: "material 1", 0xFFFFFF03: "material 3", 5: "a pointer to block 5"}
    assert small[0] == 1
    for first in (1, 5):
        names = [shown[word] for word in small[first : first + 4]]
        assert f"ords {first} to {first + 3}: {', '.join(names)}." in TEXT
    assert f"That is {len(small)} words, of which {sum(word >> 31 for word in small)} are leaves" in TEXT


def test_rays_in_the_small_world(small):
    import quadtree

    times = [[quadtree.crossing_time((4, 20), (2, 3), axis, line + axis) for line in (1, 2, 3)] for axis in (0, 1)]
    assert (
        f"T of x = 1, 2, 3 is {', '.join(map(str, times[0]))}. T of y = 2, 3, 4 is {', '.join(map(str, times[1]))}."
        in TEXT
    )
    crossings = sorted(
        (time, f"{'xy'[axis]} = {line + axis + 1}") for axis in (0, 1) for line, time in enumerate(times[axis])
    )
    assert f"The order is {', '.join(line for _, line in crossings)}." in TEXT
    first, second = (quadtree.follow(small, 2, *ray) for ray in (((4, 20), (2, 3)), ((2, 40), (3, 2))))
    assert [one.address for one in first] == [1, 3, 5, 6, 8, 4]
    assert all(one.word in {0xFFFFFF00, 5} for one in first)
    assert [one.address for one in second] == [3, 5, 7]
    assert (second[-1].word & 0xFF, second[-1].key) == (3, (24, 1))


def test_the_house(house):
    words = house[5].octree.words
    assert [int(word) for word in words[:9]] == [1, *range(9, 66, 8)]
    unshared = 1 + 8 * api.rom_info(house[5].rom).unshared_blocks
    assert f"{len(words):,} words in place of {unshared:,}, which is {unshared / len(words):.1f}" in TEXT
    reads = []
    for built in house.values():
        camera = api.aim_camera(built.rom, (640, 480))
        reads.append(len(api.sim.follow_pixel(built.octree, camera, (640, 480), (320, 240)).readings))
    assert reads == [10, 14, 18]


def test_numbers_of_the_machine():
    assert (350155239672).bit_length() == 39
    assert "T = 350,155,239,672 lies between 2³⁸ and 2³⁹" in TEXT
    assert 2 ** (39 - 24) == 32768
    assert f"= {1e8 / (320 * 240 * 6.19):.0f} pictures per second" in TEXT
    assert f"= {1e8 / (640 * 480 * 60):.1f} cycles per pixel are left" in TEXT
