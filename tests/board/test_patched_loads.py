"""Senders that open a board for every scene, as Live does without a server: what changed little is a patch."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.box_scenes import boxes, ignore, picture_of, view_of
from fakes.device import FakeDevice
from fakes.ecp5_board import Board
from fakes.pynq import Core, install
from msgspec.structs import replace

from voxrt.board.designs.serial_device import SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.edited_scene import with_materials
from voxrt.board.errors import DeviceError
from voxrt.board.registers import REGISTERS
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.octree import Octree, Rom, from_dense, to_dense
from voxrt.octree.words import move_pointers
from voxrt.voxelize import EMPTY, Material

SIZE = (48, 32)
ROOT = REGISTERS["root"][0]


class Serial:
    """A board at a serial line; words that reach its octree memory are counted, whichever way they take."""

    def __init__(self, *, sdram):
        self.board, self.written = Board(sdram=sdram), 0
        put = self.board.put

        def counting(address, value):
            self.written += address >= 0x800000
            return put(address, value)

        self.board.put = counting

    def open(self):
        return SerialDevice(SerialLink("test port", self.board), ModelDevice())

    def root(self, _):
        return self.board.core.read(ROOT)


class Tcp:
    """A PYNQ board behind its agent; words of requests that write the octree memory are counted."""

    def __init__(self, config, monkeypatch, open_board):
        pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
        install(monkeypatch, Core(config))
        self.open_board, self.written = open_board, 0

    def open(self):
        device = self.open_board()
        memory, write = device._memory, type(device._memory).__setitem__

        class Counting(type(memory)):
            def __setitem__(_, part, words):
                self.written += len(words)
                write(memory, part, words)

        device._memory = Counting(memory._link)
        return device

    def root(self, device):
        return device.registers()["root"]


@pytest.fixture(params=["serial", "serial sdram", "lit", "cached1"])
def sender(request, monkeypatch, open_board):
    kind, _, which = request.param.partition(" ")
    return Serial(sdram=bool(which)) if kind == "serial" else Tcp(kind, monkeypatch, open_board)


def scene_of(cube, number=0):
    rom = Rom("model", from_dense(cube), (EMPTY, *(Material(f"m{i}", (40 * i, number, 9)) for i in range(1, 6))))
    return with_materials(replace(boxes(1), words=rom.octree.words, depth=4), rom.materials)


def random_cube(rng, solid=5):
    cube = np.zeros((16, 16, 16), np.uint8)
    cube[:, :solid] = rng.integers(1, 4, (16, solid, 16))
    return cube


def dig(cube, rng, number):
    low = rng.integers(0, 14, 3)
    cube[tuple(slice(at, at + 2) for at in low)] = 4 if number % 2 else 0


def voxels_of(device, root, scene):
    """The voxels of the words that the board has around the one that the register of the root names."""
    start = max(0, root - (1 << 12)) // 8 * 8
    end = min(device.identity.capacity, start + (1 << 13) + 1)
    words = move_pointers(device.read_memory(start, end - start), -start)
    words[0] = words[root - start]
    return to_dense(Octree(scene.depth, words))


def test_what_differs_little_is_a_patch_for_every_sender(sender):
    rng = np.random.default_rng(11)
    cube = random_cube(rng)
    for number in range(9):
        if number == 5:
            cube = random_cube(rng, solid=4)
        elif number:
            dig(cube, rng, number)
        scene, sender.written = scene_of(cube, number), 0
        device = sender.open()
        opening = sender.written
        SceneMemory(device, device.loaded()).load(scene, ignore)
        if number in {0, 5}:
            assert sender.written - opening == len(scene.words)
        else:
            assert 0 < sender.written - opening < len(scene.words) // 8
        np.testing.assert_array_equal(voxels_of(device, sender.root(device), scene), cube)
        view = view_of(scene, SIZE)
        np.testing.assert_array_equal(device.frame(view).colour, picture_of(scene, view))
    # What has not changed at all, as when the camera moves, is not written either: it was read a moment before.
    device = sender.open()
    opening, loaded = sender.written, device.loaded()
    if loaded.shown:
        np.testing.assert_array_equal(loaded.scene.colours, scene.colours)
    SceneMemory(device, loaded).load(scene, ignore)
    assert sender.written - opening <= 1
    np.testing.assert_array_equal(device.frame(view).colour, picture_of(scene, view))


def test_a_server_between_two_senders_ends_the_patches(monkeypatch, open_board):
    """Opening empties the world of a PYNQ board: what was there before is never taken for what is there now."""
    sender, rng = Tcp("lit", monkeypatch, open_board), np.random.default_rng(12)
    first, second = scene_of(random_cube(rng)), scene_of(random_cube(rng))
    device = sender.open()
    assert device.loaded() is None
    SceneMemory(device).load(first, ignore)
    assert device.loaded() is None
    device = sender.open()
    loaded = device.loaded()
    assert (loaded.base, loaded.shown) == (0, False)
    np.testing.assert_array_equal(loaded.scene.words, first.words)
    device = sender.open()
    view = view_of(first, SIZE)
    assert (device.frame(view).colour == first.background).all()
    assert device.loaded().scene.words.tolist() == [0xFFFFFF00]
    SceneMemory(device, device.loaded()).load(second, ignore)
    np.testing.assert_array_equal(device.frame(view).colour, picture_of(second, view))


def test_a_sender_that_fails_leaves_an_empty_world_or_goes_on(monkeypatch, open_board):
    sender, rng = Tcp("lit", monkeypatch, open_board), np.random.default_rng(13)
    cube = random_cube(rng)
    SceneMemory(sender.open()).load(scene_of(cube), ignore)
    dig(cube, rng, 1)
    scene = scene_of(cube)
    view = view_of(scene, SIZE)
    device = sender.open()
    memory = SceneMemory(device, device.loaded())

    def fail():
        raise DeviceError("too slow")

    with pytest.raises(DeviceError, match="too slow"):
        list(memory.load_in_steps(scene, ignore, fail))
    assert (device.frame(view).colour == scene.background).all()
    memory.load(scene, ignore)
    np.testing.assert_array_equal(device.frame(view).colour, picture_of(scene, view))


@pytest.mark.parametrize("loads", [1, 2, 3, 4])
@pytest.mark.parametrize("kind", ["model", "serial", "small"])
def test_the_first_edit_of_a_scene_is_a_patch(kind, loads):
    """Whichever way it came into the memory: at its beginning, at its end, as a patch."""
    rng = np.random.default_rng(loads)
    cube, board = random_cube(rng), None
    if kind == "serial":
        board = Serial(sdram=True)
        device = board.open()
    else:
        device = ModelDevice(capacity=1 << 25 if kind == "model" else 1 << 13)
    memory, written, compared = SceneMemory(device), [], []
    write, read = device.write_memory, device.read_memory
    device.write_memory = lambda address, words: (written.append(len(words)), write(address, words))[1]
    device.read_memory = lambda address, count: (compared.append(count), read(address, count))[1]
    for number in range(loads):
        if number == 1:
            cube = random_cube(rng)
        elif number:
            dig(cube, rng, number)
        scene = scene_of(cube, number)
        memory.load(scene, ignore)
    world = memory.world_of(scene)
    world.set([[3, 9, 3]], 2)
    written.clear()
    compared.clear()
    memory.begin_edits(world, scene)
    memory.show_edits(scene)
    assert sum(written) <= 8 * 4 + 1
    assert sum(compared) <= 8 * 4 + 1
    for place, material in (([3, 9, 3], 0), ([5, 9, 9], 3), ([0, 0, 0], 0)):
        world.set([place], material)
        memory.show_edits(scene)
    cube[5, 9, 9], cube[0, 0, 0] = 3, 0
    now = replace(scene, words=from_dense(cube).words)
    view = view_of(now, SIZE)
    np.testing.assert_array_equal(device.frame(view).colour, picture_of(now, view))
    assert sum(written) <= 4 * (8 * 4 + 1)
    # The next scene is a patch, too; and one of its own voxels has room beside it.
    dig(cube, rng, 1)
    for material, limit in ((1, len(scene.words) // 4), (9, 2 * len(scene.words))):
        written.clear()
        scene = scene_of(cube, material)
        memory.load(scene, ignore)
        view = view_of(scene, SIZE)
        np.testing.assert_array_equal(device.frame(view).colour, picture_of(scene, view))
        assert sum(written) < limit
        cube = random_cube(rng)


def test_an_edit_whose_patched_load_failed_is_compared_again():
    """The patch may have been written over blocks that a step of undo needs."""
    rng = np.random.default_rng(21)
    cube = random_cube(rng)
    device = ModelDevice(capacity=1 << 15)
    memory, scene = SceneMemory(device), scene_of(cube)
    memory.load(scene, ignore)
    world = memory.world_of(scene)
    memory.begin_edits(world, scene)
    for _ in range(3):
        world.set(rng.integers(5, 16, (3, 3)), 2)
        memory.show_edits(scene)
    before = to_dense(world.rom().octree)
    world.set(rng.integers(0, 5, (3, 3)), 0)
    memory.show_edits(scene)
    other = cube.copy()
    dig(other, rng, 1)

    def fail():
        raise DeviceError("too slow")

    with pytest.raises(DeviceError, match="too slow"):
        list(memory.load_in_steps(scene_of(other), ignore, fail))
    world.undo()
    memory.show_edits(scene)
    now = replace(scene, words=from_dense(before).words)
    view = view_of(now, SIZE)
    np.testing.assert_array_equal(device.frame(view).colour, picture_of(now, view))


def test_a_scene_of_equal_blocks_stored_twice_is_written_whole():
    words = np.full(1 + 24, 0xFFFFFF01, np.uint32)
    words[[0, 1, 2]] = 1, 9, 17
    words[[9, 17]] = 0xFFFFFF02
    device = FakeDevice()
    memory = SceneMemory(device)
    twice = replace(boxes(1), words=words, depth=2)
    memory.load(twice, ignore)
    world = memory.world_of(twice)
    world.set([[3, 3, 3]], 0)
    memory.begin_edits(world, twice)
    memory.show_edits(twice)
    image = device.memory.copy()
    image[0] = image[device.root]
    expected = to_dense(Octree(2, words))
    expected[3, 3, 3] = 0
    np.testing.assert_array_equal(to_dense(Octree(2, image[: 8 * 64 + 1])), expected)
