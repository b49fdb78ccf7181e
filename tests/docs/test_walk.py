"""The quadtree of the class chapter against voxrt's own rays, and against a walk over unit cells with fractions."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt import octree, sim

CHAPTER = Path(__file__).resolve().parents[2] / "docs" / "how-a-ray-walks.md"

worlds = st.lists(st.text("....12", min_size=8, max_size=8), min_size=8, max_size=8)
positions = st.tuples(st.integers(-80, 140), st.integers(-80, 140))
directions = st.tuples(st.integers(1, 12), st.integers(1, 12))


def leaves_of(readings):
    return [(reading.corner, reading.level, reading.word & 0xFF) for reading in readings if reading.word >> 31]


@given(worlds, positions, directions)
def test_the_quadtree_walks_as_voxrt_does(rows, origin, direction):
    import quadtree

    flat = np.array([[int(cell) if cell.isdigit() else 0 for cell in row] for row in reversed(rows)], np.uint8)
    tree = octree.from_dense(np.repeat(flat.T[:, :, None], 8, axis=2))  # the same in every layer of z
    solid = sim.follow_ray(tree, (*origin, 8), (*direction, 0))
    expected = [
        (reading.corner[:2], reading.level, reading.word & 0xFF) for reading in solid.readings if reading.is_leaf
    ]
    if tree.depth == 3:  # an empty or full world is one word, which neither reads
        found = quadtree.follow(quadtree.build(rows), 3, origin, direction)
        assert leaves_of(found) == expected


@given(worlds, positions, directions)
def test_the_quadtree_hits_what_fractions_say(rows, origin, direction):
    import quadtree

    cells = list(reversed(rows))
    crossings = sorted(
        (Fraction(16 * line - origin[axis], direction[axis]), axis) for axis in (0, 1) for line in range(-20, 30)
    )
    here = [origin[0] // 16, origin[1] // 16]
    hit = 0
    for time, axis in [(Fraction(-1), None), *crossings]:
        if axis is not None:
            if time <= 0:
                continue
            here[axis] += 1
        if all(0 <= place < 8 for place in here) and cells[here[1]][here[0]].isdigit():
            hit = int(cells[here[1]][here[0]])
            break
    words = quadtree.build(rows)
    readings = quadtree.follow(words, 3, origin, direction)
    if len(words) > 1:
        assert (readings[-1].word & 0xFF if readings else 0) == hit


def test_directions_that_must_be_mirrored_are_refused():
    import quadtree

    with pytest.raises(ValueError, match=r"the direction \(0, 3\) must have positive components"):
        quadtree.follow([0xFFFFFF00], 3, (0, 0), (0, 3))


def test_the_chapter_says_what_the_program_finds():
    import draw
    import quadtree

    text = " ".join(CHAPTER.read_text(encoding="utf-8").split())
    assert f"The ray reads {len(draw.READINGS)} words." in text
    answer = quadtree.follow(draw.WORDS, draw.DEPTH, (16, 36), draw.DIRECTION)
    *first, last = [str(reading.address) for reading in answer]
    assert f"{', '.join(first)} and {last}. The ray hits material {answer[-1].word & 0xFF}" in text
    assert f"at T = {answer[-1].key[0]}." in text
    assert f"words, instead of {len(draw.WORDS)}." in text
    blocks = {tuple(draw.WORDS[start : start + 4]): start for start in range(1, len(draw.WORDS), 4)}
    assert len(blocks) == (len(draw.WORDS) - 1) // 4 - 1  # two are equal
    assert draw.WORDS[21:25] == draw.WORDS[25:29]
    assert re.search(r"The blocks 21 and 25\. Four words\.", text)


def test_rounding_misses_what_the_exact_ray_hits():
    import draw

    exact = draw.quadtree.follow(draw.WORDS, draw.DEPTH, draw.ROUNDED_ORIGIN, draw.DIRECTION)
    x, y = map(int, draw.follow_rounded(4)[-1])
    assert exact[-1].word & 0xFF == 1
    assert draw.WORLD[draw.SIDE - 1 - y][x] == "2"
