"""Parts of a world joined to the whole."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt.octree import Assembly, Octree, from_dense, from_points

POINTS = st.dictionaries(st.tuples(*[st.integers(0, 15)] * 3), st.integers(1, 3), max_size=60)


def part_of(points, depth=4):
    return from_points(np.array(list(points), int).reshape(-1, 3), list(points.values()), depth)


@given(POINTS, st.integers(0, 2), st.randoms(use_true_random=False))
def test_parts_in_any_order_give_the_bytes_of_the_whole(points, cut, random):
    rule = [lambda p: p[0] // 8, lambda p: (p[0] // 4, p[1] // 4), hash][cut]
    parts = {}
    for place, material in points.items():
        parts.setdefault(rule(place), {})[place] = material
    order = list(parts.values())
    random.shuffle(order)
    whole = Assembly(4)
    for part in order:
        whole.add(part_of(part))
    assert bytes(whole.octree().words) == bytes(part_of(points).words)


def test_full_parts_become_one_leaf():
    left, right = np.zeros((2, 8, 8, 8), np.uint8)
    left[:4], right[4:] = 5, 5
    whole = Assembly(3)
    whole.add(from_dense(left))
    whole.add(from_dense(right))
    assert whole.octree().words.tolist() == [0xFFFFFF05]


def test_an_empty_world_is_a_leaf():
    assert Assembly(16).octree().words.tolist() == [0xFFFFFF00]


def test_parts_that_overlap_are_refused():
    whole = Assembly(2)
    whole.add(from_points([[1, 1, 1]], [1], 2))
    with pytest.raises(ValueError, match="overlap"):
        whole.add(from_points([[1, 1, 1]], [2], 2))


def test_parts_of_another_depth_or_without_sense_are_refused():
    whole = Assembly(2)
    with pytest.raises(ValueError, match="part has depth 3, and the whole 2"):
        whole.add(from_points([[1, 1, 1]], [1], 3))
    with pytest.raises(ValueError, match="valid octree"):
        whole.add(Octree(2, np.array([9], np.uint32)))
    with pytest.raises(ValueError, match="depth"):
        Assembly(17)
