"""A ray through a quadtree, in whole numbers alone: the ray tracer's algorithm in two dimensions.

The chapter "How a ray walks an octree" explains it, and ``draw.py`` draws its pictures with it. It is short because the
ray must go right and up: both components of the direction are positive. The ray tracer mirrors all other rays first.
"""

from __future__ import annotations

from dataclasses import dataclass

from voxrt.octree.words import EMPTY, is_leaf, leaf

UNIT = 16  # positions are counted in sixteenths of a cell
AXES = (0, 1)  # x, y
SPACE = 0  # the material of empty cells


@dataclass(frozen=True)
class Reading:
    """One word that the ray reads."""

    address: int  # where the word stands
    word: int
    level: int  # log2 of the side of the word's square, in cells
    corner: tuple[int, int]  # lowest cell of the square, (x, y)
    key: tuple[int, int]  # (T, axis) of the line that the ray crossed last
    stack: dict[int, int]  # block by the level of its four squares, as it is after this word was read


def crossing_time(origin: tuple[int, int], direction: tuple[int, int], axis: int, line: int) -> int:
    """Give the whole number T at which the ray crosses a grid line of an axis (x = line, or y = line)."""
    other = 1 - axis
    return (UNIT * line - origin[axis]) * direction[other]


def build(rows: list[str]) -> list[int]:
    """Build the words of a quadtree.

    `rows` is the world from its top row down, a character per cell: a digit is a material, anything else is empty. It
    has as many rows as columns, a power of two. Word 0 is the root. Blocks of four words follow, breadth first: lower
    left, lower right, upper left, upper right.
    """
    cells = [[int(cell) if cell.isdigit() else SPACE for cell in row] for row in reversed(rows)]
    words = [0]
    waiting = [(0, 0, 0, len(cells))]  # squares without a word yet: address, lowest corner, side
    for address, x, y, side in waiting:
        materials = {cells[row][column] for row in range(y, y + side) for column in range(x, x + side)}
        if len(materials) == 1:
            words[address] = leaf(materials.pop())
            continue
        block = len(words)
        words[address] = block
        words += [0] * 4
        half = side // 2
        waiting += [(block + child, x + half * (child & 1), y + half * (child >> 1), half) for child in range(4)]
    return words


def follow(words: list[int], depth: int, origin: tuple[int, int], direction: tuple[int, int]) -> list[Reading]:
    """Follow a ray until it hits a solid square or leaves the world, of 2 ** depth cells per side.

    It starts at `origin`, in sixteenths of a cell. `direction` is two positive whole numbers; ValueError where they are
    not. Returns all words that the ray reads, in order: the last is a solid leaf, unless the ray leaves the world.
    """
    if min(direction) <= 0:
        raise ValueError(f"the direction {direction} must have positive components; mirror the world first")
    side = 1 << depth

    def crossing(axis: int, line: int) -> tuple[int, int]:
        return crossing_time(origin, direction, axis, line), axis

    # Enter: lines with T <= 0 are behind the start. From outside, the last of the near sides counts.
    key = max((0, 1), *(crossing(axis, 0) for axis in AXES))
    if any(crossing(axis, side) <= key for axis in AXES):
        return []

    corner, level, address = (0, 0), depth, 0
    stack: dict[int, int] = {}
    readings = []
    while True:
        word = words[address]
        if address > 0:  # word 0 is kept from ray to ray
            readings.append(Reading(address, word, level, corner, key, dict(stack)))

        if not is_leaf(word):  # descend: compare the two middle lines with the key
            level -= 1
            stack[level] = word
            half = 1 << level
            upper = [crossing(axis, corner[axis] + half) <= key for axis in AXES]
            corner = (corner[0] + half * upper[0], corner[1] + half * upper[1])
            address = word + upper[0] + 2 * upper[1]
            continue

        if word != EMPTY:
            return readings

        # Leave: the line that comes first is the new key.
        key = min(crossing(axis, corner[axis] + (1 << level)) for axis in AXES)
        axis = key[1]
        stepped = list(corner)
        stepped[axis] += 1 << level
        if stepped[axis] == side:
            return readings

        # Go on in the smallest square with both sides of that line: the highest bit that changed.
        level = (corner[axis] ^ stepped[axis]).bit_length() - 1
        corner = (stepped[0] >> level << level, stepped[1] >> level << level)
        address = stack[level] + (corner[0] >> level & 1) + 2 * (corner[1] >> level & 1)
