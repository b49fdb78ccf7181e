"""How large a picture a board can trace while its screen is drawn: exact cycles of the verilated ray tracer.

A board without a frame buffer traces each line before the screen needs it. A line of 640 pixels lasts 800 clocks of
25 MHz. A picture of half the size has four times as long for each pixel.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt import sim
from voxrt.octree.camera import refit
from voxrt.rtl.configurations import read_configurations

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera, Lighting

SCREEN = (640, 480)
PIXEL_HZ = 25_000_000
LINE_PIXELS = 800
"""With the horizontal blanking."""
LINES = 525
"""With the vertical blanking."""
LARGEST_SCALE = 2

_BANDS = 8
_VIEWS = 8


@dataclass(frozen=True, slots=True)
class BeamFit:
    """What a board shows of a scene.

    Attributes
    ----------
    scale
        0: pictures of 640 x 480 pixels; 1: 320 x 240; 2: 160 x 120.
    cycles_per_pixel
        The mean of the view that takes longest.
    band_cycles_per_pixel
        The mean of the slowest band of rows, an eighth of a picture.
    granted_cycles_per_pixel
        What the screen leaves for each pixel of a row.
    frames_per_second
        New pictures per second in the view that takes longest.
    """

    scale: int
    cycles_per_pixel: float
    band_cycles_per_pixel: float
    granted_cycles_per_pixel: float
    frames_per_second: float

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows of the pictures."""
        return SCREEN[0] >> self.scale, SCREEN[1] >> self.scale


def fit_beam(
    rom: Rom,
    cameras: Sequence[Camera],
    lighting: Lighting,
    *,
    lanes: int,
    clock_hz: int,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> BeamFit:
    """Find the largest pictures that a board traces in time, from all around a scene.

    The cycles are counted by the verilated ray tracer with the board's number of lanes, in eight of the views.

    Parameters
    ----------
    rom
        The scene.
    cameras
        Of the orbit, for pictures of 640 x 480 pixels.
    lighting
        Of the pictures.
    lanes
        Of the board's ray tracer.
    clock_hz
        Its clock.
    progress
        Receives how many views are complete, of how many.

    Raises
    ------
    SimulatorError
        The verilated ray tracer is missing, or has no such lanes, or cannot hold the scene.
    """
    config = _configuration(lanes, lighting)
    views = [cameras[i * len(cameras) // _VIEWS] for i in range(min(_VIEWS, len(cameras)))]
    size = SCREEN[0] >> 1, SCREEN[1] >> 1
    costs = []
    for number, view in enumerate(views):
        progress(number, len(views) + 1)
        costs.append(_band_cycles(rom, refit(view, SCREEN, size), size, lighting, config))
    slowest = int(np.argmax([max(cost) for cost in costs]))
    for scale in range(LARGEST_SCALE + 1):
        progress(len(views), len(views) + 1)
        size = SCREEN[0] >> scale, SCREEN[1] >> scale
        granted = clock_hz * LINE_PIXELS / PIXEL_HZ / SCREEN[0] * 4**scale
        cost = costs[slowest]
        if scale != 1 and (scale == LARGEST_SCALE or max(cost) <= 2 * granted):
            cost = _band_cycles(rom, refit(views[slowest], SCREEN, size), size, lighting, config)
        if max(cost) <= granted or scale == LARGEST_SCALE:
            break
    mean = float(np.mean(cost))
    screen = clock_hz * LINE_PIXELS * LINES / PIXEL_HZ  # cycles
    screens = max(1, int(np.ceil(mean * size[0] * size[1] / screen)))
    progress(len(views) + 1, len(views) + 1)
    return BeamFit(scale, mean, max(cost), granted, PIXEL_HZ / (LINE_PIXELS * LINES * screens))


def _configuration(lanes: int, lighting: Lighting) -> str:
    """Name the verilated configuration with so many lanes, a memory of one port per lane, and the features."""
    for each in read_configurations().values():
        built = each.parameters
        if built["Lanes"] == lanes and not built["Banked"] and not lighting.features - set(each.features):
            return each.name
    raise sim.SimulatorError(f"no simulated ray tracer has {lanes} lanes and {', '.join(sorted(lighting.features))}")


def _band_cycles(rom: Rom, camera: Camera, size: tuple[int, int], lighting: Lighting, config: str) -> list[float]:
    """Give the cycles per pixel of each band of rows, rendered as a picture of its own."""
    width, height = size
    rows = height // _BANDS
    cycles = []
    for band in range(_BANDS):
        # direction = look + right (column - W / 2) + up (H / 2 - row): a band is a picture with another look.
        shift = height // 2 - band * rows - rows // 2
        look = np.array(camera.look) + shift * np.array(camera.up)
        x, y, z = (int(value) for value in look)
        # refit finds the largest registers that hold this look. They are rounded anew: some directions move by 1 %.
        seen = refit(replace(camera, look=(x, y, z)), (rows, rows), (width, rows))
        frame = sim.render(rom, seen, (width, rows), engine="rtl", config=config, lighting=lighting)
        cycles.append((frame.cost.cycles or 0) / (width * rows))
    return cycles
