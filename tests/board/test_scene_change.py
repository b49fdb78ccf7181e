"""Scenes change by the register `root`: every frame shows one scene, by the register driver on the verilated core."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.box_scenes import boxes, ignore, picture_of, view_of
from fakes.pynq import Core, install
from msgspec.structs import replace

from voxrt.board.errors import DeviceError
from voxrt.board.register_writes import decode_fields
from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.core import open_rtl
from voxrt.boards.core_files import each_write

SIZE = (32, 24)
NAMES = {address: name for name, (address, _) in REGISTERS.items()}
HOLD = 1 << REGISTERS["control"][1]["hold"][0]
START = 1 << REGISTERS["control"][1]["start"][0]
FLUSH = 1 << REGISTERS["control"][1]["flush"][0]


class Recorder:
    """Writes of registers and of the memory, in order, as (name, value)."""

    def __init__(self, device):
        self.writes = []
        self._device, self._registers, self._memory = device, device._registers, device._memory
        device._registers = device._memory = self

    def read(self, offsets):
        return self._registers.read(offsets)

    def write(self, writes):
        self.writes += [(NAMES.get(offset, "materials"), value) for offset, value in each_write(writes)]
        self._registers.write(writes)

    def __len__(self):
        return len(self._memory)

    def __getitem__(self, words):
        return self._memory[words]

    def __setitem__(self, words, values):
        self.writes.append(("memory", words.start))
        self._memory[words] = values


# The scenes differ in depth and colours, so that any mixture of the two shows. Loading one takes several steps.
OLD, NEW = boxes(1, 3, 6000), boxes(2, 4, 6000)


def fields_of(device, name):
    return decode_fields(name, device.registers()[name])


@pytest.fixture(params=["simulated core", "PYNQ", "PYNQ, external memory"])
def open_device(request, monkeypatch, open_board):
    """A function that opens the same hardware, again at every call."""
    pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
    core = Core("cached1" if request.param == "PYNQ, external memory" else "tiny")
    if request.param != "simulated core":
        install(monkeypatch, core)
        return open_board

    class Module:
        CORES = ("tiny",)

        @staticmethod
        def Core(_config):  # noqa: N802 - the class of the native module
            return core._core

    monkeypatch.setattr("voxrt.board.simulated.core.import_verilated", lambda _advice: Module)
    return lambda: open_rtl("tiny")


def test_frames_while_the_next_scene_is_loaded(open_device):
    device = open_device()
    recorder = Recorder(device)
    memory = SceneMemory(device)
    memory.load(OLD, ignore)
    views = [view_of(OLD, SIZE), replace(view_of(NEW, SIZE), background=OLD.background)]
    old = [picture_of(OLD, view) for view in views]
    new = picture_of(NEW, view_of(NEW, SIZE))
    assert not any((picture == new).all() for picture in old)
    for scene, view, picture in ((NEW, view_of(NEW, SIZE), new), (OLD, views[0], old[0])):
        present = memory.loaded
        frames = 0
        recorder.writes.clear()
        for _ in memory.load_in_steps(scene, ignore):
            written = [name for name, _ in recorder.writes]
            assert set(written) <= {"memory"}  # no step holds the device or writes a register
            for seen in views:
                assert (device.frame(seen).colour == picture_of(present, seen)).all()
                frames += 1
            recorder.writes.clear()
        assert frames >= 8
        # The last step: all of the change happens while no frame can start.
        names = [name for name, _ in recorder.writes]
        assert (names.count("root"), names.count("depth"), names.count("materials")) == (1, 1, 256)
        assert [value for name, value in recorder.writes if name == "control"] == [HOLD, HOLD]
        assert names[0] == "control"
        assert names[-1] == "root"
        assert "memory" not in names
        assert (device.frame(view).colour == picture).all()
        assert device.registers()["depth"] == scene.depth


def test_words_written_during_a_frame(open_device, monkeypatch):
    device = open_device()
    memory = SceneMemory(device)
    memory.load(OLD, ignore)
    view = view_of(OLD, (96, 72))
    picture = picture_of(OLD, view)
    loading = memory.load_in_steps(NEW, ignore)
    advance, steps = device._pause, 0

    def write_and_advance():
        nonlocal steps
        if steps < 3 and fields_of(device, "status")["busy"]:
            next(loading)
            steps += 1
        advance()

    with monkeypatch.context() as patch:
        patch.setattr(device, "_pause", write_and_advance)
        while steps < 3:
            assert (device.frame(view).colour == picture).all()
    for _ in loading:
        assert (device.frame(view).colour == picture).all()
    assert (device.frame(view_of(NEW, SIZE)).colour == picture_of(NEW, view_of(NEW, SIZE))).all()


def test_a_failed_or_aborted_load(open_device, monkeypatch):
    device = open_device()
    memory = SceneMemory(device)
    memory.load(OLD, ignore)
    root = device.registers()["root"]
    view = view_of(OLD, SIZE)
    picture = picture_of(OLD, view)
    steps = len(list(memory.load_in_steps(NEW, ignore)))
    memory.load(OLD, ignore)
    for taken in range(steps + 1):  # aborted after every step but the last
        loading = memory.load_in_steps(NEW, ignore)
        for _ in range(taken):
            next(loading)
        loading.close()
        assert device.registers()["root"] == root
        assert (device.frame(view).colour == picture).all()
    read = device.read_memory
    with monkeypatch.context() as patch:
        patch.setattr(device, "read_memory", lambda address, count: read(address, count) ^ np.uint32(1))
        with pytest.raises(DeviceError, match="upload again"):
            memory.load(NEW, ignore)
    assert memory.loaded is OLD
    assert (device.frame(view).colour == picture).all()
    select = device.select_scene
    faults = [DeviceError("the bus does not answer")]

    def fail_once(*place):
        select(*place)
        if faults:
            raise faults.pop()

    with monkeypatch.context() as patch:
        patch.setattr(device, "select_scene", fail_once)
        with pytest.raises(DeviceError, match="the bus does not answer"):
            memory.load(NEW, ignore)
    assert (device.frame(view).colour == picture).all()
    memory.load(NEW, ignore)
    assert (device.frame(view_of(NEW, SIZE)).colour == picture_of(NEW, view_of(NEW, SIZE))).all()


def test_scenes_that_do_not_fit_together(open_device):
    device = open_device()
    capacity = 16377
    device.identity = replace(device.identity, capacity=capacity)
    recorder = Recorder(device)
    memory = SceneMemory(device)
    for scene in (boxes(3, 3, capacity - 100), boxes(4, 4, capacity - 200)):
        recorder.writes.clear()
        assert list(memory.load_in_steps(scene, ignore)) == []  # no frame during the load
        assert recorder.writes[0] == ("control", HOLD)
        assert all(value & HOLD for name, value in recorder.writes if name == "control")
        view = view_of(scene, SIZE)
        recorder.writes.clear()
        assert (device.frame(view).colour == picture_of(scene, view)).all()
        flushes = [HOLD | FLUSH] if fields_of(device, "configuration")["cached"] else []
        assert [value for name, value in recorder.writes if name == "control"] == [*flushes, START]
        assert device.registers()["root"] == 0


def test_a_root_of_an_earlier_program_is_not_traced(open_device):
    first = open_device()
    memory = SceneMemory(first)
    memory.load(OLD, ignore)
    memory.load(NEW, ignore)
    assert first.registers()["root"] > 0
    assert first.registers()["depth"] == NEW.depth
    second = open_device()
    assert (second.registers()["root"], second.registers()["depth"]) == (0, 1)
    view = replace(view_of(NEW, SIZE), background=(9, 8, 7))
    assert (second.frame(view).colour == (9, 8, 7)).all()
    SceneMemory(second).load(OLD, ignore)
    assert (second.frame(view_of(OLD, SIZE)).colour == picture_of(OLD, view_of(OLD, SIZE))).all()


def test_the_material_table_is_not_a_register():
    assert MATERIALS not in NAMES
