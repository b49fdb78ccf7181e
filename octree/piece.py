"""Voxels of a world, cut out to be put elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from voxrt.octree.octree import Octree
    from voxrt.octree.query import Corner
    from voxrt.voxelize import Material


class Piece(Value, frozen=True, eq=False):
    """The voxels of a box, as :meth:`World.copy` returns them and :meth:`World.paste` takes them.

    Attributes
    ----------
    octree
        Its voxels; the lowest corner of the box is voxel 0, 0, 0.
    size
        Voxels of the box along x, y and z.
    materials
        The materials by id.
    """

    octree: Octree
    size: Corner
    materials: tuple[Material, ...]
