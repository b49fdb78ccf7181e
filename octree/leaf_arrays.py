"""The leaves, one chunk at a time: because blocks are shared, there can be far more than memory holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.octree import Octree
from voxrt.octree.query import as_box
from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.arguments import flag, instance, whole
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.octree.query import Corner


LEAF_LIMIT = 1 << 24
"""The most solid leaves that :func:`solid_leaves` returns."""


class Leaves(Value, frozen=True, eq=False):
    """Some leaves, in Morton order, as :func:`leaves` returns them.

    Attributes
    ----------
    corners
        int32, shape (N, 3): lowest voxel (x, y, z).
    levels
        uint8, shape (N,): log2 of the side in voxels.
    materials
        uint8, shape (N,).
    """

    corners: NDArray[np.int32]
    levels: NDArray[np.uint8]
    materials: NDArray[np.uint8]


def leaves(
    octree: Octree, low: Corner = (0, 0, 0), high: Corner | None = None, *, solid_only: bool = False, chunk: int = 65536
) -> Iterator[Leaves]:
    """Walk the leaves that overlap a box, whole (not clipped), in Morton order.

    Parameters
    ----------
    octree
        The memory.
    low, high
        Integers (x, y, z): the lowest voxel, and one behind the highest (default: the world's end).
    solid_only
        Skip empty leaves.
    chunk
        The most leaves at a time, at least 1.

    Yields
    ------
    Leaves
        The next chunk.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong type or out of range.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> (part,) = leaves(from_points([[1, 2, 3]], [7], depth=2), solid_only=True)
    >>> part.corners.tolist(), part.levels.tolist(), part.materials.tolist()
    ([[1, 2, 3]], [0], [7])
    """
    instance("octree", octree, Octree)
    start, end = as_box(low, (octree.size,) * 3 if high is None else high)
    walk = _native.LeafWalk(octree.words, octree.depth, start, end, flag("solid_only", solid_only))
    return _chunks(walk, whole("chunk", chunk, 1, 1 << 31))


def _chunks(walk: _native.LeafWalk, chunk: int) -> Iterator[Leaves]:
    while len((part := Leaves(*walk.next(chunk))).levels):
        yield part


def solid_leaves(octree: Octree, low: Corner = (0, 0, 0), high: Corner | None = None) -> Leaves:
    """Return all solid leaves that overlap a box at once, as :func:`leaves` yields them.

    DoesNotFitError for more than :data:`LEAF_LIMIT`; TypeError or ValueError where a corner is none.
    """
    chunks, count = [Leaves(np.zeros((0, 3), np.int32), np.zeros(0, np.uint8), np.zeros(0, np.uint8))], 0
    for chunk in leaves(octree, low, high, solid_only=True):
        count += len(chunk.levels)
        if count > LEAF_LIMIT:
            raise DoesNotFitError(f"more than {LEAF_LIMIT} octants cannot be shown; show a part, or coarser octants")
        chunks.append(chunk)
    return Leaves(
        np.concatenate([chunk.corners for chunk in chunks]),
        np.concatenate([chunk.levels for chunk in chunks]),
        np.concatenate([chunk.materials for chunk in chunks]),
    )
