"""The rows of parameters that the benches build hold every pair of values that a core may have."""

from __future__ import annotations

import itertools
import sys
from pathlib import Path

import pytest

RTL = Path(__file__).resolve().parents[2] / "rtl"
sys.path.append(str(RTL / "benches"))
pairs = pytest.importorskip("pairs", reason="the RTL is not beside the tests")


def test_every_allowed_pair_is_in_a_row():
    rows = pairs.covering_rows()
    assert all(pairs.is_allowed(row) for row in rows)
    names = list(pairs.VALUES)
    for first, second in itertools.combinations(names, 2):
        seen = {(row[first], row[second]) for row in rows}
        wanted = set(itertools.product(pairs.VALUES[first], pairs.VALUES[second]))
        # What is in no row cannot be in any: no completion of the pair is allowed.
        for one, other in wanted - seen:
            fixed = {first: one, second: other}
            others = [name for name in ("MemoryForm", "Light", "Mirrors", "Lod", "RayClocks") if name not in fixed]
            sizes = [name for name in ("L1SetBits", "L2SetBits") if name not in fixed]
            completions = itertools.product(*(pairs.VALUES[name] for name in [*others, *sizes]))
            assert not any(
                pairs.is_allowed(fixed | dict(zip([*others, *sizes], values, strict=True))) for values in completions
            ), fixed


def test_the_rows_are_few_and_the_same_each_time():
    rows = pairs.covering_rows()
    assert rows == pairs.covering_rows()
    assert len(rows) <= 30


def test_a_pair_that_was_wrong_once_is_there():
    """Positions with the fewest bits: 676 of 86,400 pixels were wrong; five lanes with shared multipliers hung."""
    rows = pairs.covering_rows()
    assert {row["MaxDepth"] for row in rows if row["PositionMargin"] == 5} == set(pairs.VALUES["MaxDepth"])
    assert any(row["Lanes"] >= 5 and row["RayClocks"] == 4 for row in rows)
