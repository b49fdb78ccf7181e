"""Loading a scene: a failure at any write leaves the present scene as it is."""

from __future__ import annotations

from contextlib import nullcontext

import numpy as np
import pytest
from fakes.box_scenes import boxes, ignore, picture_of, view_of
from fakes.device import FakeDevice, scene, wide_scene
from fakes.ecp5_board import Board
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from voxrt.board.designs.serial_device import SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.edited_scene import with_materials
from voxrt.board.errors import DeviceError, Refused
from voxrt.board.scene import Scene, check_memory
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.octree import Rom, from_dense
from voxrt.octree.words import move_pointers
from voxrt.voxelize import EMPTY, Material


def leaves(words, depth):
    device = FakeDevice(len(words))
    device.memory[:], device.depth = words, depth
    return device.octree()


def test_scenes_alternate_between_both_ends():
    device = FakeDevice(capacity=73)
    memory = SceneMemory(device)
    roots = []
    for blocks in (1, 2, 3, 2, 6, 8, 1):
        new = scene(blocks=blocks, material=blocks)
        memory.load(new, ignore)
        assert memory.loaded is new
        assert device.octree() == leaves(new.words, new.depth)
        roots.append(device.root)
    # The scene of 6 blocks (49 words) fits below word 56. No scene fits beside the one of 8 blocks (65 words).
    assert roots == [0, 56, 0, 56, 0, 0, 0]


@pytest.mark.parametrize("kind", ["model", "serial"])
def test_a_scene_that_differs_little_is_a_patch(kind):
    """As when somebody models it: materials change their numbers, too."""
    rng = np.random.default_rng(6)
    device = ModelDevice(capacity=1 << 15)
    if kind == "serial":
        device = SerialDevice(SerialLink("test port", Board(sdram=True)), ModelDevice())
    cube = np.zeros((16, 16, 16), np.uint8)
    cube[:, :12] = rng.integers(1, 4, (16, 12, 16))
    memory, written, root = SceneMemory(device), [], set()
    write = device.write_memory
    device.write_memory = lambda address, words: (written.append(len(words)), write(address, words))[1]
    for number in range(14):
        if number == 9:
            cube[:] = rng.integers(0, 4, cube.shape)
        elif number:
            low = rng.integers(0, 14, 3)
            cube[tuple(slice(at, at + 2) for at in low)] = 4 if number % 2 else 0
        rom = Rom("model", from_dense(cube), (EMPTY, *(Material(f"m{i}", (i, number, 9)) for i in range(1, 6))))
        scene = with_materials(replace(boxes(1), words=rom.octree.words, depth=4), rom.materials)
        written.clear()
        memory.load(scene, ignore)
        if number in {0, 9}:
            assert sum(written) == len(scene.words)
        else:
            assert sum(written) < len(scene.words) // 4
        view = view_of(scene, (48, 32))
        np.testing.assert_array_equal(device.frame(view).colour, picture_of(scene, view))
        root.add(memory.loaded.roots[0])
    assert len(root) > 3
    memory.load(scene, ignore)
    assert sum(written) >= len(scene.words), "the same scene is written again"


def test_a_patch_that_fails_leaves_the_present_scene():
    cube = np.random.default_rng(3).integers(1, 4, (16, 16, 16)).astype(np.uint8)
    device = ModelDevice(capacity=1 << 14)
    memory, scenes = SceneMemory(device), []
    for number in range(3):
        cube[number] = 1 + number
        words = from_dense(cube).words
        scenes.append(replace(boxes(1), words=words, depth=4))
    memory.load(scenes[0], ignore)

    def fail():
        raise DeviceError("too slow")

    view = view_of(scenes[0], (48, 32))
    for number in (1, 2):
        with pytest.raises(DeviceError, match="too slow"):
            list(memory.load_in_steps(scenes[number], ignore, fail))
        np.testing.assert_array_equal(device.frame(view).colour, picture_of(scenes[number - 1], view))
        memory.load(scenes[number], ignore)
        np.testing.assert_array_equal(device.frame(view).colour, picture_of(scenes[number], view))


