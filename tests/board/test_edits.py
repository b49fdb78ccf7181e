"""Edits on devices: every frame shows the world as it is, whatever is cached, cut off or lost."""

from __future__ import annotations

import contextlib
import socket
import struct
from functools import partial
from itertools import chain, repeat

import numpy as np
import pytest
from fakes.agent_client import client
from fakes.board_agent import running_agent
from fakes.box_scenes import boxes, ignore, picture_of, view_of
from fakes.device import FakeDevice, opened_or_skipped
from fakes.ecp5_board import Board
from fakes.pynq import Core, install
from msgspec.structs import replace

from voxrt.board import tcp_device
from voxrt.board.designs.serial_device import _LIST_WORDS, SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.edited_scene import rom_of, with_materials
from voxrt.board.errors import DeviceError, Refused
from voxrt.board.patch_writes import block_writes
from voxrt.board.registers import REGISTERS
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.core import open_rtl
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.tcp_device import open_tcp
from voxrt.octree import Box, Octree, Patch, Rom, Sphere, World, from_points, to_points
from voxrt.voxelize import EMPTY, Material

SIZE = (48, 32)
FEW_WORDS = 1200
"""The size of a world whose blocks are soon used again."""


def opened_serial(board):
    return SerialDevice(SerialLink("test port", board), ModelDevice())


def opened_tcp(config, monkeypatch, open_board):
    pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
    install(monkeypatch, Core(config))
    return open_board()


@pytest.fixture(params=["model", "tiny", "cached1", "serial", "serial sdram", "tcp", "tcp cached1"])
def device(request, monkeypatch, open_board):
    kind, _, which = request.param.partition(" ")
    if kind == "model":
        return ModelDevice()
    if kind == "serial":
        return opened_serial(Board(sdram=bool(which)))
    if kind == "tcp":
        return opened_tcp(which or "lit", monkeypatch, open_board)
    return opened_or_skipped(partial(open_rtl, kind))


class Digging:
    """A scene on a device, and random edits of it."""

    def __init__(self, device, seed=1, words=FEW_WORDS, scene=None):
        self.rng = np.random.default_rng(seed)
        self.scene = scene or boxes(seed)
        self.device, self.memory = device, SceneMemory(device)
        self.memory.load(self.scene, ignore)
        self.world = World(rom_of(self.scene), words=words, undo_steps=3)

    def begin(self):
        self.memory.begin_edits(self.world, self.scene)

    def edit(self):
        middle = self.rng.integers(0, 16 * self.world.size, 3) / 16
        choice = self.rng.integers(6)
        material = int(self.rng.integers(len(self.world.materials)))
        if choice == 0 and self.world.undo():
            return
        if choice == 1:
            self.world.fill(Sphere(middle, self.rng.integers(1, 60) / 16), material)
        elif choice == 2:
            low = self.rng.integers(0, self.world.size, 3)
            self.world.fill(Box(low, low + self.rng.integers(1, 5, 3)), material)
        elif choice == 3 and len(self.world.materials) < 12:
            colour = tuple(self.rng.integers(0, 256, 3).tolist())
            self.world.set(middle.astype(int)[None], self.world.add_material(Material(f"new {colour}", colour)))
        else:
            self.world.set(middle.astype(int)[None], material)

    def show(self):
        self.scene = with_materials(self.scene, self.world.materials)
        return self.memory.show_edits(self.scene)

    def view(self, size=SIZE):
        return view_of(self.scene, size)

    def expected(self, size=SIZE):
        rom = self.world.rom()
        return picture_of(replace(self.scene, words=rom.octree.words, roots=(0,)), self.view(size))

    def wrong(self):
        return int((self.device.frame(self.view()).colour != self.expected()).sum())


def test_every_frame_shows_the_edit_before_it(device):
    digging = Digging(device)
    digging.begin()
    addresses = set()
    for _ in range(30):
        digging.edit()
        written = digging.show()
        addresses.add(digging.world.live_roots[-1])
        assert written <= digging.world.figures().blocks
        assert digging.wrong() == 0
        assert len(digging.world.live_roots) == 1
    image = digging.world.image
    used = image[: len(device.read_memory(0, len(image)))]
    root = digging.world.live_roots[-1]
    assert device.read_memory(root, 1)[0] == used[root]
    assert len(addresses) < 20, "words of roots are used again"


def test_blocks_that_are_used_again_are_stale_without_a_flush():
    """The control of the test before: caches that are not emptied show old blocks."""
    digging = Digging(opened_or_skipped(partial(open_rtl, "cached1")))
    digging.begin()
    digging.device._external = False  # no frame empties the caches
    wrong = 0
    for _ in range(30):
        digging.edit()
        digging.show()
        with contextlib.suppress(DeviceError):  # a stale pointer may lead too deep
            wrong += digging.wrong()
    assert wrong > 0


