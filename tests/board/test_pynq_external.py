"""The driver over TCP, the agent and the fake of PYNQ where the octree is in the processor's memory."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.box_scenes import boxes, ignore, picture_of, scene_of, view_of
from fakes.pynq import Core, install
from msgspec.structs import replace

from voxrt.board.agent.voxrt_board import WORDS_BEFORE, Board, RefusedError
from voxrt.board.errors import DeviceError
from voxrt.board.registers import REGISTERS
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.core import open_rtl
from voxrt.octree import from_points
from voxrt.rtl.configurations import read_configurations

SIZE = (64, 48)
FRAME_BYTES = 3 * 1920 * 1080
XC7Z020_WORDS = 140 * 1024  # of all its block RAM, without parity bits


def shows(device, scene):
    view = view_of(scene, SIZE)
    return (device.frame(view).colour == picture_of(scene, view)).all()


@pytest.fixture
def core():
    pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
    return Core("cached1")


def scattered(count, depth=9):
    places = np.random.default_rng(depth).integers(0, 1 << depth, (count, 3))
    return scene_of(from_points(places, [1 + place % 7 for place in range(count)], depth=depth).words, depth)


def test_frames(monkeypatch, core, open_board):
    vdma = install(monkeypatch, core)
    device = open_board()
    assert (device.identity.depth, device.identity.position_limit) == (12, 1 << 18)
    assert device.identity.capacity > read_configurations()["z1"].words
    registers = device.registers()
    assert registers["memory_base"] in vdma.memory
    assert registers["memory_base"] % 32 == 0
    memory = SceneMemory(device)
    roots = []
    for scene in (boxes(1), boxes(2), boxes(3, depth=3), boxes(1)):
        memory.load(scene, ignore)
        roots.append(device.registers()["root"])
        for size in (SIZE, (32, 24)):
            view = view_of(scene, size)
            colour = device.frame(view).colour
            assert (colour == picture_of(scene, view)).all()
            assert len(np.unique(colour.reshape(-1, 3), axis=0)) > 4
    assert roots[0] == 0 != roots[1], "the second scene is beside the first"
    device.close()
    open_board()  # the agent has ended the work for the client before, and keeps the octree's memory
    assert registers["memory_base"] in vdma.memory
    assert len(vdma.memory) == 2


def test_a_scene_that_no_block_ram_holds(monkeypatch, core, open_board):
    install(monkeypatch, core)
    device = open_board()
    scene = scattered(20000)
    assert len(scene.words) > XC7Z020_WORDS
    SceneMemory(device).load(scene, ignore)
    assert shows(device, scene)
    assert device.registers()["lines_read"] > 100


def test_words_that_are_overwritten(monkeypatch, core, open_board):
    """Two scenes that do not fit together stand at the same place: caches must not keep the words of the first."""
    first, second = boxes(1), boxes(2)
    install(monkeypatch, core)
    device = open_board()
    device.identity = replace(device.identity, capacity=max(len(first.words), len(second.words)))
    memory = SceneMemory(device)
    for scene in (first, second, first):
        memory.load(scene, ignore)
        for _ in range(2):
            assert shows(device, scene)
        assert device.registers()["root"] == 0


def test_what_is_read_back_comes_from_the_memory(monkeypatch, core, open_board):
    """And not from the processor's caches: otherwise reading back would prove nothing."""
    vdma = install(monkeypatch, core)
    device = open_board()
    words = np.arange(100, 120, dtype=np.uint32)
    device.write_memory(40, words)
    buffer = vdma.memory[device.registers()["memory_base"]]
    kept = buffer.dram.view(np.uint32)[WORDS_BEFORE:]
    assert (kept[40:60] == words).all()
    kept[45] = 7
    assert device.read_memory(44, 3).tolist() == [104, 7, 106]


def test_level_of_detail_of_an_earlier_program_is_off(monkeypatch, core, open_board):
    install(monkeypatch, core)
    core.write(REGISTERS["lod"][0], 1 << 31 | 1 << 10)
    device = open_board()
    assert device.registers()["lod"] == 0
    scene = boxes(2)
    SceneMemory(device).load(scene, ignore)
    assert shows(device, scene)


def test_it_takes_most_of_what_is_free_and_leaves_room_for_a_frame(monkeypatch, core, open_board):
    free = 24 << 20
    vdma = install(monkeypatch, core, contiguous=free)
    device = open_board()
    assert len(vdma.memory) == 2
    buffer = vdma.memory[device.registers()["memory_base"]]
    assert (free - FRAME_BYTES) * 3 // 4 - 4 <= buffer.nbytes <= free - FRAME_BYTES
    assert device.identity.capacity in range(len(buffer) - WORDS_BEFORE - 7, len(buffer) - WORDS_BEFORE + 1)
    device._video.expect(device.identity.size)
    assert len(vdma.memory) == 2


def test_errors_of_the_bus_are_one_line(monkeypatch, core, open_board):
    vdma = install(monkeypatch, core)
    device = open_board()
    memory = SceneMemory(device)
    scene = boxes(1)
    memory.load(scene, ignore)
    base = device.registers()["memory_base"]
    words = vdma.memory[base].dram.view(np.uint32)
    core.map_external(base, words[:8])  # nothing but the root answers
    device.write_memory(0, scene.words[:1])
    with pytest.raises(DeviceError, match=r"^the ray tracer reports that the bus to its octree refused a read; .*$"):
        device.frame(view_of(scene, SIZE))
    core.map_external(base, words)
    assert shows(device, scene)
    read, timeout = core.read, 1 << REGISTERS["status"][1]["bus_timeout"][0]
    core.read = lambda offset: read(offset) | (timeout if offset == REGISTERS["status"][0] else 0)
    with pytest.raises(DeviceError, match=r"^the ray tracer reports that the bus to its octree did not answer; .*$"):
        device.frame(view_of(scene, SIZE))


def test_memory_that_the_core_cannot_use(monkeypatch, core):
    for free in (FRAME_BYTES + 1000, FRAME_BYTES - 1):
        vdma = install(monkeypatch, core, contiguous=free)
        with pytest.raises(RefusedError, match=r"^contiguous memory is too small for an octree and a frame; .*$"):
            Board("voxrt.bit")
        assert len(vdma.memory) == (free >= FRAME_BYTES)
    install(monkeypatch, core, first_address=0x8_0000_0000)
    with pytest.raises(RefusedError, match=r"^contiguous memory is beyond the 4 GiB of the ray tracer; .*$"):
        Board("voxrt.bit")


def test_a_block_design_for_the_other_form(monkeypatch, core, open_board):
    with monkeypatch.context() as patch:
        patch.setattr(core, "cached", False)
        install(patch, core)
        with pytest.raises(DeviceError, match="has its octree in external memory, and the block design does not"):
            open_board()
    tiny = Core("tiny")
    tiny.cached, tiny.map_external = True, lambda _address, _words: None
    install(monkeypatch, tiny)
    with pytest.raises(DeviceError, match="has its octree on the chip, and the block design does not"):
        open_board()


def test_the_simulated_core(core):  # noqa: ARG001 - skips where there is none
    device = open_rtl("cached1")
    assert device.identity.capacity == read_configurations()["cached1"].words
    memory = SceneMemory(device)
    for scene in (boxes(1), boxes(2)):
        memory.load(scene, ignore)
        assert shows(device, scene)
    device.close()
