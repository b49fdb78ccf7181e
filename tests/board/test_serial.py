"""The serial line of the ECP5 boards: damaged bytes, unplugged cables, scenes that change on the running board."""

from __future__ import annotations

import contextlib
from itertools import chain, repeat

import numpy as np
import pytest
from fakes.box_scenes import boxes, ignore, picture_of, view_of
from fakes.ecp5_board import CLOCK, SDRAM_BLOCK_BITS, Board

from voxrt.board.designs.boot_table import CAMERAS, RUN, SCREEN, STEERED, TURN
from voxrt.board.designs.serial_device import SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.errors import DeviceError
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import Lighting, View, frame_world, refit

FAULTS = ("lose request", "damage request", "lose answer", "cut answer", "damage answer", "noise")
CONTROL = 0x1008
SCALE = 2
SIZE = (SCREEN[0] >> SCALE, SCREEN[1] >> SCALE)


def opened(board):
    return SerialDevice(SerialLink("test port", board), ModelDevice())


def orbit_of(scene):
    return [frame_world(scene.depth, SIZE)] * CAMERAS


def show(board, scene):
    """Upload a scene as the command does."""
    device = opened(board)
    device.prepare_orbit(orbit_of(scene), Lighting(), SCALE)
    SceneMemory(device, device.loaded()).load(scene, ignore)


@pytest.mark.parametrize("fault", FAULTS)
def test_disturbed_requests_are_sent_again(fault):
    board = Board(faults=chain.from_iterable(repeat((fault, ""), 40)))
    link = SerialLink("test port", board)
    words = np.arange(600, dtype=np.uint32) * 77
    link.write(0x4000, words)
    np.testing.assert_array_equal(link.read(0x4000, 600), words)


def test_a_dead_line_is_told():
    link = SerialLink("test port", Board(faults=repeat("lose request")))
    with pytest.raises(DeviceError, match=r"^test port: the board does not answer; check the cable"):
        link.read(0x1000, 1)


def test_what_is_no_register_is_told():
    with pytest.raises(DeviceError, match="address 0x003000 has no register"):
        SerialLink("test port", Board()).read(0x3000, 1)


def test_another_device_is_no_board():
    board = Board()
    board.registers[0x1000] = 0
    with pytest.raises(DeviceError, match=r"^test port: this is no board of voxrt"):
        opened(board)


def test_identity():
    identity = opened(Board()).identity
    assert (identity.name, identity.clock, identity.size) == ("board at test port, 1 lane", CLOCK, SCREEN)


def test_opening_changes_nothing():
    board = Board()
    show(board, boxes(1))
    before = board.screen()
    device = opened(board)
    np.testing.assert_array_equal(board.screen(), before)
    device.close()
    assert board.closed


def test_a_scene_changes_on_the_running_board():
    board, first, second = Board(), boxes(1), boxes(2, depth=5)
    for scene in (first, second, first):
        show(board, scene)
        np.testing.assert_array_equal(board.screen(), picture_of(scene, view_of(scene, SIZE)))
        assert board.registers[CONTROL] & 0xF == RUN | TURN


def test_cameras_that_stay_are_not_written_again():
    board, scene = Board(sdram=True), boxes(1)
    show(board, scene)
    put, cameras = board.put, range(0x4000 + 4 * 2048, 0x8000)
    written = []
    board.put = lambda address, value: (written.append(address in cameras), put(address, value))[1]
    show(board, boxes(2))
    assert written
    assert not any(written)
    np.testing.assert_array_equal(board.screen(), picture_of(boxes(2), view_of(boxes(2), SIZE)))


def test_words_of_an_sdram_have_pages():
    board = Board(sdram=True)
    device = opened(board)
    assert device.identity.capacity == 1 + (8 << SDRAM_BLOCK_BITS)
    words = 1 + 8 * np.arange(300, dtype=np.uint32)
    start = (1 << 21) - 100
    device.write_memory(start, words)
    np.testing.assert_array_equal(device.read_memory(start, 300), words)
    np.testing.assert_array_equal(board.core.read_memory(start, 300), words)
    assert board.registers[0x1030] == 0


def test_a_host_that_was_killed_left_another_page():
    board, scene = Board(sdram=True), boxes(4)
    show(board, scene)
    board.registers[0x1030] = 1
    np.testing.assert_array_equal(opened(board).loaded().scene.words, scene.words)


def test_a_board_with_frames_keeps_the_size_of_the_screen():
    board, scene = Board(sdram=True), boxes(4)
    show(board, scene)
    board.registers[0x101C] += 5  # late
    device = opened(board)
    assert device.frame_buffer
    np.testing.assert_array_equal(device.loaded().scene.words, scene.words)
    board.registers[0x101C] += 5
    device.frame(view_of(scene, SIZE))
    assert board.registers[CONTROL] >> 4 & 3 == 0


def test_the_present_scene_is_read_back():
    board, scene = Board(), boxes(3)
    show(board, boxes(1))
    show(board, scene)
    loaded = opened(board).loaded()
    assert loaded.base > 0
    assert loaded.scene.depth == scene.depth
    np.testing.assert_array_equal(loaded.scene.words, scene.words)
    np.testing.assert_array_equal(loaded.scene.colours, scene.colours)


def test_the_monitor_follows_the_page():
    board, scene = Board(), boxes(4)
    device = opened(board)
    SceneMemory(device).load(scene, ignore)
    view = view_of(scene, (320, 240))
    board.registers[CONTROL] = SCALE << 4
    frame = device.frame(view)
    np.testing.assert_array_equal(frame.colour, picture_of(scene, view))
    assert board.registers[CONTROL] & 0xF == RUN | STEERED
    fitted = View(refit(view.camera, view.size, SIZE), SIZE, scene.background)
    np.testing.assert_array_equal(board.screen(), picture_of(scene, fitted))


def test_page_and_monitor_show_the_same_pixels_at_the_screens_size():
    board, scene = Board(), boxes(5)
    device = opened(board)
    SceneMemory(device).load(scene, ignore)
    frame = device.frame(view_of(scene, SCREEN))
    np.testing.assert_array_equal(board.screen(), frame.colour)


def test_a_board_that_falls_behind_takes_larger_pixels():
    board, scene = Board(), boxes(6)
    device = opened(board)
    SceneMemory(device).load(scene, ignore)
    view = view_of(scene, SCREEN)
    scales = []
    for late in (0, 5, 0, 7, 9):
        board.registers[0x101C] += late
        device.frame(view)
        scales.append(board.registers[CONTROL] >> 4 & 3)
    assert scales == [0, 1, 1, 2, 2]


@pytest.mark.parametrize("after", [0, 1, 2, 5, 9, 14, 20, 24, 26, 30, 34, 36, 38, 40])
def test_an_unplugged_cable_leaves_the_old_scene_or_shows_the_new_one(after):
    board, old, new = Board(), boxes(1), boxes(2, depth=5)
    show(board, old)
    board.faults = chain(repeat("", after), repeat("unplug"))
    with contextlib.suppress(DeviceError):
        show(board, new)
    pictures = [picture_of(scene, view_of(scene, SIZE)) for scene in (old, new)]
    assert any(np.array_equal(board.screen(), picture) for picture in pictures)