@pytest.mark.parametrize("first", ["boxes", "wide"])
def test_a_world_moves_to_the_beginning_of_the_memory(first):
    device = ModelDevice(capacity=1 << 14)
    digging = Digging(device, seed=2, words=16377, scene=boxes(2, words=0 if first == "boxes" else 9000))
    digging.memory.load(boxes(3), ignore)
    digging.memory.load(digging.scene, ignore)
    digging.begin()
    assert device.registers()["root"] == 0
    digging.edit()
    digging.show()
    assert digging.wrong() == 0
    # A scene that is loaded afterwards stands behind the world's last block.
    other = boxes(4)
    digging.memory.load(other, ignore)
    assert device.registers()["root"] >= len(digging.world.image)
    np.testing.assert_array_equal(device.frame(view_of(other, SIZE)).colour, picture_of(other, view_of(other, SIZE)))
    assert digging.memory.loaded is other


def test_a_scene_that_cannot_be_loaded_leaves_the_edited_one():
    device = ModelDevice(capacity=1 + 8 * 400)
    digging = Digging(device)
    digging.begin()
    for _ in range(5):
        digging.edit()
        digging.show()
    large = boxes(4, words=1 + 8 * 390)

    def fail():
        raise DeviceError("too slow")

    with pytest.raises(DeviceError, match="too slow"):
        list(digging.memory.load_in_steps(large, ignore, fail))
    assert digging.wrong() == 0
    digging.edit()
    digging.show()
    assert digging.wrong() == 0


class Failing(ModelDevice):
    """A model whose n-th write from now on fails, or is forgotten."""

    left = -1
    forgets = False

    def write_memory(self, address, words):
        self.left -= 1
        if self.left == 0 and self.forgets:
            return
        if self.left == 0:
            raise DeviceError("the bus does not answer")
        super().write_memory(address, words)


@pytest.mark.parametrize("forgets", [False, True])
def test_a_patch_that_is_cut_off_leaves_the_old_root(forgets):
    digging = Digging(Failing(), seed=5)
    digging.begin()
    device = digging.device
    device.forgets = forgets
    failed = 0
    for number in range(40):
        before = digging.expected()
        digging.edit()
        device.left = 1 + number % 7
        try:
            digging.show()
        except DeviceError:
            failed += 1
            np.testing.assert_array_equal(device.frame(digging.view()).colour, before)
            device.left = -1
            digging.show()  # compares the memory, and writes it
        assert digging.wrong() == 0
    assert failed > 10


def test_a_world_without_room_on_the_device_is_refused():
    scene = boxes(1)
    device = ModelDevice(capacity=len(scene.words) + 8 - len(scene.words) % 8 + 1)
    digging = Digging(device, words=FEW_WORDS + 800)
    digging.begin()
    with pytest.raises(Refused, match="words of the device"):  # noqa: PT012 - until there is no room
        for _ in range(60):
            digging.edit()
            digging.show()
    with pytest.raises(Refused, match="holds"):
        digging.begin()
    with pytest.raises(Refused, match="begin its edits first"):
        SceneMemory(device).show_edits(scene)


def dust(points, depth=9):
    """A scene of single voxels."""
    rom = Rom("dust", from_points(points, [1] * len(points), depth=depth), (EMPTY, Material("oak", (160, 110, 60))))
    return with_materials(replace(boxes(1), words=rom.octree.words, depth=depth), rom.materials)


@pytest.mark.parametrize("kind", ["serial", "tcp"])
def test_a_large_ball_takes_many_messages(kind, monkeypatch, open_board):
    if kind == "serial":
        board = Board(sdram=True)
        device, most = opened_serial(board), _LIST_WORDS
    else:
        device, most = opened_tcp("cached1", monkeypatch, open_board), tcp_device._BURST
    digging = Digging(device, words=1 << 18, scene=dust([[1, 2, 3], [256, 256, 200]]))
    digging.begin()
    rng = np.random.default_rng(4)
    digging.world.fill(Sphere((256, 256, 256), 60), 1)
    if kind == "tcp":  # the blocks of a ball alone fit one message
        digging.world.set(rng.integers(0, 512, (8000, 3)), 1)
    assert 8 * digging.show() > most
    image = digging.world.image
    live = digging.world.written[:, None] + np.arange(8)
    np.testing.assert_array_equal(device.read_memory(0, len(image))[live], image[live])
    assert digging.wrong() == 0
    digging.world.undo()
    digging.show()
    assert digging.wrong() == 0


