"""Appearance against a texture look-up written out pixel by pixel."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voxrt.voxelize import _native
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance, sample
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.colour.texture import Texture

WRAPS = ("repeat", "mirror", "clamp")


def surface_appearance(uv=None, colours=None, **appearance):
    uv = np.zeros((1, 3, 2)) if uv is None else np.array(uv, float)
    colours = np.ones((len(uv), 3, 4)) if colours is None else np.array(colours)
    return SurfaceAppearance(
        (Appearance("p", **appearance),), np.zeros(len(uv), np.int32), uv, colours.astype(np.float32)
    )


def pixel(texture, column, row):
    """A pixel of an image that goes on for ever."""
    found = []
    for at, size, wrap in ((row, texture.pixels.shape[0], 1), (column, texture.pixels.shape[1], 0)):
        if texture.wrap[wrap] == "repeat":
            found.append(at % size)
        elif texture.wrap[wrap] == "clamp":
            found.append(min(max(at, 0), size - 1))
        else:
            turn, rest = divmod(at, size)
            found.append(rest if turn % 2 == 0 else size - 1 - rest)
    red, green, blue, alpha = texture.pixels[found[0], found[1]].tolist()
    return np.array([*LINEAR_OF_SRGB8[[red, green, blue]], alpha / 255])


def looked_up(texture, u, v):
    height, width = texture.pixels.shape[:2]
    x, y = u * width, v * height
    if texture.nearest:
        return pixel(texture, math.floor(x), math.floor(y))
    left, top = math.floor(x - 0.5), math.floor(y - 0.5)
    total = np.zeros(4)
    for row, down in ((top, 1 - (y - 0.5 - top)), (top + 1, y - 0.5 - top)):
        for column, across in ((left, 1 - (x - 0.5 - left)), (left + 1, x - 0.5 - left)):
            total += down * across * pixel(texture, column, row)
    return total


@settings(max_examples=200, deadline=None)
@given(
    pixels=st.integers(1, 3).flatmap(
        lambda h: st.integers(1, 3).flatmap(
            lambda w: st.lists(st.integers(0, 255), min_size=h * w * 4, max_size=h * w * 4).map(
                lambda flat: np.array(flat, np.uint8).reshape(h, w, 4)
            )
        )
    ),
    wrap=st.tuples(st.sampled_from(WRAPS), st.sampled_from(WRAPS)),
    nearest=st.booleans(),
    # Eighths: no look-up falls a rounding error beside the edge of a pixel.
    place=st.tuples(st.integers(-40, 40), st.integers(-40, 40)).map(lambda p: ((p[0] + 0.5) / 8, (p[1] + 0.5) / 8)),
)
def test_texture_look_up(pixels, wrap, nearest, place):
    texture = Texture(pixels, wrap, nearest)
    painted = surface_appearance(uv=[[place, place, place]], texture=texture, factor=(0.5, 0.25, 1.0, 0.75))
    found = sample(painted, np.array([0]), np.array([[0.2, 0.3, 0.5]]))
    expected = looked_up(texture, *place) * (0.5, 0.25, 1.0, 0.75)
    np.testing.assert_allclose(found[0], expected, rtol=1e-9, atol=1e-12)


def test_far_coordinates_stay_exact():
    texture = Texture(np.array([[[255, 0, 0, 255], [0, 255, 0, 255]]], np.uint8), nearest=True)
    painted = surface_appearance(uv=[[(2.0**40 + 0.75, 2.0**60)] * 3], texture=texture)
    assert sample(painted, np.array([0]), np.array([[1.0, 0, 0]]))[0].tolist() == [0, 1, 0, 1]


@pytest.mark.parametrize("wrap", WRAPS)
@pytest.mark.parametrize("nearest", [True, False])
@pytest.mark.parametrize("beyond", [np.nan, np.inf, -np.inf, 1.7e308, -1.7e308])
def test_coordinates_beyond_numbers_have_some_colour(wrap, nearest, beyond):
    texture = Texture(np.full((3, 5, 4), 255, np.uint8), (wrap, wrap), nearest)
    painted = surface_appearance(uv=[[(beyond, 0), (0, beyond), (beyond, beyond)]], texture=texture)
    assert sample(painted, np.array([0]), np.full((1, 3), 1 / 3))[0].tolist() == [1, 1, 1, 1]


def encoded(linear):
    """The nearest of 256 codes."""
    return int(np.abs(LINEAR_OF_SRGB8 - linear).argmin())


@settings(max_examples=100, deadline=None)
@given(st.integers(1, 5), st.integers(1, 5), st.integers(0, 2**32), st.booleans())
def test_halving_takes_means_in_linear_light_weighed_by_alpha(height, width, seed, opaque):
    pixels = np.random.default_rng(seed).integers(0, 256, (height, width, 4), np.uint8)
    if opaque:
        pixels[:, :, 3] = 255
    found = _native.halved_image(pixels)
    assert found.shape == ((height + 1) // 2, (width + 1) // 2, 4)
    for row, column in np.ndindex(found.shape[:2]):
        four = [pixels[min(2 * row + i, height - 1), min(2 * column + j, width - 1)] for i in (0, 1) for j in (0, 1)]
        weights = [int(one[3]) for one in four]
        weights = weights if sum(weights) else [1] * 4
        for channel in range(3):
            mean = sum(w * LINEAR_OF_SRGB8[one[channel]] for w, one in zip(weights, four, strict=True)) / sum(weights)
            assert abs(int(found[row, column, channel]) - encoded(mean)) <= 1
        assert abs(int(found[row, column, 3]) - sum(int(one[3]) for one in four) / 4) <= 0.5


def test_black_and_white_halve_to_the_grey_of_half_the_light():
    pixels = np.zeros((8, 8, 4), np.uint8)
    pixels[::2, ::2, :3] = pixels[1::2, 1::2, :3] = 255
    pixels[:, :, 3] = 255
    assert (_native.halved_image(pixels) == [188, 188, 188, 255]).all()


def test_triangles_remain_of_which_any_is_not_cut_away():
    leaf = np.zeros((4, 4, 4), np.uint8)
    leaf[:, :2] = (0, 255, 0, 255)
    leaf[:, 2:] = (255, 0, 0, 0)
    left, whole, right = [(0.05, 0), (0.2, 0), (0.2, 1)], [(0, 0), (1, 0), (1, 1)], [(0.7, 0), (0.9, 0), (0.9, 1)]
    painted = surface_appearance(uv=[left, whole, right, right], texture=Texture(leaf, nearest=True), cutoff=0.5)
    painted = SurfaceAppearance(painted.entries, np.array([0, 0, 0, -1], np.int32), painted.uv, painted.colours)
    assert _native.visible_triangles(painted.arrays()).tolist() == [True, True, False, False]


@pytest.mark.parametrize("count", [1, 40_000])
def test_the_number_of_samples_is_bounded(count):
    texture = Texture(np.full((1000, 1000, 4), 127, np.uint8))
    uv = np.tile([[(0, 0), (1, 0), (1, 1)]], (count, 1, 1))
    painted = surface_appearance(uv=uv, texture=texture, cutoff=0.5)
    assert not _native.visible_triangles(painted.arrays()).any()
