import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from voxrt.voxelize._native import quantize
from voxrt.voxelize.colour.srgb import linear_from_srgb, srgb_from_linear


@given(st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=1, max_size=30), st.integers(30, 255))
def test_few_colours_keep_their_own(colours, count):
    palette, rows = quantize(np.array(colours, np.uint8), np.ones(len(colours)), count)
    np.testing.assert_array_equal(palette[rows], colours)
    assert [tuple(entry) for entry in palette.tolist()] == sorted(set(colours))


@given(st.integers(0, 2**32), st.integers(1, 16))
def test_many_colours_become_few_deterministically(seed, count):
    random = np.random.default_rng(seed)
    colours, weights = random.integers(0, 256, (200, 3), np.uint8), random.random(200)
    palette, rows = quantize(colours, weights, count)
    again, same = quantize(colours, weights, count)
    np.testing.assert_array_equal(palette, again)
    np.testing.assert_array_equal(rows, same)
    assert 1 <= len(palette) <= count
    assert set(rows.tolist()) == set(range(len(palette)))


def test_clusters_are_found_and_stand_for_their_mean():
    random = np.random.default_rng(7)
    centres = np.array([[0.1, 0.1, 0.1], [0.8, 0.1, 0.1], [0.1, 0.1, 0.8]])
    member = np.repeat([0, 1, 2], 100)
    colours = centres[member] + random.uniform(-0.02, 0.02, (300, 3))
    palette, rows = quantize(srgb_from_linear(colours), np.ones(300), 3)
    np.testing.assert_allclose(linear_from_srgb(palette)[rows], centres[member], atol=0.01)


def test_weights_decide_which_colours_are_kept():
    colours = np.concatenate([np.tile([[0.5, 0, 0]], (100, 1)), np.random.default_rng(3).random((100, 3))])
    weights = np.where(np.arange(200) < 100, 1000.0, 1e-3)
    palette, rows = quantize(srgb_from_linear(colours), weights, 4)
    np.testing.assert_allclose(linear_from_srgb(palette)[rows[0]], [0.5, 0, 0], atol=0.005)


def test_colours_that_cover_nothing_are_still_given_one():
    palette, rows = quantize(np.random.default_rng(5).integers(0, 256, (50, 3), np.uint8), np.zeros(50), 4)
    assert rows.max() < len(palette) <= 4


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32), st.integers(2, 64), st.sampled_from([300, 9000]))
def test_entries_are_about_as_near_as_those_of_a_grid(seed, count, number):
    # A grid of cells as long as `cell` leaves colours cell / 2 from their entries, in the mean of squares. Ours are
    # means in linear light, a little beside those of sRGB.
    random = np.random.default_rng(seed)
    colours = random.integers(0, 256, (number, 3), np.uint8)
    palette, rows = quantize(colours, np.ones(number), count)
    distance = np.linalg.norm(palette[rows].astype(float) - colours, axis=1)
    cell = 256 / np.floor(np.cbrt(count) + 1e-9)
    assert np.sqrt((distance**2).mean()) <= 1.25 * cell / 2
    assert distance.max() <= 2 * np.sqrt(3) * cell
