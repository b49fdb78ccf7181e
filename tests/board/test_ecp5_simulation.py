"""The design of a board, simulated whole: what a monitor at its pins sees, what a host on its serial line gets.

The pictures are those of the exact model. The protocol is that of fakes/board_host.py.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fakes.board_host import Host, cameras_around, expected_crc, picture
from fakes.box_scenes import ignore
from fakes.simulated_port import SimulatedPort
from msgspec.structs import replace
from oracles.verilator import needs_compiled_verilator

from voxrt.board.board_report import cameras_around as report_cameras
from voxrt.board.board_report import check_views
from voxrt.board.designs import serial_device
from voxrt.board.designs.boot_table import (
    BOARD_REGISTERS,
    CAMERAS,
    OCTREE_MEMORY,
    RUN,
    STEERED,
    TABLE,
    TURN,
    boot_table,
    encode_list,
    encode_octree,
    scene_writes,
)
from voxrt.board.designs.build import clock_hz, read_board
from voxrt.board.designs.serial_device import SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_sources
from voxrt.board.edited_scene import rom_of
from voxrt.board.register_writes import camera_writes
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import Lighting
from voxrt.boards.board_scenes import load_scene
from voxrt.octree import Box, Sphere, World
from voxrt.octree.camera import look_at
from voxrt.octree.words import move_pointers

pytestmark = [pytest.mark.xdist_group("ecp5"), *needs_compiled_verilator]

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
BOARD = read_board("ulx3s-45f")
GAP_BITS = 12
SCALE = 1
SIZE = (640 >> SCALE, 480 >> SCALE)


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return compile_sources(BOARD, tmp_path_factory.mktemp("board"), GapBits=GAP_BITS)


@pytest.fixture(scope="module")
def scenes():
    return [load_scene(EXAMPLES / name, 5) for name in ("house.obj", "planet.glb")]


def cameras_of(scene, size):
    """An orbit, seen from above, that moves by much per camera."""
    return cameras_around(scene, size, radius=1.3, height=0.8)


def contents_of(scene, cameras, **settings):
    return {
        "octree": encode_octree(scene.words, BOARD["core"]["BlockBits"]),
        "table": boot_table(scene, cameras, Lighting(), **({"scale": SCALE, "period": 1} | settings)),
    }


def test_a_monitor_sees_the_orbit_from_power_on(program, scenes, tmp_path):
    scene = scenes[0]
    cameras = cameras_of(scene, SIZE)
    with BoardSimulation(program, tmp_path, contents_of(scene, cameras, control=RUN | TURN)) as board:
        seen = board.frames(4)
        for number, (pixels, timing) in enumerate(seen[1:]):
            assert np.array_equal(pixels, picture(scene, cameras[number], SCALE))
            assert timing.is_vga, timing
            assert timing.worst_balance <= 10
        assert not seen[0][0].any()  # until the first vertical blanking
        host = Host(board)
        assert (host.register("underruns"), host.register("late"), host.register("refused")) == (0, 0, 0)
        assert host.register("identity") == int.from_bytes(b"VXBD", "big")
        assert host.register("clock") == clock_hz(BOARD)
        assert board.leds() & 0b01101111 == 0b00000011  # booted, turning


def test_a_scene_is_swapped_between_two_frames(program, scenes, tmp_path):
    old, new = scenes
    cameras, camera = cameras_of(old, SIZE), cameras_of(new, SIZE)[3]
    with BoardSimulation(program, tmp_path, contents_of(old, cameras, control=RUN)) as board:
        host = Host(board)
        board.run(20_000)  # while the board plays its boot list, it hears no request
        base = -(-len(old.words) // 8) * 8
        words = move_pointers(new.words, base)
        host.write(OCTREE_MEMORY + 4 * base, words)
        assert host.read(OCTREE_MEMORY + 4 * base, 200) == words[:200].tolist()
        control = (BOARD_REGISTERS["control"], [1 << 8 | SCALE << 4 | STEERED | RUN])
        swap = encode_list([*scene_writes(new, Lighting(), SIZE, base), *camera_writes(camera), control])
        host.write(TABLE + 4 * 1024, swap)
        assert host.read(TABLE + 4 * 1024, 20) == swap[:20]
        before = board.frames(1)[0][0]
        host.write(BOARD_REGISTERS["play"], [1024])
        assert host.register("play") >> 31 == 1
        during, after = (pixels for pixels, _ in board.frames(2))
        assert np.array_equal(before, picture(old, cameras[0], SCALE))
        assert np.array_equal(during, picture(old, cameras[0], SCALE))
        assert np.array_equal(after, picture(new, camera, SCALE))
        assert host.register("play") >> 31 == 0
        assert host.register("refused") == 0
        assert host.frame_crc() == expected_crc(after, SCALE)


@pytest.mark.slow
def test_edits_by_the_serial_line_show_between_two_frames(program, scenes, tmp_path, monkeypatch):
    """The driver edits the running board; every picture is that of the world before or after an edit."""
    monkeypatch.setattr(serial_device, "_WAIT_SECONDS", 600.0)  # a simulated frame takes a second and more
    scene = scenes[0]
    cameras = cameras_of(scene, SIZE)
    with BoardSimulation(program, tmp_path, contents_of(scene, cameras, control=RUN)) as board:
        board.run(20_000)
        device = SerialDevice(SerialLink("the simulation", SimulatedPort(board)), ModelDevice())
        memory, world = SceneMemory(device, device.loaded()), World(rom_of(scene))
        memory.begin_edits(world, scene)
        seen = picture(scene, cameras[0], SCALE)
        changes = 0
        for edit in (
            lambda: world.set([[6, height, 27] for height in range(32)], 1),
            lambda: world.fill(Box((0, 20, 0), (20, 22, 32)), 2),
            lambda: world.fill(Sphere((16, 16, 16), 12), 0),
            world.undo,
            lambda: world.set([[26, 20, 26], [26, 21, 26], [27, 20, 26]], 1),
        ):
            before = seen
            edit()
            memory.show_edits(scene)
            seen = picture(replace(scene, words=world.rom().octree.words), cameras[0], SCALE)
            during, after = (pixels for pixels, _ in board.frames(2))
            assert any(np.array_equal(during, one) for one in (before, seen))
            assert np.array_equal(after, seen)
            changes += not np.array_equal(before, seen)
        assert changes >= 3
        assert Host(board).register("refused") == 0


@pytest.mark.slow
def test_a_report_compares_what_the_board_draws(program, scenes, tmp_path, monkeypatch):
    monkeypatch.setattr(serial_device, "_WAIT_SECONDS", 600.0)  # a simulated frame takes a second and more
    scene = scenes[0]
    contents = contents_of(scene, cameras_of(scene, SIZE), control=RUN | TURN)
    with BoardSimulation(program, tmp_path, contents) as board:
        board.run(20_000)
        device = SerialDevice(SerialLink("the simulation", SimulatedPort(board)), ModelDevice())
        shown = device.loaded().scene
        cameras = report_cameras(shown.depth, (160, 120), 2)
        views = check_views(device, shown, cameras, (160, 120), ignore, sends_frames=False)
        assert [view.equal for view in views] == [True, True]
        assert views[0].crc32 == views[0].expected_crc32 != views[1].crc32
        # Another scene than the board's.
        words = scenes[1].words
        views = check_views(device, replace(shown, words=words), cameras[:1], (160, 120), ignore, sends_frames=False)
        assert views[0].crc32 != views[0].expected_crc32


def test_noise_and_broken_requests_do_nothing(program, scenes, tmp_path):
    with BoardSimulation(program, tmp_path, contents_of(scenes[0], cameras_of(scenes[0], SIZE), control=0)) as board:
        host = Host(board)
        board.run(20_000)
        place = TABLE + 4 * 700
        host.write(place, [1, 2, 3])
        assert host.read(place, 3) == [1, 2, 3]
        # A bit is wrong, anywhere.
        good = host.request(2, place, 2, [7, 8], sequence=9)
        for byte in (2, 5, 9, len(good) - 1):
            broken = bytearray(good)
            broken[byte] ^= 0x10
            assert host.ask(bytes(broken), 0)[0] == 1
        # Unknown operation, no words, no address of a word.
        assert host.ask(host.request(3, place, 2), 0)[0] == 2
        assert host.ask(host.request(1, place, 0), 0)[0] == 2
        assert host.ask(host.request(1, place + 2, 1), 0)[0] == 2
        # Addresses without a register: of the core, of the board, of nothing.
        for address in (0x0000A0, 0x001030, 0x010000):
            assert host.ask(host.request(1, address, 1), 1) == (3, 0, [0])
        assert host.read(place, 3) == [1, 2, 3]
        bad = host.register("bad_requests")
        assert bad == 7
        # What is not a request is ignored; a request that breaks off is dropped, without an answer.
        random = np.random.default_rng(1)
        noise = bytes(byte for byte in random.integers(0, 256, 300, dtype=np.uint8).tolist() if byte != 0x56)
        board.send(noise + good[:-3])
        board.run(20 * (len(noise) + 20) * 10 + (1 << GAP_BITS))
        assert board.received() == b""
        assert host.register("bad_requests") == bad + 1
        assert host.read(place, 3) == [1, 2, 3]
        # The board's clock and the host's differ.
        for baud in (2_940_000, 3_060_000):
            board.set_baud(baud)
            board.send(host.request(2, place, 1, [baud]))
            board.run(20_000)
            board.received()
        board.set_baud(3_000_000)
        assert host.read(place, 1) == [3_060_000]


def test_buttons_pause_step_and_reverse(program, scenes, tmp_path):
    cameras = cameras_of(scenes[0], SIZE)
    with BoardSimulation(program, tmp_path, contents_of(scenes[0], cameras, control=RUN | TURN)) as board:
        host = Host(board)

        # The board looks at its buttons once per frame, of 420,000 clocks.
        def press(buttons):
            board.press(buttons)
            board.run(450_000)
            board.press(0)
            board.run(450_000)

        board.run(2 * 420_000)
        press(0b001)  # pause
        stopped = host.register("camera")
        assert board.leds() & 2 == 0
        press(0b100)
        assert host.register("camera") == stopped + 1
        press(0b010)
        press(0b100)
        press(0b100)
        assert host.register("camera") == stopped - 1
        assert board.leds() & 4 == 4


def test_what_comes_too_late_repeats_lines_and_is_counted(program, scenes, tmp_path):
    scene = scenes[1]
    # From the middle of the ground along the world: many cells per ray, at the full size of the screen.
    middle = np.full(3, 2.0**scene.depth / 2)
    camera = look_at(middle * [0.1, 1.2, 0.1], middle, size=(640, 480))
    with BoardSimulation(program, tmp_path, contents_of(scene, [camera] * CAMERAS, scale=0, control=RUN)) as board:
        pixels = board.frames(2)[1][0]
        host = Host(board)
        expected = picture(scene, camera, 0)
        repeated, line = 0, -1
        for row in range(480):
            if line < 0 and not pixels[row].any():
                repeated += 1
                continue
            if np.array_equal(pixels[row], expected[row]):
                line = row
                continue
            # An older line, and none that is older than the one shown before.
            assert any(np.array_equal(pixels[row], expected[old]) for old in range(max(line, 0), row))
            repeated += 1
        assert repeated <= host.register("underruns")
        assert (repeated > 0) == (host.register("underruns") > 0)
