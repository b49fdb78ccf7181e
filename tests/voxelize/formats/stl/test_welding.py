"""Welding against a dictionary."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from voxrt.voxelize.formats.stl import load as module
from voxrt.voxelize.formats.stl.load import weld

soups = st.integers(0, 6).flatmap(
    lambda count: arrays(np.float64, (3 * count, 3), elements=st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-300, 0.1]))
)


def by_dictionary(corners):
    rows = {}
    triangles = [rows.setdefault(tuple(corner), len(rows)) for corner in (corners + 0.0).tolist()]
    return np.array(list(rows), dtype=float).reshape(-1, 3), np.array(triangles, dtype=int).reshape(-1, 3)


@given(soups)
def test_one_vertex_a_place_in_order_of_appearance(corners):
    positions, triangles = weld(corners)
    expected, rows = by_dictionary(corners)
    assert np.array_equal(positions, expected)
    assert np.array_equal(triangles, rows)


def test_places_that_share_a_hash_stay_apart(monkeypatch):
    monkeypatch.setattr(module, "_hashes", lambda exact: np.zeros(len(exact), dtype=np.uint64))
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0]])
    positions, triangles = weld(corners)
    assert positions.tolist() == [[0, 0, 0], [1, 0, 0]]
    assert triangles.tolist() == [[0, 1, 0]]
