"""The driver of the board, register by register, against a stand-in with the exact model inside."""

from __future__ import annotations

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracles import worlds
from oracles.cuts import memory_of
from stand_ins.pynq import Core, install

from voxrt.board import register_device
from voxrt.board.errors import DeviceError, Refused
from voxrt.board.pynq_device import open_pynq
from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.board.scene import Scene
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.view import Camera, View
from voxrt.board.viewpoint import face_world
from voxrt.sim.device import ModelDevice

SIZE = (64, 48)
GENERATED = Path(__file__).parents[2] / "rtl" / "generated" / "voxrt_registers.py"


def scene_of(seed, depth=3):
    colours = np.random.default_rng(seed).integers(40, 256, (256, 3), dtype=np.uint8)
    words = memory_of(worlds.boxes(depth, 3, seed))
    return Scene(f"world {seed}", depth, words, colours, np.zeros(256, dtype=bool))


def ignore(_stage, _done, _total):
    pass


def test_frames(monkeypatch):
    core = Core()
    channel = install(monkeypatch, core)
    device = open_pynq("voxrt.bit")
    assert device.identity.capacity == 513
    assert (device.identity.depth, device.identity.position_limit) == (10, 1 << 16)
    memory, model = SceneMemory(device), ModelDevice()
    for seed in (1, 2):
        scene = scene_of(seed)
        memory.swap(scene, ignore)
        SceneMemory(model).swap(scene, ignore)
        for size in (SIZE, (32, 24), (32, 24)):
            view = View(face_world(3, size), size, (9, 8, 7))
            frame, expected = device.frame(view), model.frame(view)
            assert (frame.colour == expected.colour).all()
            assert len(np.unique(frame.colour.reshape(-1, 3), axis=0)) > 4
            assert (frame.counters.rays, frame.counters.cycles) == (size[0] * size[1], 3 * size[0] * size[1])
    assert channel.kept == 0
    assert device.registers()["size"] == 32 | 24 << 16
    device.close()
    assert core.values["control"] == 4


def test_faults(monkeypatch):
    core = Core()
    install(monkeypatch, core)
    device = open_pynq("voxrt.bit")
    memory = SceneMemory(device)
    memory.swap(scene_of(1), ignore)
    view = View(Camera((-20, 5, 900), (0, 0, -90), (1, 0, 0), (0, 1, 0)), SIZE)
    core.errors = 1 << 8 | 1 << 9
    with pytest.raises(DeviceError, match="met a direction overflow and a bad pointer"):
        device.frame(view)
    core.errors = 0
    device.frame(view)
    with pytest.raises(Refused, match="holds 513"):
        memory.swap(replace(scene_of(1), words=np.full(521, 0xFFFFFF01, dtype=np.uint32)), ignore)
    with pytest.raises(DeviceError, match="an octree at word 8"):
        device.select_scene(8, 3)
    monkeypatch.setattr(register_device, "_FRAME_SECONDS", 0.0)
    core.hangs = True
    with pytest.raises(DeviceError, match="the frame does not end"):
        device.frame(view)
    core.hangs = False
    monkeypatch.undo()
    device.frame(view)


def test_other_hardware(monkeypatch):
    with pytest.raises(DeviceError, match="this machine has no PYNQ"):
        open_pynq("voxrt.bit")
    install(monkeypatch, Core(identity=7))
    with pytest.raises(DeviceError, match="no voxrt ray tracer answers"):
        open_pynq("voxrt.bit")
    with pytest.raises(DeviceError, match="cannot be opened"):
        open_pynq("missing")


def test_the_map_is_the_generated_one():
    if not GENERATED.exists():
        pytest.skip("rtl/generated is not there yet")
    made = runpy.run_path(str(GENERATED))
    assert (made["REGISTERS"], made["MATERIALS"]) == (REGISTERS, MATERIALS)
