"""The driver over TCP, the agent, and a fake of PYNQ with the verilated core inside."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from fakes.box_scenes import boxes, ignore
from fakes.pynq import BASE, Core, install
from msgspec.structs import replace

from voxrt.board import register_device
from voxrt.board.agent import voxrt_board
from voxrt.board.errors import DeviceError, Refused
from voxrt.board.registers import REGISTERS
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import Camera, View, frame_world
from voxrt.board.view_check import check_view
from voxrt.rtl.configurations import read_configurations

SIZE = (64, 48)
RTL = Path(__file__).parents[2] / "rtl"


@pytest.fixture
def core():
    pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
    return Core()


def test_frames(monkeypatch, core, open_board):
    vdma = install(monkeypatch, core)
    device = open_board()
    assert device.identity.capacity == 16377  # the mapped words, in whole blocks
    assert (device.identity.depth, device.identity.position_limit) == (16, 1 << 21)
    memory, model = SceneMemory(device), ModelDevice()
    for seed in (1, 2):
        scene = boxes(seed, 3)
        memory.load(scene, ignore)
        SceneMemory(model).load(scene, ignore)
        for size in (SIZE, (32, 24), (32, 24)):
            view = View(frame_world(3, size), size, (9, 8, 7))
            frame, expected = device.frame(view), model.frame(view)
            assert (frame.colour == expected.colour).all()
            assert len(np.unique(frame.colour.reshape(-1, 3), axis=0)) > 4
            assert frame.counters.rays == size[0] * size[1]
            assert frame.counters.rays < frame.counters.words_read <= frame.counters.cycles
            assert len(vdma.memory) == 1
    registers = device.registers()
    assert registers["size"] == 32 | 24 << 16
    assert registers["position[0]"] == view.camera.position[0] & 0xFFFFFFFF
    device.close()
    open_board()  # the agent has ended the work for the client before, and the core is the test's again
    assert core.read(REGISTERS["control"][0]) == 4
    assert vdma.status == 1, "halted"
    assert len(vdma.memory) == 1, "one buffer serves frames of all sizes"


def test_faults(monkeypatch, core, open_board):
    vdma = install(monkeypatch, core)
    device = open_board()
    memory = SceneMemory(device)
    memory.load(boxes(1, 3), ignore)
    view = View(Camera((-20, 5, 900), (0, 0, -90), (1, 0, 0), (0, 1, 0)), SIZE)
    good = device.frame(view).colour
    with pytest.raises(DeviceError, match="reports a direction overflow;"):
        device.frame(replace(view, camera=replace(view.camera, right=(32767, 0, 0), up=(32767, 0, 0))))
    device.write_memory(0, np.array([7], dtype=np.uint32))
    with pytest.raises(DeviceError, match="reports a bad pointer"):
        device.frame(view)
    device.write_memory(0, np.array([1], dtype=np.uint32))
    with pytest.raises(Refused, match="holds 16377"):
        memory.load(replace(boxes(1, 3), words=np.full(16385, 0xFFFFFF01, dtype=np.uint32)), ignore)
    core.vdma_errors = 1 << 8
    with pytest.raises(DeviceError, match=r"the VDMA reports an error \(early line\); the frame was dropped"):
        device.frame(view)
    core.vdma_errors = 0
    assert (device.frame(view).colour == good).all()
    with monkeypatch.context() as patch:
        patch.setattr(register_device, "_STUCK_SECONDS", 0.0)
        core.hangs = True
        with pytest.raises(DeviceError, match="the frame does not end: no pixel came"):
            device.frame(view)
        core.hangs = False
    assert (device.frame(view).colour == good).all()
    with monkeypatch.context() as patch:
        patch.setattr(voxrt_board, "VDMA_SECONDS", 0.0)
        patch.setattr(vdma, "tick", lambda: core.run(100))  # the channel writes no frame
        with pytest.raises(DeviceError, match="the VDMA did not answer"):
            device.frame(view)
    assert (device.frame(view).colour == good).all()


def test_widths_that_the_vdma_cannot_write(monkeypatch, core, open_board):
    install(monkeypatch, core)
    device = open_board()
    SceneMemory(device).load(boxes(1, 3), ignore)
    view = View(frame_world(3, SIZE), SIZE)
    check_view(view, device.identity)
    for columns in (1, 4, 44, 62, 63):
        with pytest.raises(Refused, match=f"{columns} columns are no multiple of 8, which board at 127"):
            check_view(replace(view, size=(columns, 48)), device.identity)


def test_other_hardware(monkeypatch, core, open_board):
    with pytest.raises(voxrt_board.RefusedError, match=r"^voxrt\.bit: no ray tracer .*No module named 'pynq'"):
        open_board()
    install(monkeypatch, core)
    with pytest.raises(voxrt_board.RefusedError, match=r"^missing: no ray tracer \(OSError"):
        voxrt_board.Board("missing")
    core.identity = 7
    with pytest.raises(DeviceError, match="the ray tracer does not answer"):
        open_board()


def test_the_block_design_has_these_names():
    design = (RTL / "vivado" / "build.tcl").read_text()
    cells = re.findall(r"create_bd_cell .* (\w+)$", design, re.MULTILINE)
    assert set(voxrt_board.PARTS) < set(cells)
    for name, base in BASE.items():
        assert re.search(rf"{name}/\w+ 0x{base:08X}", design)
    mapped = int(re.search(r"memory/S_AXI 0x\w+ (\d+)K", design)[1]) << 10
    assert mapped >= 4 * read_configurations()["z1"].words
