"""Random worlds: lumpy ones with uniform octants, repeats and several materials, of any depth up to 5."""

import numpy as np
from hypothesis import strategies as st


@st.composite
def dense_cubes(draw, max_depth=5):
    depth = draw(st.integers(1, max_depth))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    side = 1 << depth
    cube = np.zeros((side,) * 3, np.uint8)
    if draw(st.booleans()):
        cube[:] = rng.integers(0, 4)
    for _ in range(draw(st.integers(0, 6))):
        level = int(rng.integers(0, depth + 1))
        a, b = (rng.integers(0, side // (1 << level), 3) << level for _ in range(2))
        low, high = np.minimum(a, b), np.maximum(a, b) + (1 << level)
        cube[tuple(map(slice, low, high))] = rng.choice([0, 1, 2, 3, 7, 240, 255])
    if draw(st.booleans()):
        noisy = rng.random(cube.shape) < 0.02
        cube[noisy] = rng.integers(0, 256, int(noisy.sum()))
    return cube
