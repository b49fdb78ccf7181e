"""The table that a board starts from, read as the board's player reads it."""

from __future__ import annotations

import re

import numpy as np
import pytest
from msgspec.structs import replace

from voxrt.board.designs.boot_table import (
    BOARD_REGISTERS,
    CAMERAS,
    OCTREE_MEMORY,
    boot_table,
    encode_list,
    encode_octree,
)
from voxrt.board.designs.build import DESIGNS
from voxrt.board.register_writes import camera_writes
from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.board.scene import Scene
from voxrt.board.view import Camera, Lighting


def play(table, start, limit=4096):
    """What a list writes, by address: docs/board-bus.md."""
    written, word = {}, start
    while word < min(start + limit, 4096):
        header = int(table[word])
        count, address = header >> 24, header & 0xFFFFFF
        if count == 0:
            break
        for i in range(count):
            written[address + 4 * i] = int(table[word + 1 + i])
        word += 1 + count
    return written


@pytest.fixture
def scene():
    random = np.random.default_rng(5)
    words = np.array([1, *range(0xFFFFFF00, 0xFFFFFF08)], dtype=np.uint32)
    colours = random.integers(0, 256, (256, 3), dtype=np.uint8)
    return Scene("cells", 1, words, colours, random.integers(0, 2, 256).astype(bool))


def camera(number):
    return Camera((-number, 2, 3), (4, -5, 6), (7, 8, -9), (number, -11, 12))


def test_the_boot_list_writes_all_that_a_picture_needs(scene):
    lighting = Lighting((-1, 2, 3), 77, on=True, bounces=3, faces=(1, 2, 3, 4, 5, 6))
    table = boot_table(scene, [camera(i) for i in range(CAMERAS)], lighting, scale=1, control=3, period=9)
    written = play(table, 0)
    assert written[REGISTERS["size"][0]] == 240 << 16 | 320
    assert written[REGISTERS["depth"][0]] == 1
    assert written[REGISTERS["root"][0]] == 0
    assert written[REGISTERS["shading"][0]] == 3 << 16 | 77 << 8 | 4 | 2
    assert written[REGISTERS["lower_faces"][0]] == 5 << 16 | 3 << 8 | 1
    assert written[REGISTERS["upper_faces"][0]] == 6 << 16 | 4 << 8 | 2
    assert [written[REGISTERS[f"light[{a}]"][0]] for a in range(3)] == [0xFFFFFFFF, 2, 3]
    assert written[OCTREE_MEMORY] == 1
    for material in range(256):
        red, green, blue = scene.colours[material].tolist()
        mirror = int(scene.mirrors[material])
        assert written[MATERIALS + 4 * material] == mirror << 24 | red << 16 | green << 8 | blue
    assert list(written)[-1] == BOARD_REGISTERS["control"]
    assert written[BOARD_REGISTERS["control"]] == 9 << 8 | 1 << 4 | 3
    assert REGISTERS["control"][0] not in written


@pytest.mark.parametrize("number", [0, 1, 127])
def test_each_camera_is_a_list_of_sixteen_words(scene, number):
    table = boot_table(scene, [camera(i) for i in range(CAMERAS)], Lighting())
    written = play(table, 2048 + 16 * number, limit=16)
    expected = {}
    for name in ("position", "look", "right", "up"):
        ((_, width),) = REGISTERS[f"{name}[0]"][1].values()
        for axis, value in enumerate(getattr(camera(number), name)):
            expected[REGISTERS[f"{name}[{axis}]"][0]] = value % (1 << width)
    assert written == expected


def test_long_bursts_are_cut():
    words = encode_list([(0x800000, list(range(600)))])
    table = np.array(words, dtype=np.uint32)
    assert play(table, 0) == {0x800000 + 4 * i: i for i in range(600)}
    assert len(words) == 600 + 3 + 1


def test_a_camera_fits_its_sixteen_words():
    assert len(encode_list(camera_writes(camera(1)), end=False)) == 16


def test_an_orbit_has_128_cameras(scene):
    with pytest.raises(ValueError, match="an orbit has 128 cameras, not 1"):
        boot_table(scene, [camera(0)], Lighting())


def test_an_octree_beyond_the_memory_is_refused():
    with pytest.raises(ValueError, match="an octree of 265 words does not fit a memory of 257"):
        encode_octree(np.zeros(265, dtype=np.uint32), 5)


def test_the_board_starts_frames_by_the_registers_of_the_core():
    source = (DESIGNS / "board_frames.sv").read_text()
    addresses = dict(re.findall(r"localparam logic \[23:0\] Core(\w+) = 24'h(\w+);", source))
    assert {name: int(value, 16) for name, value in addresses.items()} == {
        "Control": REGISTERS["control"][0],
        "Status": REGISTERS["status"][0],
    }
    (polled,) = re.findall(r"assign busy_polled = data_i\[(\d+)\];", source)
    assert (int(polled), 1) == REGISTERS["status"][1]["busy"]
    (written,) = re.findall(r"access_o\.data += 32'd(\d+);", source)
    assert int(written) == 1 << REGISTERS["control"][1]["start"][0]


@pytest.mark.parametrize("count", [3, 24, 64, 100])
def test_an_animation_plays_along_the_orbit(scene, count):
    roots = tuple(range(1, 1 + count))
    cameras = [camera(i) for i in range(CAMERAS)]
    table = boot_table(replace(scene, roots=roots), cameras, Lighting())
    steps = [play(table, 2048 + 16 * number, 16) for number in range(CAMERAS)]
    for number in range(0, CAMERAS, 2):
        writes = camera_writes(cameras[number])
        assert steps[number] == {
            address + 4 * i: value & 0xFFFFFFFF for address, values in writes for i, value in enumerate(values)
        }
    shown = [step[REGISTERS["root"][0]] for step in steps[1::2]]
    assert all(len(step) == 1 for step in steps[1::2])
    times = [shown.count(root) for root in roots]
    assert max(times) - min(times) <= 2
    assert (shown[0], shown == sorted(shown)) == (1, count > 32)
    if count <= 64:
        assert set(shown) == set(roots)
        assert shown[-1] == roots[-1]
