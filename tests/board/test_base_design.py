"""Block RAMs of a placed design: where memories are, and what a scene puts there."""

from __future__ import annotations

import numpy as np
import pytest

from voxrt.board.designs.base_design import Slice, base_contents, find_slices, patch_config

MEMORIES = {"octree": (32768, 13), "table": (4096, 32), "small": (512, 32)}


def config_of(contents):
    """A ``.config`` as nextpnr writes it, with the slices that yosys makes of these memories; an independent writer.

    16384 x 1 for the octree, 4096 x 4 for the table, 512 x 36 for the small one.
    """
    octree = [
        section(
            (word >> 4, 9 * (word >> 3 & 1) + (word & 7), contents["octree"][start + word] >> bit)
            for word in range(16384)
        )
        for start in (0, 16384)
        for bit in range(13)
    ]
    table = [
        section(
            (word >> 2, 9 * (word >> 1 & 1) + 4 * (word & 1) + i, contents["table"][word] >> (bit + i))
            for word in range(4096)
            for i in range(4)
        )
        for bit in range(0, 32, 4)
    ]
    small = section(
        (2 * word + i // 18, i % 18, contents["small"][word] >> i) for word in range(512) for i in range(32)
    )
    sections = [f".bram_init {number}\n{text}" for number, text in enumerate([*octree, *table, small], 3)]
    return ".device LFE5U-85F\n\n" + "\n".join(sections) + "\n.tile R1C1:PLC2\narc: A B\n"


def section(bits):
    """Give a section's lines of bits: of each its row, its place there, and a number whose lowest bit it is."""
    rows = np.zeros(1024, dtype=int)
    for row, place, number in bits:
        rows[row] |= (int(number) & 1) << place
    values = [f"{half:03x}" for row in rows.tolist() for half in (row & 0x1FF, row >> 9)]
    return "".join(" ".join(values[start : start + 8]) + "\n" for start in range(0, 2048, 8))


@pytest.fixture(scope="module")
def base():
    return config_of({name: base_contents(name, *size) for name, size in MEMORIES.items()})


def test_slices_are_found_by_what_they_hold(base):
    found = find_slices(base, MEMORIES)
    assert [(s.row, s.bit) for s in found["octree"]] == [(row, bit) for row in (0, 16384) for bit in range(13)]
    assert found["table"] == [Slice(29 + i, 0, 4096, 4 * i, 4) for i in range(8)]
    assert found["small"] == [Slice(37, 0, 512, 0, 36)]


def test_a_patched_config_is_the_one_that_holds_the_contents(base):
    random = np.random.default_rng(3)
    contents = {name: random.integers(0, 1 << bits, rows, dtype=np.uint32) for name, (rows, bits) in MEMORIES.items()}
    assert patch_config(base, find_slices(base, MEMORIES), contents) == config_of(contents)


def test_a_memory_that_is_not_in_the_design_is_named():
    empty = config_of({name: np.zeros(rows, dtype=np.uint32) for name, (rows, _) in MEMORIES.items()})
    with pytest.raises(ValueError, match="memory octree: a part of it is in no block RAM"):
        find_slices(empty, MEMORIES)
