"""Cores whose parameters, together, have every allowed pair of values: faults of a pair that no configuration has.

The rows are made by a greedy search, the same ones each time: of some random rows that hold the first pair still
missing, the one with most missing pairs is taken. tests/rtl/test_pairs.py counts the pairs.
"""

from __future__ import annotations

import itertools
import random
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

# Bits of a position beyond the levels: 5 are the fewest that hold the world.
VALUES: dict[str, tuple[int, ...]] = {
    "Lanes": (1, 2, 3, 5, 8),
    "MaxDepth": (2, 5, 8, 13),
    "PositionMargin": (5, 6, 9, 19),
    "BlockBits": (5, 8, 12),
    "MemoryForm": (0, 1, 2),
    "L1SetBits": (1, 3),
    "L2SetBits": (1, 3),
    "Light": (0, 1),
    "Mirrors": (0, 1),
    "Lod": (0, 1),
    "RayClocks": (1, 4, 8),
    "Narrow": (0, 1),  # multipliers of 18 x 18 bits, which is no parameter
}
CACHED = 2
CANDIDATES = 60  # rows that are compared
Pair = tuple[tuple[str, int], tuple[str, int]]


def is_allowed(row: Mapping[str, int]) -> bool:
    """Tell whether voxrt_core takes these values; those that are missing may be anything."""
    features = [row.get(name, 0) for name in ("Light", "Mirrors", "Lod")]
    if row.get("Lod", 0) and (row.get("Light", 0) or row.get("Mirrors", 0)):
        return False
    if row.get("RayClocks", 1) > 1 and any(features):
        return False
    # Caches have sizes where there are caches.
    sizes = row.get("L1SetBits", 1) == row.get("L2SetBits", 1) == 1
    return sizes or row.get("MemoryForm", CACHED) == CACHED


def pairs_of(row: Mapping[str, int]) -> set[Pair]:
    """Give the pairs of values of a row."""
    return set(itertools.combinations(row.items(), 2))


def allowed_pairs() -> list[Pair]:
    """Give all pairs of values of two parameters that a core may have."""
    return [
        ((first, one), (second, other))
        for first, second in itertools.combinations(VALUES, 2)
        for one in VALUES[first]
        for other in VALUES[second]
        if is_allowed({first: one, second: other})
    ]


def covering_rows() -> list[dict[str, int]]:
    """Give rows that hold every allowed pair."""
    chance, missing, rows = random.Random(1), dict.fromkeys(allowed_pairs()), []
    while missing:
        wanted = next(iter(missing))
        candidates = itertools.islice(_random_rows(chance, dict(wanted)), CANDIDATES)
        row = max(candidates, key=lambda each: len(pairs_of(each) & missing.keys()))
        rows.append(row)
        for pair in pairs_of(row):
            missing.pop(pair, None)
    return rows


def _random_rows(chance: random.Random, fixed: Mapping[str, int]) -> Iterator[dict[str, int]]:
    while True:
        row = {name: fixed.get(name, chance.choice(values)) for name, values in VALUES.items()}
        if is_allowed(row):
            yield row


def parameters_of(row: Mapping[str, int]) -> dict[str, int]:
    """Give the parameters of voxrt_core that a row means."""
    kept = {name: value for name, value in row.items() if name not in {"PositionMargin", "Narrow"}}
    return kept | {"PositionBits": row["MaxDepth"] + row["PositionMargin"]}
