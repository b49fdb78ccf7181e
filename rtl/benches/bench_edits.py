"""Frames with an edit between any two, from the core's pins. Blocks that nothing reads are written while the frame of
the old root is traced, then the word of the root and the register; with resets, and stalls of stream and bus.

EDITED_FRAMES is the number of frames. Blocks are soon used again, so what a cache keeps too long shows.
"""

import os
import random

import cocotb
import numpy as np
from bench_cached_core import BASE, CachedCore
from cocotb.triggers import ClockCycles, RisingEdge
from core_driver import CAMERA, COLOURS, Core, scene
from oracles.ray import render

FRAMES = int(os.environ.get("EDITED_FRAMES", "16"))
SIZE, DEPTH = (9, 11), 3
BLOCKS = 150  # of the memory; the first one has the words of roots


class EditedMemory:
    """The words of a memory that is edited: equal blocks once, new ones where no live root reads."""

    def __init__(self):
        self.blocks = {}
        self.live = {}  # word of the root by its address
        self.chance = random.Random(random.randrange(1 << 30))

    def edit(self, voxels):
        """Give the writes of an edit, each an address and its words, and at last that of the root."""
        shared = {self.blocks[address]: address for address in self.reached()}
        free = [8 * block + 1 for block in range(1, BLOCKS) if 8 * block + 1 not in shared.values()]
        self.chance.shuffle(free)
        new = {}

        def word_of(cube):
            if (cube == cube.flat[0]).all():
                return 0xFFFFFF00 | int(cube.flat[0])
            half = len(cube) // 2
            corners = [(half * (octant & 1), half * (octant >> 1 & 1), half * (octant >> 2)) for octant in range(8)]
            children = tuple(word_of(cube[x : x + half, y : y + half, z : z + half]) for x, y, z in corners)
            if children not in shared:
                shared[children] = free.pop()
                new[shared[children]] = children
            return shared[children]

        word = word_of(voxels)
        self.blocks |= new
        root = self.chance.choice([address for address in range(9) if address not in self.live])
        self.live[root] = word
        return [*new.items(), (root, (word,))]

    def reached(self):
        """Give the addresses of the blocks that live roots read."""
        found, open_words = set(), list(self.live.values())
        while open_words:
            word = open_words.pop()
            if not word >> 31 and word not in found:
                found.add(word)
                open_words += self.blocks[word]
        return found


class OnChip:
    """The memory port."""

    def __init__(self, core):
        self.core = core

    async def write(self, address, words):
        dut = self.core.dut
        dut.bram_en_i.value = 1
        dut.bram_we_i.value = 15
        for place, word in enumerate(words, address):
            dut.bram_addr_i.value = 4 * place
            dut.bram_wrdata_i.value = word
            await RisingEdge(dut.clk_i)
        dut.bram_en_i.value = 0

    async def flush(self):
        """Do nothing: there is no cache."""


class External:
    """The memory behind the caches."""

    def __init__(self, core):
        self.core = core
        core.bus.words = [0] * (1 + 8 * BLOCKS)

    async def write(self, address, words):
        await RisingEdge(self.core.dut.clk_i)
        self.core.bus.words[address : address + len(words)] = words

    async def flush(self):
        await self.core.write("control", flush=1)


async def begun(dut):
    """Give a core in reset no longer, and its memory."""
    if int(dut.MemoryForm.value) == 2:
        core = CachedCore(dut)
        core.bus.latency, core.bus.jitter, core.bus.stalls = 8, 20, 0.2
        cocotb.start_soon(core.serve())
        await core.start()
        await core.write("memory_base", address=BASE >> 5)
        return core, External(core)
    core = Core(dut)
    await core.start()
    return core, OnChip(core)


@cocotb.test()
async def an_edit_between_any_two_frames(dut):
    """No pixel is wrong, and none is of two edits."""
    core, device = await begun(dut)
    chance = random.Random(random.randrange(1 << 30))
    await core.set_frame(CAMERA, *SIZE, DEPTH)
    memory, voxels = EditedMemory(), scene(1)
    edited = voxels.copy()
    shown = None
    resets = 0
    for number in range(FRAMES + 1):
        core.ready = iter(lambda: chance.random() < 0.6, 2) if number % 3 else iter(lambda: 1, 2)
        if shown is not None:
            await core.write("control", start=1)
            await ClockCycles(dut.clk_i, chance.randrange(300))
        *blocks, root = memory.edit(edited)
        for address, words in blocks:
            await device.write(address, words)
            if chance.random() < 0.1:
                await ClockCycles(dut.clk_i, chance.randrange(100))
        early = shown is not None and chance.random() < 0.5  # the frame has latched its root
        if early:
            await show(core, device, root)
        if shown is not None and chance.random() < 0.15:
            await ClockCycles(dut.clk_i, chance.randrange(500))
            await core.soft_reset()
            resets += 1
        elif shown is not None:
            await core.wait()
            np.testing.assert_array_equal(core.picture(*SIZE), shown, f"frame {number}")
        if not early:
            await show(core, device, root)
        memory.live = {root[0]: root[1][0]}
        shown = render(edited, CAMERA, *SIZE, COLOURS)[0]
        edited = edited.copy()
        low = [chance.randrange(8) for _ in range(3)]
        part = tuple(slice(start, start + chance.choice([1, 1, 1, 2, 4])) for start in low)
        edited[part] = chance.choice([0, 0, 1, 2, 255])
    assert resets or FRAMES < 16
    cocotb.log.info("%d frames, %d resets", FRAMES, resets)


async def show(core, device, root):
    """Write the word of a root, then the register; caches drop what they hold before the next frame."""
    await device.write(*root)
    await core.write("root", address=root[0])
    await device.flush()
