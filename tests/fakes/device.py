"""A fake device and scenes for tests; the pixels tell the memory, the camera and the number of the frame."""

from __future__ import annotations

import math
import threading

import numpy as np
import pytest

from voxrt.board.device import Counters, Frame, Identity
from voxrt.board.errors import DeviceError, FrameDropped, TooSlow
from voxrt.board.patch_writes import write_patch
from voxrt.board.scene import Scene
from voxrt.sim import SimulatorError

CAPACITY = 4096


def scene(name: str = "scene", blocks: int = 1, material: int = 1, **fields) -> Scene:
    """A chain of `blocks` blocks: octant 0 of each is a pointer to the next, the others hold `material`."""
    words = np.full(1 + 8 * blocks, 0xFFFFFF00 | material, dtype=np.uint32)
    for block in range(blocks):
        words[0 if block == 0 else 1 + 8 * (block - 1)] = 1 + 8 * block
    colours = np.zeros((256, 3), dtype=np.uint8)
    colours[:] = np.arange(256)[:, None]
    return Scene(name, max(1, min(16, blocks)), words, colours, np.zeros(256, dtype=bool), **fields)


def opened_or_skipped(opened):
    """Open a simulated device; skip the test where this installation has none."""
    try:
        return opened()
    except SimulatorError as error:
        pytest.skip(str(error))


def wide_scene(name: str, blocks: int, material: int = 1) -> Scene:
    """A scene of many blocks and three levels: the first block has up to 8 pointers, its children up to 64."""
    words = np.full(1 + 8 * blocks, 0xFFFFFF00 | material, dtype=np.uint32)
    words[0] = 1
    for block in range(1, blocks):
        words[block] = 1 + 8 * block
    base = scene(name)
    return Scene(name, 16, words, base.colours, base.mirrors)


class FakeDevice:
    """All pixels are (material at the end of the path of octants 1, camera's x, number of the frame)."""

    def __init__(self, capacity: int = CAPACITY, size: tuple[int, int] = (64, 48), **identity) -> None:
        self.identity = Identity("fake", "1", capacity, 16, size, 1 << 20, **identity)
        self.memory = np.zeros(capacity, dtype=np.uint32)
        self.colours = np.zeros((256, 3), dtype=np.uint8)
        self.root = self.depth = 0
        self.frames = 0
        self.closed = False
        self.fail_write_at: int | None = None  # the write that fails, counted from 0
        self.forget_write_at: int | None = None  # the write that leaves a wrong word
        self.fail_frames: Exception | None = None
        self.stopped = False
        self.dropped = 0
        self.may_finish = threading.Event()
        self.may_finish.set()
        self.busy = threading.Lock()
        self.writes = 0
        self.calls = []  # names of the methods that changed something, in order

    def loaded(self):
        return None

    def registers(self):
        return {"root": self.root, "depth": self.depth, "frames": self.frames}

    def hold(self):
        self.calls.append("hold")

    def write_memory(self, address, words):
        self.calls.append("write_memory")
        assert 0 <= address <= address + len(words) <= self.identity.capacity
        if self.writes == self.fail_write_at:
            self.fail_write_at = None
            raise DeviceError("the bus does not answer")
        self.memory[address : address + len(words)] = words
        if self.writes == self.forget_write_at:
            self.forget_write_at = None
            self.memory[address] ^= 0x100
        self.writes += 1

    def read_memory(self, address, count):
        return self.memory[address : address + count].copy()

    def write_materials(self, colours, _mirrors):
        self.calls.append("write_materials")
        self.colours = colours.copy()

    def select_scene(self, root, depth):
        self.calls.append("select_scene")
        self.root, self.depth = root, depth

    def apply_patch(self, patch, depth):
        write_patch(self, patch, depth)

    def octree(self):
        """The material of every leaf that the root reaches, by its path of octants."""
        found, paths = {}, [((), self.root)]
        while paths:
            path, address = paths.pop()
            word = int(self.memory[address])
            if word >> 31:
                found[path] = word & 0xFF
            else:
                assert len(path) < self.depth
                paths += [((*path, i), word + i) for i in range(8)]
        return found

    def frame(self, view, seconds=math.inf, drop=None):
        assert self.busy.acquire(blocking=False), "two calls at a time"
        try:
            if drop is not None:
                drop.call_when_requested(self.may_finish.set)
            if not self.may_finish.wait(min(seconds, 10)):
                assert seconds < 10
                raise TooSlow(f"the frame took more than {seconds:.1f} s")
            if self.stopped:
                raise DeviceError("the frame was stopped")
            if drop is not None and drop.requested:
                self.dropped += 1
                raise FrameDropped
            if self.fail_frames:
                raise self.fail_frames
            self.frames += 1
            self.calls.append("frame")
            word = int(self.memory[self.root])
            for _ in range(self.depth):
                word = word if word >> 31 else int(self.memory[word + 1])
            colour = np.empty((view.size[1], view.size[0], 3), dtype=np.uint8)
            colour[:] = (word & 0xFF, view.camera.position[0] & 0xFF, self.frames & 0xFF)
            return Frame(colour, Counters(colour.shape[0] * colour.shape[1], 7, 11, 0.001))
        finally:
            self.busy.release()

    def stop(self):
        self.stopped = True
        self.may_finish.set()

    def close(self):
        self.closed = True


def never_merged(depth: int, name: str = "endless") -> Scene:
    """Empty space whose equal octants were never merged: 8 words per level, and rays that visit every voxel."""
    words = np.full(1 + 8 * depth, 0xFFFFFF00, dtype=np.uint32)
    words[0] = 1
    for level in range(depth - 1):
        words[1 + 8 * level : 9 + 8 * level] = 9 + 8 * level
    base = scene(name)
    return Scene(name, depth, words, base.colours, base.mirrors)
