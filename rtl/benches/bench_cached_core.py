"""The whole core with its octree in an external memory, behind caches of a few lines, from its pins."""

import random

import cocotb
import numpy as np
from axi_memory import DECERR, SLVERR, AxiMemory, PinPort
from cocotb.triggers import ClockCycles, ReadOnly, RisingEdge
from core_driver import CAMERA, COLOURS, Core, scene
from oracles.memory import words_of
from oracles.ray import render

BASE, SIZE = 0x3000_0020, (13, 19)


class CachedCore(Core):
    def __init__(self, dut):
        super().__init__(dut)
        chance = random.Random(random.randrange(1 << 30))
        self.bus = AxiMemory([PinPort(dut, f"m_axi{port}") for port in range(2)], chance, BASE)

    async def begin(self, voxels):
        self.bus.words = words_of(voxels).tolist()
        cocotb.start_soon(self.serve())
        await self.start()
        await self.write("memory_base", address=BASE >> 5)
        await self.set_frame(CAMERA, *SIZE, 3)

    async def serve(self):
        while True:
            self.bus.drive()
            await ReadOnly()
            if int(self.dut.rst_ni.value):
                self.bus.edge()
            await RisingEdge(self.dut.clk_i)


def seen(voxels):
    return render(voxels, CAMERA, *SIZE, COLOURS)[0]


@cocotb.test()
@cocotb.parametrize((("latency", "jitter", "stalls"), [(1, 0, 0.0), (5, 30, 0.4), (50, 0, 0.0), (200, 60, 0.2)]))
async def frames_are_exact(dut, latency, jitter, stalls):
    """Whatever the memory's pace, and under back-pressure of the stream."""
    core = CachedCore(dut)
    core.bus.latency, core.bus.jitter, core.bus.stalls = latency, jitter, stalls
    voxels = scene(latency)
    await core.begin(voxels)
    chance = random.Random(latency)
    core.ready = iter(lambda: chance.randrange(2), 2)
    np.testing.assert_array_equal(await core.trace(*SIZE), seen(voxels))
    assert await core.read("configuration", "cached") == 1
    words, requests = await core.read("words_read", "value"), await core.read("word_requests", "value")
    lines, requested = await core.read("lines_read", "value"), await core.read("line_requests", "value")
    assert 0 < words <= requests
    assert 0 < lines <= requested <= requests + words
    assert await core.read("status", "bus_error") == await core.read("status", "bus_timeout") == 0


@cocotb.test()
async def scenes_are_swapped_with_a_flush(dut):
    """Write the memory while no frame is traced, flush at any clock before that: the next frame shows it."""
    core = CachedCore(dut)
    core.bus.jitter = 25
    voxels = scene(1)
    await core.begin(voxels)
    np.testing.assert_array_equal(await core.trace(*SIZE), seen(voxels))
    for number in range(2, 7):
        await core.write("control", start=1)
        await ClockCycles(dut.clk_i, random.randrange(1500))
        await core.write("control", flush=1)
        await core.wait()
        np.testing.assert_array_equal(core.picture(*SIZE), seen(voxels))
        voxels = scene(number)
        core.bus.words = words_of(voxels).tolist()
        np.testing.assert_array_equal(await core.trace(*SIZE), seen(voxels))


@cocotb.test()
async def soft_reset_at_any_clock(dut):
    """With bursts under way; the next frame is whole, of a scene that was written at once."""
    core = CachedCore(dut)
    core.bus.latency, core.bus.jitter = 30, 60
    await core.begin(scene(1))
    for number in range(8):
        await core.write("control", start=1)
        await ClockCycles(dut.clk_i, random.randrange(1, 700))
        await core.soft_reset()
        voxels = scene(number)
        core.bus.words = words_of(voxels).tolist()
        np.testing.assert_array_equal(await core.trace(*SIZE), seen(voxels))


@cocotb.test()
@cocotb.parametrize(response=[SLVERR, DECERR])
async def a_bus_error_ends_the_frame_with_a_flag(dut, response):
    """And the next frame is whole."""
    core = CachedCore(dut)
    voxels = scene(5)
    await core.begin(voxels)
    for clocks in (0, 40, 333, 900):
        await core.write("control", start=1)
        await ClockCycles(dut.clk_i, clocks)
        core.bus.response = response
        await core.wait()
        core.picture(*SIZE)
        assert await core.read("status", "bus_error") == 1
        assert await core.read("status", "bad_pointer") == 0
        await core.write("status", bus_error=1)
        core.bus.response = 0
        np.testing.assert_array_equal(await core.trace(*SIZE), seen(voxels))
        assert await core.read("status", "bus_error") == 0


@cocotb.test()
async def a_silent_bus_ends_the_frame_with_a_flag(dut):
    """After 65,536 clocks; when it speaks again, the next frame is whole."""
    core = CachedCore(dut)
    voxels = scene(6)
    await core.begin(voxels)
    await core.write("control", start=1)
    await ClockCycles(dut.clk_i, 100)
    core.bus.silent = True
    await core.wait()
    core.picture(*SIZE)
    await core.write("status", bus_error=1)  # clears that flag alone
    assert await core.read("status", "bus_timeout") == 1
    await core.write("status", bus_timeout=1)
    core.bus.silent = False
    np.testing.assert_array_equal(await core.trace(*SIZE), seen(voxels))
    assert await core.read("status", "bus_timeout") == 0
