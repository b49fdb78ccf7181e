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
    sections, number = [], 2

    def put(bits):
        # bits: row and place in the row of 18 bits
        nonlocal number
        number += 1
        text = ""
        for line in range(256):
            values = []
            for row in range(4 * line, 4 * line + 4):
                word = int(sum(1 << place for place in np.flatnonzero(bits[row])))
                values += [f"{word & 0x1FF:03x}", f"{word >> 9:03x}"]
            text += " ".join(values) + "\n"
        sections.append(f".bram_init {number}\n{text}")

    for start in (0, 16384):
        for bit in range(13):
            bits = np.zeros((1024, 18), dtype=bool)
            for word in range(16384):
                bits[word >> 4, 9 * (word >> 3 & 1) + (word & 7)] = contents["octree"][start + word] >> bit & 1
            put(bits)
    for bit in range(0, 32, 4):
        bits = np.zeros((1024, 18), dtype=bool)
        for word in range(4096):
            for i in range(4):
                bits[word >> 2, 9 * (word >> 1 & 1) + 4 * (word & 1) + i] = contents["table"][word] >> (bit + i) & 1
        put(bits)
    bits = np.zeros((1024, 18), dtype=bool)
    for word in range(512):
        for i in range(32):
            bits[2 * word + i // 18, i % 18] = contents["small"][word] >> i & 1
    put(bits)
    return ".device LFE5U-85F\n\n" + "\n".join(sections) + "\n.tile R1C1:PLC2\narc: A B\n"


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
