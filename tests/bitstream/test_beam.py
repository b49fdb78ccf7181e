"""How large a board's pictures are: cycles of the verilated core against a line-by-line model of the screen."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

import voxrt
from voxrt.boards.beam import SCREEN, SCREEN_HZ, BoardTracer, fit_beam, fit_frames
from voxrt.octree.camera import Camera, look_at
from voxrt.sim import _model
from voxrt.views.viewpoint import orbit

BUFFER_LINES, LINES = 16, 525  # of the boards: board/designs/board_pkg.sv
BANDS = 12


def repeated_rows(rows, line, scale, buffer_lines=BUFFER_LINES):
    """Walk the screen's clock line by line: the rows that are not complete when their first line begins."""
    stored, done, remaining, repeated = 0, 0, rows[0], 0
    # Each step is 1/8 line. The trace starts with the vertical blanking.
    for step in range(8 * LINES):
        at = step / 8 - (LINES - SCREEN[1])
        shown = max(0, int(at // 2**scale))
        if at >= 0 and at % 2**scale == 0 and done <= shown < len(rows):
            repeated += 1
        stored = done - shown
        left = line / 8
        while left > 0 and done < len(rows) and stored < buffer_lines:
            step_cycles = min(left, remaining)
            left -= step_cycles
            remaining -= step_cycles
            if remaining <= 0:
                done, stored = done + 1, stored + 1
                remaining = rows[done] if done < len(rows) else 0
    return repeated


@given(
    st.lists(st.integers(100, 6000), min_size=12, max_size=12),
    st.sampled_from([0, 1, 2]),
    st.sampled_from([16, 32, 64]),
)
def test_a_lead_means_that_no_row_is_repeated(bands, scale, lines):
    rows = [float(cycles) for cycles in bands for _ in range((SCREEN[1] >> scale) // 12)]
    if _model.beam_lead(rows, 2400, scale, lines) >= 1:
        assert repeated_rows(rows, 2400, scale, lines) == 0


def test_slow_rows_are_late():
    for scale, fast, slow in ((0, 2200, 2300), (1, 4500, 4700), (2, 9000, 9300)):
        rows = SCREEN[1] >> scale
        assert _model.beam_lead([fast] * rows, 2400, scale, BUFFER_LINES) > 0
        # Beyond the blanking and the buffer, slow rows fall behind.
        assert _model.beam_lead([slow * 1.2] * rows, 2400, scale, BUFFER_LINES) < 0
        assert repeated_rows([slow * 1.2] * rows, 2400, scale) > 0


@pytest.fixture(scope="module")
def house():
    return voxrt.build("examples/house.obj", depth=5).rom


def search_of(cameras, clock_hz):
    views = [(view.position, view.look, view.right, view.up) for view in cameras]
    return _model.BeamSearch(np.array(views, np.int32), clock_hz, BUFFER_LINES)


@pytest.mark.parametrize(("megahertz", "expected"), [(20, 2), (75, 1), (400, 0)])
def test_the_view_that_takes_longest_decides(house, megahertz, expected):
    """Small pictures of all views find it, and its own picture says how long it takes."""
    rng = np.random.default_rng(megahertz)
    cameras = orbit(house, SCREEN, 8)
    for _ in range(20):
        cycles = dict(zip([camera.position for camera in cameras], rng.permutation(np.linspace(2, 12, 8)), strict=True))
        search, pictures = search_of(cameras, megahertz * 1e6), []
        while not search.ended:
            bands = [search.band(ahead) for ahead in range(search.left)]
            pictures.append((bands[0].width, sum(band.rows for band in bands)))
            for band in bands:
                search.give(cycles[tuple(band.camera[0].tolist())] * band.width * band.rows)
        scale, per_pixel, _, _ = search.fit()
        assert (scale, per_pixel) == (expected, pytest.approx(12))
        assert pictures[:10] == [(80, 60)] * 8 + [(320, 240)] * 2
        assert len(pictures) == 10 + (expected != 1)
        assert search.done == search.total == 11


def test_bands_cost_what_the_frame_costs(house):
    (camera,) = orbit(house, (320, 240), 1)
    whole = voxrt.render(house, camera, size=(320, 240), engine="rtl", config="tiny").cost.cycles
    search = search_of(orbit(house, SCREEN, 2), 75e6)
    cycles = []
    for _ in range(BANDS):
        band = search.band()
        assert (band.width, band.rows) == (320, 240 // BANDS)
        seen = Camera(*(tuple(triple) for triple in band.camera.tolist()))
        frame = voxrt.render(house, seen, size=(band.width, band.rows), engine="rtl", config="tiny")
        cycles.append(frame.cost.cycles)
        search.give(frame.cost.cycles)
    assert sum(cycles) == pytest.approx(whole, rel=0.05)
    assert search.done == 1


def test_a_slow_clock_takes_larger_pixels(house):
    cameras, lighting = orbit(house, SCREEN, 1), voxrt.Lighting()
    scales = [
        fit_beam(house, cameras, lighting, BoardTracer(1, 1, mega * 1_000_000, BUFFER_LINES)).scale
        for mega in (800, 75, 10)
    ]
    assert scales == [0, 1, 2]


def test_a_frame_buffer_shows_fewer_pictures_of_the_same_size(house):
    cameras, lighting = orbit(house, (160, 120), 8), voxrt.Lighting()
    fits = [fit_frames(house, cameras, lighting, BoardTracer(2, 1, mega * 1_000_000, 0)) for mega in (1000, 75, 7)]
    assert [fit.scale for fit in fits] == [0, 0, 0]
    assert fits[0].frames_per_second == SCREEN_HZ
    assert fits[1].frames_per_second > fits[2].frames_per_second
    for fit in fits:  # each is shown for whole screens
        assert SCREEN_HZ / fit.frames_per_second == pytest.approx(round(SCREEN_HZ / fit.frames_per_second))
    alone, four = (fit_frames(house, cameras, lighting, BoardTracer(lanes, 1, 75_000_000, 0)) for lanes in (1, 4))
    assert four.cycles_per_pixel < alone.cycles_per_pixel / 2
    assert fits[1].cycles_per_pixel == alone.cycles_per_pixel  # no tracer of two lanes with caches is simulated


def test_lanes_that_nobody_simulates_are_refused(house):
    with pytest.raises(voxrt.SimulatorError, match="no simulated ray tracer has 3 lanes"):
        fit_beam(house, orbit(house, SCREEN, 1), voxrt.Lighting(), BoardTracer(3, 1, 75_000_000, BUFFER_LINES))


def test_an_orbit_shows_all_of_the_scene_from_everywhere(house):
    # A red world without a floor: nothing touches the border of any picture, and the scene is there.
    rom = replace(house, materials=tuple(replace(m, colour=(255, 0, 0)) for m in house.materials))
    for camera in orbit(rom, (96, 72), 16):
        hit = voxrt.render(rom, camera, size=(96, 72), engine="model").material != 0
        assert hit.any()
        assert not any(side.any() for side in (hit[0], hit[-1], hit[:, 0], hit[:, -1]))


def test_an_orbit_begins_with_a_camera_of_the_kind_for_people(house):
    (first,) = orbit(house, (96, 72), 1)
    eye = np.array(first.position) / 16
    assert first == look_at(eye, eye + first.look, size=(96, 72))


def test_an_orbit_goes_round(house):
    cameras = orbit(house, (96, 72), 8)
    places = np.array([camera.position for camera in cameras], dtype=np.float64)
    centre = places.mean(axis=0)
    distances = np.hypot(*(places - centre)[:, [0, 2]].T)
    assert np.ptp(distances) < 3  # 1/16 voxel
    assert np.ptp(places[:, 1]) <= 1
    angles = np.unwrap(np.arctan2(*(places - centre)[:, [0, 2]].T))
    np.testing.assert_allclose(np.diff(angles), 2 * np.pi / 8, atol=0.02)
