"""Scenes in memory: what breaks on the way leaves the old one running, at every single write."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.device import PaintedDevice, scene, wide_scene
from hypothesis import given
from hypothesis import strategies as st

from voxrt.board.errors import DeviceError, Refused
from voxrt.board.scene import Scene, check_memory, relocate
from voxrt.board.scene_memory import SceneMemory


def ignore(_stage, _done, _total):
    pass


def leaves(words, depth):
    device = PaintedDevice(len(words))
    device.memory[:], device.depth = words, depth
    return device.octree()


def test_swap_between_two_places():
    device = PaintedDevice(capacity=72)
    memory = SceneMemory(device)
    roots = []
    for blocks in (1, 2, 3, 2):
        new = scene(blocks=blocks, material=blocks)
        memory.swap(new, ignore)
        assert memory.running is new
        assert device.octree() == leaves(new.words, new.depth)
        roots.append(device.root)
    assert roots == [0, 16, 40, 0]


@pytest.mark.parametrize("capacity", [2401 + 2201, 2 * 2401 + 16])
@pytest.mark.parametrize("fault", ["fail_write_at", "forget_write_at"])
@pytest.mark.parametrize("write", [0])
def test_broken_transfer_leaves_the_old_scene(capacity, fault, write):
    device = PaintedDevice(capacity=capacity)
    memory = SceneMemory(device)
    old = wide_scene("old", 300, material=3)
    memory.swap(old, ignore)
    setattr(device, fault, device.writes + write)
    with pytest.raises(DeviceError):
        memory.swap(wide_scene("new", 275, material=4), ignore)
    assert memory.running is old
    assert device.octree() == leaves(old.words, old.depth)
    memory.swap(wide_scene("new", 275, material=4), ignore)
    assert set(device.octree().values()) == {4}


def test_broken_at_every_write_of_a_large_scene():
    old, new = wide_scene("old", 8, material=3), wide_scene("new", 8, material=4)
    big = Scene("big", 16, np.tile(old.words, 1), old.colours, old.mirrors)
    for write in range(4):
        device = PaintedDevice(capacity=len(old.words) + 8)
        memory = SceneMemory(device)
        memory.swap(big, ignore)
        device.fail_write_at = device.writes + write
        try:
            memory.swap(new, ignore)
        except DeviceError:
            assert set(device.octree().values()) == {3}
        else:
            assert set(device.octree().values()) == {4}


def test_too_large_before_the_first_word():
    device = PaintedDevice(capacity=16)
    memory = SceneMemory(device)
    with pytest.raises(Refused, match="scene has 17 words and painter holds 16; build it with a smaller depth"):
        memory.swap(scene(blocks=2), ignore)
    assert device.writes == 0


def test_a_device_that_cannot_be_restored_says_so():
    device = PaintedDevice(capacity=2401)
    memory = SceneMemory(device)
    memory.swap(wide_scene("old", 300), ignore)

    def broken(_address, _words):
        raise DeviceError("the bus does not answer")

    device.write_memory = broken
    with pytest.raises(DeviceError, match="and the old scene could not be restored"):
        memory.swap(wide_scene("new", 300), ignore)


@pytest.mark.parametrize(
    ("words", "depth", "problem"),
    [
        ([1, 1] + [0xFFFFFF00] * 7, 3, "word 0x1 points deeper than 3 levels"),
        ([9] + [0xFFFFFF00] * 8, 3, "word 0x0 points to no block"),
        ([2] + [0xFFFFFF00] * 8, 3, "word 0x0 points to no block"),
        ([0] + [0xFFFFFF00] * 8, 3, "word 0x0 points to no block"),
        ([1, 0x80000001] + [0xFFFFFF00] * 7, 3, "word 0x1 is neither"),
        ([0xFFFFFF00] * 8, 3, "8 words are not a root and blocks of 8"),
        ([], 3, "0 words are not"),
        ([0xFFFFFF00], 0, "a depth of 0"),
        ([0xFFFFFF00], 17, "a depth of 17"),
    ],
)
def test_malformed_memories(words, depth, problem):
    with pytest.raises(Refused, match=problem):
        check_memory(np.array(words, dtype=np.uint32), depth)


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
    device = PaintedDevice(1024)
    device.memory[8 * eighths : 8 * eighths + len(there.words)] = relocate(there.words, 8 * eighths)
    device.root, device.depth = 8 * eighths, there.depth
    assert device.octree() == leaves(there.words, there.depth)
