"""Paint against a texture look-up written out pixel by pixel, and against means known in closed form."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voxrt.voxelize.colour import LINEAR_OF_SRGB8
from voxrt.voxelize.paint import Coat, Paint, Texture, mean_colours, sample

WRAPS = ("repeat", "mirror", "clamp")


def coat(uv=None, colours=None, **paint):
    uv = np.zeros((1, 3, 2)) if uv is None else np.array(uv, float)
    colours = np.ones((len(uv), 3, 4)) if colours is None else np.array(colours)
    return Coat((Paint("p", **paint),), np.zeros(len(uv), np.int32), uv, colours.astype(np.float32))


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
    painted = coat(uv=[[place, place, place]], texture=texture, factor=(0.5, 0.25, 1.0, 0.75))
    found = sample(painted, np.array([0]), np.array([[0.2, 0.3, 0.5]]))
    expected = looked_up(texture, *place) * (0.5, 0.25, 1.0, 0.75)
    np.testing.assert_allclose(found[0], expected, rtol=1e-9, atol=1e-12)


def test_far_coordinates_stay_exact():
    texture = Texture(np.array([[[255, 0, 0, 255], [0, 255, 0, 255]]], np.uint8), nearest=True)
    painted = coat(uv=[[(2.0**40 + 0.75, 2.0**60)] * 3], texture=texture)
    assert sample(painted, np.array([0]), np.array([[1.0, 0, 0]]))[0].tolist() == [0, 1, 0, 1]


@given(
    st.lists(st.integers(0, 4).map(lambda n: n / 4), min_size=12, max_size=12),
    st.lists(st.integers(0, 4).map(lambda n: n / 4), min_size=4, max_size=4),
)
def test_the_mean_of_vertex_colours_is_the_mean_of_the_corners(flat, factor):
    corners = np.array(flat).reshape(1, 3, 4)
    means, solid = mean_colours(coat(colours=corners, factor=tuple(factor)))
    np.testing.assert_allclose(means[0], corners[0, :, :3].mean(axis=0) * factor[:3], atol=1e-7)
    assert solid.all()


def test_the_mean_of_a_texture_is_that_of_its_pixels_in_linear_light():
    black_and_white = np.zeros((8, 8, 4), np.uint8)
    black_and_white[::2, ::2, :3] = black_and_white[1::2, 1::2, :3] = 255
    black_and_white[:, :, 3] = 255
    square = [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]]
    means, _ = mean_colours(coat(uv=square, texture=Texture(black_and_white)))
    np.testing.assert_allclose(means, 0.5, atol=0.01)


def test_what_is_cut_away_has_no_colour_and_does_not_tint_the_rest():
    leaf = np.zeros((4, 4, 4), np.uint8)
    leaf[:, :2] = (0, 255, 0, 255)
    leaf[:, 2:] = (255, 0, 0, 0)
    left, whole, right = [(0.05, 0), (0.2, 0), (0.2, 1)], [(0, 0), (1, 0), (1, 1)], [(0.7, 0), (0.9, 0), (0.9, 1)]
    painted = coat(uv=[left, whole, right], texture=Texture(leaf, nearest=True), cutoff=0.5)
    means, solid = mean_colours(painted)
    assert solid.tolist() == [True, True, False]
    assert means.tolist() == [[0, 1, 0], [0, 1, 0], [0, 0, 0]]


def test_triangles_without_paint_have_no_mean():
    painted = coat(uv=np.zeros((2, 3, 2)))
    mixed = Coat(painted.paints, np.array([-1, 0], np.int32), painted.uv, painted.colours)
    means, solid = mean_colours(mixed)
    assert (means.tolist(), solid.tolist()) == ([[0, 0, 0], [1, 1, 1]], [False, True])


@pytest.mark.parametrize("count", [1, 40_000])
def test_the_number_of_samples_is_bounded(count):
    texture = Texture(np.full((1000, 1000, 4), 255, np.uint8))
    uv = np.tile([[(0, 0), (1, 0), (1, 1)]], (count, 1, 1))
    means, solid = mean_colours(coat(uv=uv, texture=texture))
    np.testing.assert_allclose(means, 1.0)
    assert solid.all()
