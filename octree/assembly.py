"""The octrees of parts of a world, joined to the octree of the whole."""

from __future__ import annotations

from voxrt.octree import _native
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.voxelize.arguments import instance, whole


class Assembly:
    """Joins the octrees of disjoint parts of a world, one after another.

    Equal blocks are stored once, whichever part they come from. So the memory holds the octree so far and one part.

    Parameters
    ----------
    depth
        Levels of the world, 1 … 16.
    expected_blocks
        Blocks of 8 words to make room for at once; more are as welcome, and cost the moving of those before.

    Raises
    ------
    TypeError, ValueError
        The depth is none, or so many blocks cannot be.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> whole = Assembly(2)
    >>> whole.add(from_points([[0, 0, 0]], [1], depth=2))
    >>> whole.add(from_points([[3, 3, 3]], [2], depth=2))
    >>> bytes(whole.octree().words) == bytes(from_points([[0, 0, 0], [3, 3, 3]], [1, 2], depth=2).words)
    True
    """

    def __init__(self, depth: int, *, expected_blocks: int = 0) -> None:
        self._depth = whole("depth", depth, 1, MAX_DEPTH)
        self._native = _native.Assembly(self._depth, whole("expected_blocks", expected_blocks, 0, 1 << 28))

    def add(self, part: Octree) -> None:
        """Add a part.

        Raises
        ------
        TypeError, ValueError
            `part` is no octree, has another depth, or has voxels where others were added.
        """
        if instance("part", part, Octree).depth != self._depth:
            raise ValueError(f"part has depth {part.depth}, and the whole {self._depth}")
        self._native.add(part.words)

    def octree(self) -> Octree:
        """Return the octree of all parts: the same bytes as of all their voxels at once."""
        return Octree(self._depth, self._native.words())
