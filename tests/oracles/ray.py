"""The pixel as the contract states it, in rational arithmetic, walking unit voxels of the world one at a time.

Slow on purpose: no octree, no mirroring, no weights, no integers scaled to avoid a division. A ray is o + t d with t a
Fraction; the planes it crosses are sorted by (t, axis).
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor

import numpy as np

FACE_NONE = 3


def first_cell(coordinate: Fraction, direction: int) -> int:
    """Give the cell a ray starts in on one axis; on a plane it is the one ahead, or at floor where it does not move."""
    if direction < 0:
        return -floor(-coordinate) - 1  # ceil - 1
    return floor(coordinate)


def cells(side, position, direction):
    """Walk a ray through a world, from unit voxel to unit voxel.

    Parameters
    ----------
    side
        Voxels a side.
    position
        Three integers, 1/16 voxel.
    direction
        Three integers.

    Yields
    ------
    tuple
        (cell, axis, t) of each cell in the world: the axis of the plane crossed last, 3 for none, and its t (None).
    """
    origin = [Fraction(int(c), 16) for c in position]
    direction = [int(c) for c in direction]
    cell = [first_cell(o, d) for o, d in zip(origin, direction, strict=True)]
    face, t = FACE_NONE, None
    while True:
        cell = before_entry(side, origin, direction, cell)
        if all(0 <= c < side for c in cell):
            yield tuple(cell), face, t
        crossings = []
        for axis in range(3):
            ahead, behind = (cell[axis] >= side), (cell[axis] < 0)
            d = direction[axis]
            if (ahead and d >= 0) or (behind and d <= 0):
                return  # it never comes back into the world
            if d:
                plane = cell[axis] + (1 if d > 0 else 0)
                crossings.append(((plane - origin[axis]) / d, axis))
        if not crossings:
            return
        t, face = min(crossings)
        cell[face] += 1 if direction[face] > 0 else -1


def before_entry(side, origin, direction, cell):
    """Give the cell from which a ray crosses the last plane before the world; `cell` where it has crossed all of them.

    Of planes crossed at the same time, those of a lower axis are crossed first.
    """
    planes = [side if c >= side else 0 for c in cell]
    waits = [
        axis for axis in range(3) if (cell[axis] >= side and direction[axis] < 0) or (cell[axis] < 0 < direction[axis])
    ]
    if not waits:
        return cell
    t, last = max(((planes[axis] - origin[axis]) / direction[axis], axis) for axis in waits)
    found = list(cell)
    for axis, d in enumerate(direction):
        at = origin[axis] + d * t  # planes up to here are crossed; the one here only if its axis is lower
        if d > 0:
            found[axis] = max(cell[axis], floor(at) if axis < last else ceil(at) - 1)
        elif d < 0:
            found[axis] = min(cell[axis], ceil(at) - 1 if axis < last else floor(at))
    return found


def trace(voxels, position, direction):
    """Find the first solid cell on a ray through materials indexed [x, y, z], a cube in which 0 is empty.

    Returns
    -------
    tuple
        (material, face): face is the axis of the plane crossed last, 3 for none; (0, 3) for a miss.
    """
    for (x, y, z), face, _ in cells(len(voxels), position, direction):
        if voxels[x, y, z]:
            return int(voxels[x, y, z]), face
    return 0, FACE_NONE


def readings(words, depth, position, direction):
    """Tell which words are read by a ray, cell by cell: from leaf to leaf, those below the octants that hold both.

    Returns
    -------
    list
        (address, word, level, corner, axis, t) each, as :func:`cells` gives axis and t.
    """
    found, above = [], set()
    for cell, axis, t in cells(1 << depth, position, direction):
        way, word, level = {}, int(words[0]), depth
        while word < 1 << 31:
            level -= 1
            address = word + sum((c >> level & 1) << n for n, c in enumerate(cell))
            word = int(words[address])
            way[level, *(c >> level << level for c in cell)] = address
        for (size, *corner), address in way.items():
            if (size, *corner) not in above:
                found.append((address, int(words[address]), size, tuple(corner), axis, t))
        above = set(way)
        if word & 0xFF:
            break
    return found


def shade(colour, direction, face):
    """Give the colour of a hit: round half up of c (d_a / |d|)^2, as it is without a face."""
    if face == FACE_NONE:
        return tuple(int(c) for c in colour)
    d = [int(c) for c in direction]
    brightness = Fraction(d[face] ** 2, sum(c * c for c in d))
    return tuple(floor(int(c) * brightness + Fraction(1, 2)) for c in colour)


def directions(camera, width, height):
    """Give a frame's directions, int64, shape (height, width, 3); camera has rows position, look, right, up."""
    _, look, right, up = np.asarray(camera, dtype=np.int64)
    columns = np.arange(width) - width // 2
    rows = height // 2 - np.arange(height)
    return look + right * columns[None, :, None] + up * rows[:, None, None]


def render(voxels, camera, width, height, materials):
    """Render a frame: (colour, material, face), uint8, of shapes (height, width, 3), (height, width) twice."""
    rays = directions(camera, width, height)
    colour = np.zeros((height, width, 3), np.uint8)
    material = np.zeros((height, width), np.uint8)
    face = np.zeros((height, width), np.uint8)
    for (row, column), _ in np.ndenumerate(material):
        direction = rays[row, column]
        material[row, column], face[row, column] = trace(voxels, camera[0], direction)
        colour[row, column] = shade(materials[material[row, column]], direction, face[row, column])
    return colour, material, face
