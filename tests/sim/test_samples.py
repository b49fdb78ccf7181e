"""Pictures of several samples per pixel, and backgrounds, against exact fractions."""

from __future__ import annotations

import itertools
from fractions import Fraction
from math import floor

import numpy as np
import pytest
from msgspec.structs import replace

from voxrt.octree import Rom, from_points
from voxrt.octree.camera import Camera, average_cut_out, average_samples, look_at, pixel_directions, sample_cameras
from voxrt.sim import check, render
from voxrt.voxelize import EMPTY, Material

ROM = Rom(
    "two",
    from_points([[1, 1, 1], [5, 6, 2], [5, 6, 3]], [1, 2, 2], depth=3),
    (EMPTY, Material("white", (250, 250, 250)), Material("red", (200, 10, 0), mirror=True)),
)
SIZE = (24, 18)
CAMERA = look_at((9, 11, -8), (3.6, 4.1, 2.2), size=SIZE)


def linear(value):
    """Decode sRGB, exactly below the threshold and to 50 digits above."""
    encoded = Fraction(value) / 255
    if encoded <= Fraction("0.04045"):
        return encoded / Fraction("12.92")
    return Fraction(((float(encoded) + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize("samples", [2, 4])
def test_samples_are_the_middles_of_equal_parts_of_a_pixel(samples):
    camera = Camera((7, 8, 9), (20, -30, 9000), (40, 0, -4), (2, 37, 0))
    cameras = sample_cameras(camera, SIZE, samples)
    assert len(cameras) == samples**2
    whole = pixel_directions(camera, SIZE)
    scale = cameras[0].right[0] / camera.right[0]
    parts = [Fraction(2 * i + 1 - samples, 2 * samples) for i in range(samples)]
    for number, one in enumerate(cameras):
        down, across = parts[number // samples], parts[number % samples]
        moved = np.array([float(r * across - u * down) for r, u in zip(camera.right, camera.up, strict=True)])
        # Rounded to whole registers.
        assert np.abs(pixel_directions(one, SIZE) - scale * (whole + moved)).max() <= 0.5
        assert one.position == camera.position


def test_one_sample_is_the_picture_itself():
    assert sample_cameras(CAMERA, SIZE, 1) == (CAMERA,)


def test_looks_at_the_limit_of_their_registers_still_have_samples():
    camera = Camera((0, 0, 0), (32767, -32767, 32767), (55, 0, -55), (0, 40, 0))
    for one in sample_cameras(camera, (640, 480), 4):
        assert max(map(abs, one.look)) < 1 << 15
        np.testing.assert_allclose(np.array(one.look) / 32767, [1, -1, 1], atol=2e-3)


def test_the_average_is_that_of_light():
    rng = np.random.default_rng(1)
    pictures = rng.integers(0, 256, (4, 5, 6, 3), dtype=np.uint8)
    average = average_samples(pictures)
    for place in np.ndindex(5, 6, 3):
        mean = sum(linear(int(picture[place])) for picture in pictures) / 4
        value = int(average[place])
        low = linear(value - Fraction(1, 2)) if value else Fraction(-1)
        high = linear(value + Fraction(1, 2))
        assert low - Fraction(1, 10**6) <= mean <= high + Fraction(1, 10**6)
    for value in range(256):
        same = np.full((1, 1, 3), value, np.uint8)
        np.testing.assert_array_equal(average_samples([same] * 16), same)


def test_a_cut_out_has_the_colour_of_what_hits_and_its_share():
    rng = np.random.default_rng(2)
    pictures, hits = rng.integers(0, 256, (4, 5, 6, 3), dtype=np.uint8), rng.random((4, 5, 6)) < 0.5
    cut_out = average_cut_out(pictures, hits)
    for row, column in np.ndindex(5, 6):
        seen = pictures[hits[:, row, column], row, column]
        expected = average_samples(seen[:, None, None])[0, 0] if len(seen) else np.zeros(3)
        np.testing.assert_array_equal(cut_out[row, column, :3], expected)
        assert cut_out[row, column, 3] == floor(Fraction(255 * len(seen), 4) + Fraction(1, 2))


def test_a_picture_is_the_average_of_its_samples():
    frames = [render(ROM, one, SIZE, engine="model") for one in sample_cameras(CAMERA, SIZE, 2)]
    picture = render(ROM, CAMERA, SIZE, engine="model", samples=2)
    np.testing.assert_array_equal(picture.colour, average_samples([frame.colour for frame in frames]))
    np.testing.assert_array_equal(picture.material, frames[0].material)
    assert picture.cost.rays == 4 * SIZE[0] * SIZE[1]
    plain = render(ROM, CAMERA, SIZE, engine="model").colour
    assert len(np.unique(picture.colour.reshape(-1, 3), axis=0)) > len(np.unique(plain.reshape(-1, 3), axis=0))


def test_backgrounds():
    plain = render(ROM, CAMERA, SIZE, engine="model")
    miss = plain.material == 0
    assert 0 < miss.mean() < 1
    blue = render(ROM, CAMERA, SIZE, engine="model", background=(1, 2, 250))
    np.testing.assert_array_equal(np.unique(blue.colour[miss], axis=0), [[1, 2, 250]])
    np.testing.assert_array_equal(blue.colour[~miss], plain.colour[~miss])
    clear = render(ROM, CAMERA, SIZE, engine="model", background="transparent")
    np.testing.assert_array_equal(clear.colour[..., 3], np.where(miss, 0, 255))
    np.testing.assert_array_equal(clear.colour[~miss][:, :3], plain.colour[~miss])


@pytest.mark.parametrize(
    ("wrong", "message"),
    [({"samples": 3}, "samples must be 1, 2, 4, not 3"), ({"background": (0, 0, 256)}, "background")],
)
def test_what_is_out_of_range_is_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        render(ROM, CAMERA, SIZE, engine="model", **wrong)


def test_engines_are_compared_before_samples_are_averaged(monkeypatch):
    pytest.importorskip("voxrt.sim._rtl", reason="this build has no verilated ray tracer")
    from voxrt.sim import rendering

    assert check(ROM, CAMERA, SIZE, samples=2, background="transparent").wrong_pixels == 0
    inner, count = rendering.render_hardware, itertools.count(1)

    def one_off(*arguments, **options):
        frame = inner(*arguments, **options)
        if next(count) == 3:  # 1 of 255 in one of four samples does not show in the average
            colour = frame.colour.copy()
            colour[4, 5, 2] ^= 1
            return replace(frame, colour=colour)
        return frame

    monkeypatch.setattr(rendering, "render_hardware", one_off)
    found = check(ROM, CAMERA, SIZE, samples=2)
    assert np.argwhere(found.wrong).tolist() == [[4, 5]]
