"""How large a picture a board can trace while its screen is drawn: exact cycles of the verilated ray tracer.

A board without a frame buffer traces each line before the screen needs it. A line of 640 pixels lasts 800 clocks of
25 MHz. A picture of half the size has four times as long for each pixel.
"""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt import sim
from voxrt.board.designs.description import CACHED
from voxrt.octree.camera import Camera
from voxrt.rtl.configurations import read_configurations
from voxrt.sim import _model
from voxrt.sim.engine_arguments import registers_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from voxrt.octree import Rom
    from voxrt.octree.camera import Lighting

SCREEN = (640, 480)
SCREEN_HZ = 25_000_000 / (800 * 525)
SMALL = (160, 120)
"""Columns and rows of the pictures that `fit_frames` counts cycles in."""
_VIEWS = 8
SDRAM_CLOCKS = (40, 30)
"""Times of an SDRAM that a screen reads too: clocks from a line's address to its first beat, and from line to line."""


class BoardTracer(Struct, frozen=True):
    """The ray tracer of a board: what decides how fast it is."""

    lanes: int
    ray_clocks: int
    clock_hz: int
    buffer_lines: int  # rows of a picture that the board's line buffer holds


class BeamFit(Struct, frozen=True):
    """What a board shows of a scene.

    `lead`: how many lines of the screen each row is complete before it is shown, at least. It is negative where rows
    are repeated because the next one is not complete, even in the smallest pictures.
    """

    scale: int  # 0: pictures of 640 x 480 pixels; 1: 320 x 240; 2: 160 x 120
    cycles_per_pixel: float  # the mean of the view that takes longest
    lead: float
    frames_per_second: float  # new pictures per second in the view that takes longest

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows of the pictures."""
        return SCREEN[0] >> self.scale, SCREEN[1] >> self.scale


def fit_beam(
    rom: Rom,
    cameras: Sequence[Camera],
    lighting: Lighting,
    tracer: BoardTracer,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> BeamFit:
    """Find the largest pictures that a board traces in time, from all around a scene.

    The cycles are counted by the verilated ray tracer with the board's number of lanes, in eight views of the orbit
    `cameras`, which is for pictures of 640 x 480 pixels: in small pictures of all, and in full ones of the two that
    take longest. `progress` receives how many pictures are complete, of how many. It raises SimulatorError if that ray
    tracer is missing, has no such lanes, or cannot hold the scene.
    """
    config = configuration_of(tracer.lanes, tracer.ray_clocks, lighting)
    registers = np.array([registers_of(camera) for camera in cameras])
    search = _model.BeamSearch(registers, tracer.clock_hz, tracer.buffer_lines)

    def count(band: _model.Band) -> int:
        camera = Camera(*(tuple(triple) for triple in band.camera.tolist()))
        size = band.width, band.rows
        return sim.render(rom, camera, size, engine="rtl", config=config, lighting=lighting).cost.cycles or 0

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        while not search.ended:
            progress(search.done, search.total)
            for cycles in pool.map(count, [search.band(ahead) for ahead in range(search.left)]):
                search.give(cycles)
    progress(search.done, search.total)
    return BeamFit(*search.fit())


def fit_frames(
    rom: Rom,
    cameras: Sequence[Camera],
    lighting: Lighting,
    tracer: BoardTracer,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> BeamFit:
    """Estimate how many pictures a board with a frame buffer shows per second, as :func:`fit_beam` does.

    The cycles are counted by the verilated ray tracer with caches that has as many lanes, or the next fewer, in
    pictures of the size SMALL, from cold caches. A board with more lanes than that, or with a larger L2, is faster than
    this tells.
    """
    cached = [each for each in read_configurations().values() if each.parameters["MemoryForm"] == CACHED]
    config = max(
        (each for each in cached if each.parameters["Lanes"] <= tracer.lanes), key=lambda each: each.parameters["Lanes"]
    )
    cycles = 0.0
    for number, camera in enumerate(cameras[:: len(cameras) // _VIEWS]):
        progress(number, _VIEWS)
        frame = sim.render(
            rom, camera, SMALL, engine="rtl", config=config.name, lighting=lighting, dram=sim.Dram(*SDRAM_CLOCKS)
        )
        cycles = max(cycles, (frame.cost.cycles or 0) / (SMALL[0] * SMALL[1]))
    # A frame starts at a vertical blanking.
    screens = math.ceil(cycles * SCREEN[0] * SCREEN[1] * SCREEN_HZ / tracer.clock_hz)
    return BeamFit(0, cycles, 0.0, SCREEN_HZ / max(1, screens))


def configuration_of(lanes: int, ray_clocks: int, lighting: Lighting) -> str:
    """Name the verilated configuration with these lanes, a memory of one port per lane, and the features."""
    wanted = {"Lanes": lanes, "RayClocks": ray_clocks, "MemoryForm": 0}
    for each in read_configurations().values():
        if wanted.items() <= each.parameters.items() and not lighting.features - set(each.features):
            return each.name
    features = f" and {', '.join(sorted(lighting.features))}" if lighting.features else ""
    clocks = f", {ray_clocks} clocks per ray" if ray_clocks > 1 else ""
    raise sim.SimulatorError(f"no simulated ray tracer has {lanes} lanes{clocks}{features}")
