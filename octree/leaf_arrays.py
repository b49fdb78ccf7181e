"""The leaves, a chunk at a time: sharing can make them far more than memory holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.octree.octree import Octree
    from voxrt.octree.query import Corner


LEAF_LIMIT = 1 << 24
"""The most solid leaves that are taken at once."""


@dataclass(frozen=True, eq=False, slots=True)
class Leaves:
    """Some leaves, in Morton order.

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
    octree: Octree,
    low: Corner = (0, 0, 0),
    high: Corner | None = None,
    *,
    solid_only: bool = False,
    chunk: int = 65536,
) -> Iterator[Leaves]:
    """Walk the leaves that overlap a box, whole (not clipped), in Morton order.

    Parameters
    ----------
    octree
        The memory.
    low, high
        Voxels from `low` up to and without `high` (default: the world's end).
    solid_only
        Leaves empty space out.
    chunk
        The most leaves at a time, at least 1.
    """
    if chunk < 1:
        raise ValueError(f"a chunk holds at least 1 leaf, not {chunk}")
    end = (octree.size,) * 3 if high is None else high
    walk = _native.LeafWalk(octree.words, octree.depth, low, end, solid_only)
    while len((part := walk.next(chunk)).levels):
        yield Leaves(corners=part.corners, levels=part.levels, materials=part.materials)


def solid_leaves(octree: Octree, low: Corner = (0, 0, 0), high: Corner | None = None) -> Leaves:
    """Take all solid leaves that overlap a box at once, as :func:`leaves` gives them.

    Raises
    ------
    DoesNotFitError
        More than :data:`LEAF_LIMIT`.
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
