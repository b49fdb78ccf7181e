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

BUFFER_LINES = 16
"""Rows of a picture that the boards' line buffers hold."""

_BANDS = 12
_VIEWS = 8
_SAFETY = 1.05  # for what lies between the views


@dataclass(frozen=True, slots=True)
class BeamFit:
    """What a board shows of a scene.

    Attributes
    ----------
    scale
        0: pictures of 640 x 480 pixels; 1: 320 x 240; 2: 160 x 120.
    cycles_per_pixel
        The mean of the view that takes longest.
    lead
        How many lines of the screen each row is complete before it is shown, at least. Negative where rows are
        repeated because the next one is not complete, even in the smallest pictures.
    frames_per_second
        New pictures per second in the view that takes longest.
    """

    scale: int
    cycles_per_pixel: float
    lead: float
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
    ray_clocks: int = 1,
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
    lanes, ray_clocks
        Of the board's ray tracer: its parameters ``Lanes`` and ``RayClocks``.
    clock_hz
        Its clock.
    progress
        Receives how many views are complete, of how many.

    Raises
    ------
    SimulatorError
        The verilated ray tracer is missing, or has no such lanes, or cannot hold the scene.
    """
    config = _configuration(lanes, ray_clocks, lighting)
    views = [cameras[i * len(cameras) // _VIEWS] for i in range(min(_VIEWS, len(cameras)))]
    line = clock_hz * LINE_PIXELS / PIXEL_HZ

    def measure(view: Camera, scale: int) -> list[float]:
        size = SCREEN[0] >> scale, SCREEN[1] >> scale
        return _row_cycles(rom, refit(view, SCREEN, size), size, lighting, config)

    costs = []
    for number, view in enumerate(views):
        progress(number, len(views) + 1)
        costs.append(measure(view, 1))
    leads = [beam_lead(cost, line, 1) for cost in costs]
    slowest = int(np.argmin(leads))
    progress(len(views), len(views) + 1)
    scale, cost, lead = 1, costs[slowest], leads[slowest]
    # Pictures of twice the side take nearly twice as long per row, and rows have half the time.
    trials = ((0, [2 * row for row in cost for _ in range(2)]),) if lead >= 0 else ((2, None),)
    for trial, estimate in trials:
        if estimate is None or beam_lead(estimate, line, trial) >= 0:
            tried = measure(views[slowest], trial)
            if trial == LARGEST_SCALE or beam_lead(tried, line, trial) >= 0:
                scale, cost, lead = trial, tried, beam_lead(tried, line, trial)
    screens = max(1, int(np.ceil(sum(cost) / (line * LINES))))
    progress(len(views) + 1, len(views) + 1)
    return BeamFit(
        scale,
        sum(cost) / ((SCREEN[0] >> scale) * (SCREEN[1] >> scale)),
        lead,
        PIXEL_HZ / (LINE_PIXELS * LINES * screens),
    )


def beam_lead(rows: Sequence[float], line: float, scale: int) -> float:
    """Tell by how many lines of the screen each row of a picture is early, at least.

    Parameters
    ----------
    rows
        Cycles that each row takes.
    line
        Cycles of a line of the screen.
    scale
        A row is shown on 2**scale lines.

    Returns
    -------
    float
        Negative where a row is late.

    Examples
    --------
    >>> beam_lead([1000.0] * 480, 2400, 0) > 0, beam_lead([2500.0] * 480, 2400, 0) > 0
    (True, False)
    """
    shown = 2**scale * line
    blanking = (LINES - SCREEN[1]) * line
    end, lead = 0.0, np.inf
    for number, row in enumerate(rows):
        # A row needs a free place in the line buffer: that of the row which has just been shown to its end.
        begin = max(end, blanking + (number - BUFFER_LINES + 1) * shown) if number >= BUFFER_LINES else end
        end = begin + _SAFETY * row
        lead = min(lead, (blanking + number * shown - end) / line)
    return float(lead)


def _configuration(lanes: int, ray_clocks: int, lighting: Lighting) -> str:
    """Name the verilated configuration with these lanes, a memory of one port per lane, and the features."""
    wanted = {"Lanes": lanes, "RayClocks": ray_clocks, "MemoryForm": 0}
    for each in read_configurations().values():
        if wanted.items() <= each.parameters.items() and not lighting.features - set(each.features):
            return each.name
    features = f" and {', '.join(sorted(lighting.features))}" if lighting.features else ""
    clocks = f", {ray_clocks} clocks per ray" if ray_clocks > 1 else ""
    raise sim.SimulatorError(f"no simulated ray tracer has {lanes} lanes{clocks}{features}")


def _row_cycles(rom: Rom, camera: Camera, size: tuple[int, int], lighting: Lighting, config: str) -> list[float]:
    """Give the cycles of each row: the mean of its band, which is rendered as a picture of its own."""
    width, height = size
    rows = height // _BANDS
    cycles: list[float] = []
    for band in range(_BANDS):
        # direction = look + right (column - W / 2) + up (H / 2 - row): a band is a picture with another look.
        shift = height // 2 - band * rows - rows // 2
        x, y, z = (a + shift * b for a, b in zip(camera.look, camera.up, strict=True))
        # refit finds the largest registers that hold this look. They are rounded anew: some directions move by 1 %.
        seen = refit(replace(camera, look=(x, y, z)), (rows, rows), (width, rows))
        frame = sim.render(rom, seen, (width, rows), engine="rtl", config=config, lighting=lighting)
        cycles += [(frame.cost.cycles or 0) / rows] * rows
    return cycles
