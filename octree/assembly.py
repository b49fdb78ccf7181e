"""The octrees of parts of a world, joined to the octree of the whole: in memory, or in a file where it does not fit."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.voxelize.arguments import instance, whole

if TYPE_CHECKING:
    from pathlib import Path


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


class DiskAssembly:
    """Joins octrees as :class:`voxrt.octree.Assembly` does, with the blocks in a file.

    Memory holds 12 bytes per block, and `cache`.

    Parameters
    ----------
    depth
        Levels of the world, 1 … 16.
    folder
        A folder on a disk with room for the octree. Its file has no name: it goes with the process.
    cache
        Bytes of memory for blocks that are in use.

    Raises
    ------
    TypeError, ValueError
        The depth is none.
    OSError
        The folder cannot be written to.

    Examples
    --------
    >>> from pathlib import Path
    >>> from voxrt.octree import from_points
    >>> whole = DiskAssembly(2, Path("."), cache=1 << 20)
    >>> whole.add(from_points([[0, 0, 0]], [1], depth=2))
    >>> whole.add(from_points([[3, 3, 3]], [2], depth=2))
    >>> tree = whole.octree(Path("words"))
    >>> bytes(tree.words) == bytes(from_points([[0, 0, 0], [3, 3, 3]], [1, 2], depth=2).words)
    True
    """

    def __init__(self, depth: int, folder: Path, *, cache: int) -> None:
        self._depth = whole("depth", depth, 1, MAX_DEPTH)
        self._native = _native.DiskAssembly(self._depth, os.fsencode(folder), whole("cache", cache, 0, 1 << 62))

    def add(self, part: Octree) -> None:
        """Add a part.

        Raises
        ------
        TypeError, ValueError
            `part` is no octree, has another depth, or has voxels where others were added.
        OSError
            The disk is full.
        """
        if instance("part", part, Octree).depth != self._depth:
            raise ValueError(f"part has depth {part.depth}, and the whole {self._depth}")
        self._native.add(part.words)

    def octree(self, path: Path) -> Octree:
        """Write the words of the octree to a file, and return it with its words mapped from there.

        The bytes are those of all voxels at once. Nothing can be added afterwards.

        Raises
        ------
        OSError
            The file cannot be written.
        """
        self._native.write(os.fsencode(path))
        return Octree(self._depth, np.memmap(path, np.uint32, mode="r").view(np.ndarray))
