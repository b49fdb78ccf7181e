"""A scene in the memory of a device: where it is, and how it is read back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.board.errors import Refused
from voxrt.board.scene import Scene, check_memory
from voxrt.octree.words import EMPTY, is_leaf, move_pointers
from voxrt.sim.engine_arguments import mirrors_of, palette_of
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

_FIRST_WORDS = 4096
"""Words of an octree that are read at first; most of a small one."""


class LoadedScene(Value, frozen=True, eq=False):
    """A scene in the memory of a device.

    Attributes
    ----------
    scene
        Its words count from its own word 0, which is the word of its root, whatever the memory has there.
    base
        The word of the memory where the scene's word 0 is.
    shown
        Whether frames show it. If not, its materials are not known, and word 0 of the memory is another one.
    """

    scene: Scene
    base: int
    shown: bool = True

    def image(self) -> tuple[NDArray[np.uint32], int]:
        """Return the words of the memory as far as the scene goes, and the address of its root.

        Words before the scene are empty, and word 0 is that of the root.
        """
        root = self.base + self.scene.roots[0]
        words = np.full(self.base + len(self.scene.words), EMPTY, np.uint32)
        words[self.base :] = move_pointers(self.scene.words, self.base)
        words[0] = words[root]
        return words, root


def cut_out(words: NDArray[np.uint32], start: int, root: int, scene: Scene) -> LoadedScene:
    """Find a scene in a memory: from the first word in use to the last. Others between them become empty.

    Parameters
    ----------
    words
        uint32, shape (N,): the words of the memory from word `start` on.
    root
        The word where the octree's root is.
    scene
        All of the scene but its words.
    """
    blocks = _reached(words, start, root, scene.depth)
    first, end = _span(blocks, root)
    base = first // 8 * 8
    found = np.full(end - base + (base + 1 - end) % 8, EMPTY, np.uint32)
    used = np.append(blocks[:, None] + np.arange(8), root)
    used = used[(start <= used) & (used < start + len(words))]
    found[used - base] = move_pointers(words[used - start], -base)
    found[0] = found[root - base]
    return LoadedScene(replace(scene, words=found, roots=(root - base,)), base)


def read_back(
    read: Callable[[int, int], NDArray[np.uint32]], capacity: int, root: int, depth: int
) -> LoadedScene | None:
    """Read the octree of a scene from the memory of a device; None if its words are no octree.

    Parameters
    ----------
    read
        Reads words of the memory: the address of the first, and their number.
    capacity
        The words of the memory.
    root
        The word where the octree's root is.
    depth
        Its levels.
    """
    if root >= capacity:
        return None
    words, start = np.empty(0, np.uint32), root
    first, end = root, min(root + _FIRST_WORDS, capacity)
    while first < start or end > start + len(words):  # a level more each time, at least
        parts = [read(low, high - low) for low, high in ((first, start), (start + len(words), end)) if low < high]
        words = np.concatenate([*parts[: first < start], words, *parts[first < start :]])
        start = min(first, start)
        blocks = _reached(words, start, root, depth)
        first, end = _span(blocks, root)
        if end > capacity or (blocks % 8 != 1).any():
            return None  # whatever was in the memory at power-on
    scene = Scene("the scene on the board", depth, words, palette_of(()), mirrors_of(()))
    found = cut_out(words, start, root, scene)
    try:
        check_memory(found.scene.words, depth)
    except Refused:
        return None
    return replace(found, shown=False)


def _reached(words: NDArray[np.uint32], start: int, root: int, depth: int) -> NDArray[np.int64]:
    """Find the blocks of an octree in a memory: int64, ascending. Pointers to words that are not known end there."""
    blocks, addresses = [np.empty(0, np.int64)], np.array([root - start])
    for _ in range(depth):
        reached = words[addresses[(addresses >= 0) & (addresses < len(words))]]
        blocks.append(np.unique(reached[~is_leaf(reached)]).astype(np.int64))
        addresses = (blocks[-1][:, None] + np.arange(8) - start).ravel()
    return np.unique(np.concatenate(blocks))


def _span(blocks: NDArray[np.int64], root: int) -> tuple[int, int]:
    """Return the first word of blocks and a root, and the end of the last."""
    return min([root, *blocks[:1].tolist()]), max([root + 1, *(blocks[-1:] + 8).tolist()])
