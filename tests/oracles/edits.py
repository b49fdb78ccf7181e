"""Edits of a dense array, the slow and obvious way: nothing here is shared with the product."""

import numpy as np


def shape_mask(side, shape):
    """Which voxels of a cube are of a shape: bool, indexed [x, y, z]. Its numbers are multiples of 1/16."""
    grid = np.indices((side,) * 3, np.int64)
    if hasattr(shape, "low"):
        return np.all([(grid[a] >= shape.low[a]) & (grid[a] < shape.high[a]) for a in range(3)], axis=0)
    centres, radius = 16 * grid + 8, round(16 * shape.radius)
    if hasattr(shape, "centre"):
        return sum((centres[a] - round(16 * shape.centre[a])) ** 2 for a in range(3)) <= radius**2
    start, end = ([round(16 * c) for c in point] for point in (shape.start, shape.end))
    axle = [b - a for a, b in zip(start, end, strict=True)]
    length = sum(a * a for a in axle)
    way = [centres[a] - start[a] for a in range(3)]
    along = sum(way[a] * axle[a] for a in range(3))
    from_start = sum(w * w for w in way)
    from_end = sum((centres[a] - end[a]) ** 2 for a in range(3))
    beside = (from_start - radius**2) * length <= along**2
    return np.where(along <= 0, from_start <= radius**2, np.where(along >= length, from_end <= radius**2, beside))


def paste(cube, piece, at, turned):
    """A cube with the solid voxels of a dense piece at a place; what lies outside is left out."""
    for _ in range(turned):  # z goes to x, and x against z
        piece = piece[::-1].transpose(2, 1, 0)
    result = cube.copy()
    low = np.maximum(at, 0)
    high = np.minimum(np.add(at, piece.shape), len(cube))
    if (low < high).all():
        target = tuple(map(slice, low, high))
        part = piece[tuple(map(slice, low - at, high - at))]
        result[target] = np.where(part != 0, part, result[target])
    return result


def box(cube, low, high):
    """The voxels of a box, empty outside of the cube."""
    found = np.zeros(np.subtract(high, low), np.uint8)
    inside = [np.maximum(low, 0), np.minimum(high, len(cube))]
    if (inside[0] < inside[1]).all():
        found[tuple(map(slice, inside[0] - low, inside[1] - low))] = cube[tuple(map(slice, *inside))]
    return found
