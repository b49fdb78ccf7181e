"""Picture similarity against sums written out."""

import math

import numpy as np
import pytest

from voxrt.sim.similarity import peak_signal_to_noise, structural_similarity


def pictures(seed, shape=(14, 13, 3)):
    rng = np.random.default_rng(seed)
    picture = rng.integers(0, 256, shape, dtype=np.uint8)
    other = np.clip(picture + rng.integers(-60, 61, shape), 0, 255).astype(np.uint8)
    return picture, other


def written_out(picture, other):
    height, width, _ = picture.shape
    luma = [
        [[0.299 * r + 0.587 * g + 0.114 * b for r, g, b in row] for row in image.tolist()] for image in (picture, other)
    ]
    weight = {o: math.exp(-o * o / (2 * 1.5**2)) for o in range(-5, 6)}
    norm = sum(weight.values())

    def mirrored(i, n):
        return -1 - i if i < 0 else 2 * n - 1 - i if i >= n else i

    total = 0.0
    for row in range(height):
        for column in range(width):
            sums = [0.0] * 5
            for dy, wy in weight.items():
                for dx, wx in weight.items():
                    w = wy * wx / norm**2
                    x, y = (image[mirrored(row + dy, height)][mirrored(column + dx, width)] for image in luma)
                    for i, value in enumerate((x, y, x * x, y * y, x * y)):
                        sums[i] += w * value
            mx, my, xx, yy, xy = sums
            c1, c2 = 6.5025, 58.5225
            total += (
                (2 * mx * my + c1)
                * (2 * (xy - mx * my) + c2)
                / ((mx * mx + my * my + c1) * (xx - mx * mx + yy - my * my + c2))
            )
    return total / (height * width)


@pytest.mark.parametrize("seed", range(3))
def test_structural_similarity_is_its_definition(seed):
    picture, other = pictures(seed)
    assert structural_similarity(picture, other) == pytest.approx(written_out(picture, other), abs=1e-12)


def test_equal_pictures_are_equal():
    picture, _ = pictures(9)
    assert structural_similarity(picture, picture) == pytest.approx(1, abs=1e-12)
    assert peak_signal_to_noise(picture, picture) == math.inf


def test_noise_is_counted_in_decibel():
    picture = np.full((20, 20, 3), 100, np.uint8)
    assert peak_signal_to_noise(picture, picture + 10) == pytest.approx(20 * math.log10(25.5))
