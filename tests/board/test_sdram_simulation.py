"""A board whose octree and frames are in SDRAM, simulated whole: what a monitor at its pins sees.

The design is the shipped one with one lane, small caches and a small boot memory, and a model of the SDRAM at its pins.
The pictures are those of the exact model.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fakes.board_host import Host, cameras_around, expected_crc, picture
from fakes.simulated_port import SimulatedPort
from msgspec.structs import replace
from oracles.verilator import needs_compiled_verilator

from voxrt.board.designs import serial_device
from voxrt.board.designs.boot_table import (
    BOARD_REGISTERS,
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
from voxrt.board.designs.build import read_board
from voxrt.board.designs.serial_device import SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_sources
from voxrt.board.edited_scene import rom_of
from voxrt.board.register_writes import camera_writes
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import Lighting
from voxrt.boards.board_scenes import load_scene
from voxrt.octree import BOARDS, Box, World
from voxrt.octree.words import move_pointers

pytestmark = needs_compiled_verilator

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
BOOT_BLOCK_BITS = 7
OCTREE_WORDS = BOARDS["ulx3s-85f-sdram"]
ON_CHIP_WORDS = (8 << BOOT_BLOCK_BITS) + 8 * 4 * (2**2 + 2**4)  # boot memory, both caches


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    small = {"Lanes": 1, "L1SetBits": 2, "L2SetBits": 4, "BootBlockBits": BOOT_BLOCK_BITS, "PowerOnUs": 2}
    return compile_sources(read_board("ulx3s-85f-sdram"), tmp_path_factory.mktemp("board"), GapBits=12, **small)


def cameras_of(scene, scale):
    """The world fills the picture, so that pictures take long."""
    return cameras_around(scene, (640 >> scale, 480 >> scale), radius=0.8, height=0.5)


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
        host = Host(board)
        # The boot scene. A picture takes longer than the screen: it is shown whole, and more than once.
        pictures = [picture(old, camera, 0) for camera in cameras[:6]]
        shown = []
        for pixels, timing in board.frames(8):
            assert timing.is_vga, timing
            shown += [number for number, expected in enumerate(pictures) if np.array_equal(pixels, expected)]
            assert len(shown) or not pixels.any()  # black until the first one
        assert shown[0] == 0
        assert set(np.diff(shown)) == {0, 1}
        assert host.register("underruns") == 0
        assert host.register("late") > 0

        # Another scene beside it, from the host, with larger pixels.
        assert 1 + 8 * host.read(SDRAM_REGISTERS["blocks"])[0] == OCTREE_WORDS
        base = 8 << BOOT_BLOCK_BITS
        words = move_pointers(new.words, base)
        host.write(OCTREE_MEMORY + 4 * base, words)
        assert host.read(OCTREE_MEMORY + 4 * (base + len(words) - 300), 300) == words[-300:].tolist()
        camera = cameras_of(new, 1)[3]
        control = (BOARD_REGISTERS["control"], [1 << 8 | 1 << 4 | STEERED | RUN])
        swap = [*scene_writes(new, Lighting(), (320, 240), base), *camera_writes(camera), control]
        host.write(TABLE + 4 * 1024, encode_list(swap))
        host.write(BOARD_REGISTERS["play"], [1024])
        expected, pictures = picture(new, camera, 1), [picture(old, camera, 0) for camera in cameras]
        last = [pixels for pixels, _ in board.frames(6)]
        first = next(number for number, pixels in enumerate(last) if np.array_equal(pixels, expected))
        assert all(np.array_equal(pixels, expected) for pixels in last[first:])
        assert all(any(np.array_equal(pixels, each) for each in pictures) for pixels in last[:first])
        assert (host.register("underruns"), host.register("refused")) == (0, 0)
        assert host.frame_crc() == expected_crc(expected, 1)

        # What is written over the present scene shows in the next frame: the caches forget it.
        place, empty = 1, [0xFFFFFF00] * 8  # the root's block
        assert host.read(OCTREE_MEMORY + 4 * (base + place), 8) != empty
        host.write(OCTREE_MEMORY + 4 * (base + place), empty)
        changed = new.words.copy()
        changed[place : place + 8] = empty
        # The page after the first: other words.
        host.write(SDRAM_REGISTERS["page"], [1])
        host.write(OCTREE_MEMORY + 4 * (base + place), [1, 9, 17])
        assert host.read(OCTREE_MEMORY + 4 * (base + place), 3) == [1, 9, 17]
        # The last words of the memory; those beyond are dropped, and read as 0.
        host.write(SDRAM_REGISTERS["page"], [(OCTREE_WORDS - 1) // PAGE_WORDS])
        last = OCTREE_MEMORY + 4 * ((OCTREE_WORDS - 2) % PAGE_WORDS)
        host.write(last, [25, 33, 41])
        assert host.read(last, 3) == [25, 33, 0]
        host.write(SDRAM_REGISTERS["page"], [0])
        assert host.read(OCTREE_MEMORY + 4 * (base + place), 8) == empty
        pixels = board.frames(6)[-1][0]
        assert np.array_equal(pixels, picture(replace(new, words=changed), camera, 1))
        assert not np.array_equal(pixels, expected)


@pytest.mark.slow
def test_blocks_that_edits_use_again_are_not_stale(program, tmp_path, monkeypatch):
    """The driver edits a small world by the serial line: new blocks take the places of freed ones, which caches had."""
    monkeypatch.setattr(serial_device, "_WAIT_SECONDS", 600.0)  # a simulated frame takes a second and more
    scene = load_scene(EXAMPLES / "house.obj", 3)
    camera = cameras_of(scene, 2)[0]
    contents = {
        "octree": encode_octree(scene.words, BOOT_BLOCK_BITS),
        "table": boot_table(scene, cameras_of(scene, 2), Lighting(), scale=2, period=1, control=RUN),
    }
    with BoardSimulation(program, tmp_path, contents) as board:
        board.frames(3)
        device = SerialDevice(SerialLink("the simulation", SimulatedPort(board)), ModelDevice())
        memory = SceneMemory(device, device.loaded())
        world = World(rom_of(scene), undo_steps=0)
        memory.begin_edits(world, scene)
        rng = np.random.default_rng(3)
        for _ in range(8):
            low = rng.integers(0, 7, 3)
            world.fill(Box(low, low + 2), int(rng.integers(0, 3)))
            memory.show_edits(scene)
            expected = picture(replace(scene, words=world.rom().octree.words), camera, 2)
            assert np.array_equal(board.frames(3)[-1][0], expected)
        assert Host(board).register("refused") == 0
