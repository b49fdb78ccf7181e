"""The owner's page names each board as its description does, and prints what the command prints."""

from __future__ import annotations

import re
from pathlib import Path

from fakes.commands import EXAMPLES

import voxrt
from voxrt.board.designs.build import board_names, read_board
from voxrt.boards.bitstream import read_board as read_placed

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "your-board.md").read_text(encoding="utf-8")


def test_each_board_is_in_the_table():
    assert set(re.findall(r"^\| .*\| `([\w-]+)` \|", PAGE, re.MULTILINE)) == set(board_names())
    assert f"**revision {read_board('icepi-zero')['revision']}**" in PAGE


def test_the_output_shown_is_that_of_the_design():
    placed = read_placed("ulx3s-85f")
    design = placed.design
    house = voxrt.build(EXAMPLES / "house.obj", budget=design.capacity).rom.octree
    assert f"  board      {placed.title}, {design.core['Lanes']} lanes, {design.clock_hz / 1e6:.1f} MHz\n" in PAGE
    assert f"  scene      {len(house.words):,} of {design.capacity:,} words, depth {house.depth}\n" in PAGE
    courtyard = voxrt.build(EXAMPLES / "courtyard.glb", depth=6).rom.octree
    assert f"courtyard.mem: loaded\n  words      {len(courtyard.words)}\n" in PAGE
    assert len(house.words) + len(courtyard.words) <= design.capacity  # both stand in the memory for a moment


def test_no_board_has_more_leds_than_the_page():
    rows = re.findall(r"^\| (\d) \| ", PAGE, re.MULTILINE)
    assert len(rows) == max(len(read_board(name)["pins"]["leds"]) for name in board_names())
    assert len(read_board("icepi-zero")["pins"]["leds"]) == 4
    assert "The Icepi Zero has the first four." in PAGE