@given(st.lists(st.integers(1, 40), min_size=2, max_size=8), st.integers(41, 80))
def test_two_scenes_that_fit_are_never_overwritten(sizes, blocks):
    """Whenever both fit, all steps but the last one leave the present scene as it is and do not hold the device."""
    device = FakeDevice(capacity=1 + 8 * blocks)
    memory = SceneMemory(device)
    present = None
    for material, size in enumerate(sizes, start=1):
        new = wide_scene(str(material), size, material)
        if present is None or len(present.words) + len(new.words) + 7 > device.identity.capacity:
            memory.load(new, ignore)
        else:
            device.calls.clear()
            shown, root = device.octree(), device.root
            for _ in memory.load_in_steps(new, ignore):
                assert (device.octree(), device.root) == (shown, root)
                assert set(device.calls) == {"write_memory"}
            assert device.calls == ["write_memory", "write_materials", "select_scene"]
        assert device.octree() == leaves(new.words, new.depth)
        present = new


def test_the_steps_of_a_scene_of_millions_of_words_are_longer():
    """Between two steps there may be a frame."""
    device = FakeDevice(capacity=1 << 23)
    memory = SceneMemory(device)
    memory.load(scene(), ignore)
    new = wide_scene("new", 400_000)
    assert len(list(memory.load_in_steps(new, ignore))) == 2 * 256
    assert (device.memory[device.root :][: len(new.words)] == move_pointers(new.words, device.root)).all()


def test_frames_between_the_steps_of_a_large_scene():
    device = FakeDevice(capacity=40000)
    memory = SceneMemory(device)
    memory.load(wide_scene("old", 2000, material=3), ignore)
    old = device.octree()
    stages = []
    for _ in memory.load_in_steps(wide_scene("new", 2500, material=4), lambda *stage: stages.append(stage)):
        assert device.octree() == old
    assert set(device.octree().values()) == {4}
    starts = range(0, 20001, 4096)
    assert stages == [(stage, start, 20001) for stage in ("write", "verify") for start in starts] + [
        ("verify", 20001, 20001)
    ]


def test_scenes_that_do_not_fit_are_written_while_the_device_is_held():
    device = FakeDevice(capacity=73)
    memory = SceneMemory(device)
    memory.load(scene(blocks=5), ignore)
    device.calls.clear()
    assert list(memory.load_in_steps(scene(blocks=6, material=2), ignore)) == []
    assert device.calls == ["hold", "write_memory", "write_materials", "select_scene"]
    assert set(device.octree().values()) == {2}


@pytest.mark.parametrize("steps", range(8))
def test_an_aborted_load_leaves_the_present_scene(steps):
    device = FakeDevice(capacity=40000)
    memory = SceneMemory(device)
    old, new = wide_scene("old", 1500, material=3), wide_scene("new", 1500, material=4)
    memory.load(old, ignore)
    loading = memory.load_in_steps(new, ignore)
    assert [next(loading) for _ in range(min(steps, 6))] == [None] * min(steps, 6)
    loading.close()
    assert memory.loaded is old
    assert device.octree() == leaves(old.words, old.depth)
    memory.load(new, ignore)
    assert device.octree() == leaves(new.words, new.depth)


@pytest.mark.parametrize("method", ["write_materials", "select_scene"])
def test_a_failed_switch_leaves_the_present_scene(method, monkeypatch):
    device = FakeDevice(capacity=400)
    memory = SceneMemory(device)
    old = scene("old", material=3)
    memory.load(old, ignore)
    new = Scene("new", 1, np.array([0xFFFFFF04], dtype=np.uint32), 255 - old.colours, old.mirrors)
    works = getattr(device, method)
    faults = [DeviceError("the bus does not answer")]

    def fail_once(*values):
        works(*values)
        if faults:
            raise faults.pop()

    monkeypatch.setattr(device, method, fail_once)
    with pytest.raises(DeviceError, match="the bus does not answer"):
        memory.load(new, ignore)
    assert memory.loaded is old
    assert device.octree() == leaves(old.words, old.depth)
    assert (device.colours == old.colours).all()


def test_a_failed_first_load_leaves_empty_space():
    device = FakeDevice(capacity=400)
    memory = SceneMemory(device)
    device.forget_write_at = 0
    with pytest.raises(DeviceError, match="reads"):
        memory.load(scene(blocks=3), ignore)
    assert memory.loaded is None
    assert device.octree() == {(): 0}


