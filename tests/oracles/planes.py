"""Frames are compared plane by plane."""

from __future__ import annotations

import numpy as np


def assert_planes(frame, expected, note=""):
    """A frame, by names or by attributes, has the colour, material and face that an oracle gives."""
    for plane, wanted in zip(("colour", "material", "face"), expected, strict=True):
        got = frame[plane] if isinstance(frame, dict) else getattr(frame, plane)
        np.testing.assert_array_equal(got, wanted, f"{plane} {note}")
