"""What voxels enclose, in runs along z.

A voxel's key has x, y and z, 17 bits each. A run is a pair of keys of one column: its lowest and its highest voxel.
Runs are ascending, and no two of them touch.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Runs: TypeAlias = tuple[NDArray[np.int64], NDArray[np.int64]]

AXIS_BITS = 17  # one more than coordinates have: the last voxel of a column does not touch the first of the next
_COLUMN = 1 << AXIS_BITS
_LAST = _COLUMN - 1


def filled_runs(keys: NDArray[np.int64], size: int) -> Runs:
    """Return the runs that have enclosed voxels, with the solid voxels that they touch.

    Enclosed are empty voxels from which no path over faces of empty voxels leads out of a grid of `size` voxels per
    side. Holes of one or two voxels are closed first: what is enclosed by solid voxels and their neighbours, and the
    neighbours of that, count as solid. `keys` are those of the solid voxels, ascending.

    Examples
    --------
    >>> x, y, z = np.meshgrid(*3 * [np.arange(3)], indexing="ij")
    >>> cube = np.sort(((x << AXIS_BITS | y) << AXIS_BITS | z).ravel())
    >>> hollow = np.delete(cube, 13)
    >>> low, high = filled_runs(hollow, 4)
    >>> low == cube[12], high == cube[14]
    (array([ True]), array([ True]))
    """
    solid = _merged(keys, keys)
    core = _enclosed(*_dilated(*solid, size), size)
    closed = _joined(solid, _dilated(*core, size)) if len(core[0]) else solid
    low, high = _joined(closed, _enclosed(*closed, size))
    place = np.minimum(np.searchsorted(solid[0], low), len(solid[0]) - 1)
    changed = (solid[0][place] != low) | (solid[1][place] != high)
    return low[changed], high[changed]


def coordinates(keys: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the coordinates of voxels: float64, shape (N, 3)."""
    return np.stack([keys >> 2 * AXIS_BITS, keys >> AXIS_BITS & _LAST, keys & _LAST], axis=1).astype(np.float64)


def groups(ascending: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return where equal values begin, and how many they are."""
    starts = np.flatnonzero(np.diff(ascending, prepend=-1))
    return starts, np.diff(starts, append=len(ascending))


def _merged(low: NDArray[np.int64], high: NDArray[np.int64]) -> Runs:
    """Return runs as they are called here, from any that are ascending by their lowest voxels."""
    reach = np.maximum.accumulate(high)
    begins = np.flatnonzero(np.concatenate([[True], low[1:] > reach[:-1] + 1])) if len(low) else np.zeros(0, np.int64)
    ends = np.append(begins[1:], len(low)) - 1
    return low[begins], reach[ends]


def _joined(*several: Runs) -> Runs:
    low, high = (np.concatenate(keys) for keys in zip(*several, strict=True))
    order = np.argsort(low, kind="stable")
    return _merged(low[order], high[order])


def _dilated(low: NDArray[np.int64], high: NDArray[np.int64], size: int) -> Runs:
    """Return runs with the neighbours of their voxels, as far as these are in the grid."""
    longer = low - (low & _LAST > 0), high + (high & _LAST < size - 1)
    beside = []
    for axis_bits in (AXIS_BITS, 2 * AXIS_BITS):
        at = low >> axis_bits & _LAST
        for inside, step in ((at > 0, -1 << axis_bits), (at < size - 1, 1 << axis_bits)):
            beside.append((low[inside] + step, high[inside] + step))
    return _joined(longer, *beside)


def _enclosed(low: NDArray[np.int64], high: NDArray[np.int64], size: int) -> Runs:
    """Return the empty runs that solid runs enclose.

    Only runs between two solid ones of a column can be enclosed. Runs of neighbouring columns that have a z in common
    touch. What touches an empty column, the border of the grid, or what lies above or below all solid voxels of a
    column, is outside; so is what touches a run that is outside.
    """
    starts, counts = groups(low >> AXIS_BITS)
    columns = low[starts] >> AXIS_BITS
    first, last = low[starts] & _LAST, high[starts + counts - 1] & _LAST
    same = low[1:] >> AXIS_BITS == low[:-1] >> AXIS_BITS
    low, high = high[:-1][same] + 1, low[1:][same] - 1
    outside = np.zeros(len(low), np.bool_)
    touched = []  # in each direction: the first run that each touches, and the one after the last
    for axis_bits in (0, AXIS_BITS):
        at = low >> AXIS_BITS + axis_bits & _LAST
        for step, border in ((-1, 0), (1, size - 1)):
            beside = (low >> AXIS_BITS) + (step << axis_bits)
            place = np.minimum(np.searchsorted(columns, beside), len(columns) - 1)
            outside |= (columns[place] != beside) | (at == border)
            outside |= ((low & _LAST) < first[place]) | ((high & _LAST) > last[place])
            begin, end = (beside << AXIS_BITS) + (low & _LAST), (beside << AXIS_BITS) + (high & _LAST)
            touched.append((np.searchsorted(high, begin), np.searchsorted(low, end, side="right")))
    frontier = np.flatnonzero(outside)
    while len(frontier):
        reached = []
        for begin, end in touched:
            lengths = end[frontier] - begin[frontier]
            offsets = np.arange(lengths.sum()) - np.repeat(np.cumsum(lengths) - lengths, lengths)
            reached.append(np.repeat(begin[frontier], lengths) + offsets)
        together = np.concatenate(reached)
        frontier = np.unique(together[~outside[together]])
        outside[frontier] = True
    return low[~outside], high[~outside]