@pytest.mark.parametrize("capacity", [2401 + 2201, 2 * 2401 + 16])
@pytest.mark.parametrize("fault", ["fail_write_at", "forget_write_at"])
def test_a_failed_transfer_leaves_the_present_scene(capacity, fault):
    device = FakeDevice(capacity=capacity)
    memory = SceneMemory(device)
    old = wide_scene("old", 300, material=3)
    memory.load(old, ignore)
    setattr(device, fault, device.writes)
    with pytest.raises(DeviceError):
        memory.load(wide_scene("new", 275, material=4), ignore)
    assert memory.loaded is old
    assert device.octree() == leaves(old.words, old.depth)
    memory.load(wide_scene("new", 275, material=4), ignore)
    assert set(device.octree().values()) == {4}


def test_a_failure_at_every_write():
    old, new = wide_scene("old", 8, material=3), wide_scene("new", 8, material=4)
    big = Scene("big", 16, np.tile(old.words, 1), old.colours, old.mirrors)
    for write in range(4):
        device = FakeDevice(capacity=len(old.words) + 8)
        memory = SceneMemory(device)
        memory.load(big, ignore)
        device.fail_write_at = device.writes + write
        try:
            memory.load(new, ignore)
        except DeviceError:
            assert set(device.octree().values()) == {3}
        else:
            assert set(device.octree().values()) == {4}


def test_too_large_before_the_first_word():
    device = FakeDevice(capacity=16)
    memory = SceneMemory(device)
    with pytest.raises(Refused, match="scene has 17 words and fake holds 16; build it with a smaller depth"):
        memory.load(scene(blocks=2), ignore)
    assert device.writes == 0


def test_a_device_that_cannot_be_restored_says_so():
    device = FakeDevice(capacity=2401)
    memory = SceneMemory(device)
    memory.load(wide_scene("old", 300), ignore)

    def broken(_address, _words):
        raise DeviceError("the bus does not answer")

    device.write_memory = broken
    with pytest.raises(DeviceError, match="and the present scene could not be restored"):
        memory.load(wide_scene("new", 300), ignore)


@pytest.mark.parametrize(
    ("words", "depth", "problem"),
    [
        ([1, 1] + [0xFFFFFF00] * 7, 3, "word 0x1: pointer 00000001 leads back"),
        ([9] + [0xFFFFFF00] * 8, 3, "word 0x0: pointer 00000009 leads behind"),
        ([2] + [0xFFFFFF00] * 8, 3, "word 0x0: pointer 00000002 does not stand at the start of a block"),
        ([0] + [0xFFFFFF00] * 8, 3, "word 0x0: pointer 00000000 does not stand at the start of a block"),
        ([1, 0x80000001] + [0xFFFFFF00] * 7, 3, "word 0x1: 80000001 is neither"),
        ([1, 9] + [0xFFFFFF00] * 15, 1, "word 0x1: pointer 00000009 lies below depth 1"),
        ([0xFFFFFF00] * 8, 3, "8 words are not a root and blocks of 8"),
        ([], 3, "there is no word"),
        ([0xFFFFFF00], 0, "depth 0 is outside"),
        ([0xFFFFFF00], 17, "depth 17 is outside"),
    ],
)
def test_malformed_memories(words, depth, problem):
    with pytest.raises(Refused, match=problem):
        check_memory(np.array(words, dtype=np.uint32), depth)


@pytest.mark.parametrize(
    ("roots", "problem"),
    [((), "no frame"), ((0, 9), "root at word 9 of 9"), ((-1,), "root at word -1"), ((0, 1), None)],
)
def test_roots(roots, problem):
    words = np.array([1] + [0xFFFFFF07] * 8, dtype=np.uint32)
    with pytest.raises(Refused, match=problem) if problem else nullcontext():
        check_memory(words, 3, roots)


@given(st.lists(st.integers(0, 2**32 - 1) | st.integers(0, 40), max_size=41), st.integers(1, 5))
def test_accepted_memories_are_octrees(words, depth):
    words = np.array(words, dtype=np.uint32)
    try:
        check_memory(words, depth)
    except Refused:
        return
    leaves(words, depth)  # asserts


@given(st.integers(1, 6), st.integers(0, 100))
def test_relocated(blocks, eighths):
    there = scene(blocks=blocks)
    device = FakeDevice(1024)
    device.memory[8 * eighths : 8 * eighths + len(there.words)] = move_pointers(there.words, 8 * eighths)
    device.root, device.depth = 8 * eighths, there.depth
    assert device.octree() == leaves(there.words, there.depth)