def test_a_patch_that_is_cut_at_any_byte_shows_the_old_voxels(monkeypatch):
    """All that a client sends for an edit, byte by byte: the agent carries out whole requests alone."""
    pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
    core = Core("tiny")
    install(monkeypatch, core)
    with running_agent() as (address, _):
        device = open_tcp(address, "")
        digging = Digging(device, words=4000, scene=dust([[3, 2, 1], [9, 9, 12]], depth=4))
        digging.begin()
        link, sent = device._registers._link, bytearray()
        whole = link.ask

        def ask(operation, a=0, b=0, data=b"", **expected):
            sent.extend(struct.pack("<3I", operation, a, b) + data)
            return whole(operation, a, b, data, **expected)

        memory = core.read_memory(0, 4000)
        registers = {name: core.read(REGISTERS[name][0]) for name in ("control", "root", "depth")}
        old = to_points(digging.world.rom().octree)
        digging.world.set([[12, 7, 7]], 1)
        with monkeypatch.context() as patched:
            patched.setattr(link, "ask", ask)
            digging.show()
        new_root = core.read(REGISTERS["root"][0])
        assert new_root != registers["root"]
        device.close()
        shown = []
        for count in range(len(sent)):
            core.write_memory(0, memory)
            for name, value in registers.items():
                core.write(REGISTERS[name][0], value)
            with client(address) as one:
                assert one.prove("")[0] == 0
                one.line.sendall(sent[:count])
                one.line.shutdown(socket.SHUT_WR)
                while one.answer() is not None:
                    pass
            words = core.read_memory(0, 4000)
            words[0] = words[core.read(REGISTERS["root"][0])]
            shown.append(core.read(REGISTERS["root"][0]) == new_root)
            if not shown[-1]:
                for one, other in zip(old, to_points(Octree(4, words)), strict=True):
                    np.testing.assert_array_equal(one, other)
    assert shown == sorted(shown)
    assert len(shown) > 4 * 32


@pytest.mark.parametrize("after", range(0, 16, 2))
def test_an_unplugged_cable_shows_the_old_voxels_or_the_new(after):
    board = Board()
    digging = Digging(opened_serial(board), seed=7)
    digging.begin()
    digging.device.frame(digging.view())
    digging.edit()
    digging.show()
    before = board.screen()
    digging.edit()
    board.faults = chain(repeat("", after), repeat("unplug"))
    with contextlib.suppress(DeviceError):
        digging.show()
    after_it = board.screen()
    # Another process connects to the board: the host goes on with its world.
    board.faults, board.unplugged = iter(()), False
    device = opened_serial(board)
    loaded = device.loaded()
    assert loaded is not None
    digging.device, digging.memory = device, SceneMemory(device, loaded)
    digging.begin()
    now = board.screen()
    assert np.array_equal(after_it, before) or np.array_equal(after_it, now)
    digging.edit()
    digging.show()
    assert digging.wrong() == 0


def test_a_host_that_connects_again_writes_nothing_where_the_memories_agree():
    board = Board()
    digging = Digging(opened_serial(board), seed=8)
    digging.begin()
    for _ in range(4):
        digging.edit()
        digging.show()
    device = opened_serial(board)
    loaded = device.loaded()
    root = digging.world.live_roots[-1]
    assert root != 0
    assert loaded.base + loaded.scene.roots[0] == root
    view = view_of(digging.scene, SIZE)
    model = ModelDevice()
    SceneMemory(model).load(replace(loaded.scene, roots=(0,), colours=digging.scene.colours), ignore)
    np.testing.assert_array_equal(model.frame(view).colour, digging.expected())
    digging.memory = SceneMemory(device, loaded)
    writes = []
    device.write_memory = lambda *write: writes.append(write)
    digging.begin()
    assert writes == []


@pytest.mark.parametrize("fault", ["lose request", "damage request", "cut answer", "damage answer"])
def test_disturbed_patches_arrive(fault):
    board = Board(sdram=True)
    digging = Digging(opened_serial(board), seed=9)
    digging.begin()
    board.faults = chain.from_iterable(repeat((fault, ""), 400))
    for _ in range(6):
        digging.edit()
        digging.show()
        assert digging.wrong() == 0


def test_a_voxel_takes_less_than_a_kilobyte_of_the_serial_line():
    points = np.random.default_rng(3).integers(0, 1 << 10, (20, 3))
    oak = Material("oak", (160, 110, 60))
    rom = Rom("dust", from_points(points, [1] * 20, depth=10), (EMPTY, oak))
    board = Board()
    device = opened_serial(board)
    memory, world = SceneMemory(device), World(rom)
    scene = with_materials(replace(boxes(1), words=rom.octree.words, depth=10), rom.materials)
    memory.load(scene, ignore)
    memory.begin_edits(world, scene)
    sent = []
    write, answer = board.write, board.answer
    board.write = lambda data: (sent.append(len(data)), write(data))
    board.answer = lambda data: (found := answer(data), sent.append(len(found)))[0]
    for place in ([500, 3, 77], [1000, 900, 800]):
        sent.clear()
        world.set([place], 1)
        assert memory.show_edits(scene) >= 9
        assert sum(sent) < 1000


def test_neighbouring_blocks_are_one_write():
    addresses = np.array([1, 9, 25, 41, 49, 57], np.uint32)
    blocks = np.arange(48, dtype=np.uint32).reshape(6, 8)
    writes = list(block_writes(Patch(73, 0, addresses, blocks)))
    assert [address for address, _ in writes] == [1, 25, 41]
    np.testing.assert_array_equal(np.concatenate([words for _, words in writes]), blocks.ravel())
    assert list(block_writes(Patch(73, 0, addresses[:0], blocks[:0]))) == []


def test_an_edit_holds_no_device_but_for_its_root():
    device = FakeDevice(capacity=4000)
    digging = Digging(device)
    digging.begin()
    digging.show()
    device.calls.clear()
    digging.world.set([[3, 3, 3], [4, 4, 4]], [1, 0])
    digging.show()
    assert set(device.calls) == {"write_memory", "select_scene"}
