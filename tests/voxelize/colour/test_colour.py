"""The sRGB curve against decimal arithmetic of 60 digits."""

from decimal import Decimal, getcontext

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8, linear_from_srgb, srgb_from_linear

getcontext().prec = 60


def exact_decode(value):
    encoded = Decimal(value) / 255
    if encoded <= Decimal("0.04045"):
        return encoded / Decimal("12.92")
    return ((encoded + Decimal("0.055")) / Decimal("1.055")) ** Decimal("2.4")


def exact_encode(light):
    light = min(max(Decimal(light), Decimal(0)), Decimal(1))
    if light <= Decimal("0.0031308"):
        encoded = light * Decimal("12.92")
    else:
        encoded = Decimal("1.055") * light ** (1 / Decimal("2.4")) - Decimal("0.055")
    return int((encoded * 255 + Decimal("0.5")) // 1)


def test_decoding_is_the_exact_curve():
    np.testing.assert_allclose(LINEAR_OF_SRGB8, [float(exact_decode(v)) for v in range(256)], rtol=2e-15, atol=0)


def test_encoding_inverts_decoding():
    every = np.arange(256, dtype=np.uint8)
    np.testing.assert_array_equal(srgb_from_linear(linear_from_srgb(every)), every)


@given(st.floats(-0.5, 1.5))
def test_encoding_is_the_exact_curve(light):
    assert int(srgb_from_linear(light)) == exact_encode(light)


def test_well_known_values():
    assert srgb_from_linear([0.5, 0.214, 0.0, 1.0, 2.0, -1.0]).tolist() == [188, 127, 0, 255, 255, 0]
