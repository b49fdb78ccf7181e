"""How the memory of a world that is edited is used."""

from __future__ import annotations

from voxrt.voxelize.value import Value


class WorldFigures(Value, frozen=True):
    """How the memory of a :class:`World` is used.

    Attributes
    ----------
    blocks
        Blocks of 8 words of the octree as it is now.
    kept
        Further blocks: those of undo, redo and live roots, and those that hold the words of roots.
    free
        Blocks for the next edits.
    """

    blocks: int
    kept: int
    free: int
