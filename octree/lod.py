"""Level of detail: a mean material for each block, which rays show that need not go into it.

The mean is that of what is visible below, in linear light; the manual's page on level of detail defines it. Source of
the idea: Laine and Karras, "Efficient Sparse Voxel Octrees", 2010, whose inner nodes have colours too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.octree import _native
from voxrt.octree.animation import frames_as_octants
from voxrt.octree.rom import Rom
from voxrt.voxelize.arguments import instance
from voxrt.voxelize.colour.srgb import linear_from_srgb

if TYPE_CHECKING:
    from collections.abc import Sequence

_LIGHT = 65535


def with_means(rom: Rom, roots: Sequence[int] = (0,)) -> Rom:
    """Give the blocks of a memory their mean materials: what the dialect ``lod`` holds.

    Parameters
    ----------
    rom
        The memory. Means that it has already are made anew.
    roots
        Those of all frames of an animation.

    Returns
    -------
    Rom
        The same memory, with ``octree.means``.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import from_dense
    >>> from voxrt.voxelize import EMPTY, Material
    >>> floor = np.zeros((4, 4, 4), np.uint8)
    >>> floor[:, :3] = 1
    >>> rom = with_means(Rom("floor", from_dense(floor), (EMPTY, Material("oak", (160, 110, 60)))))
    >>> rom.octree.means.tolist()  # the root is full enough; the block of the half-filled octants is not
    [1, 0]
    """
    tree = instance("rom", rom, Rom).octree
    colours = np.array([material.colour for material in rom.materials], np.uint8)
    light = np.floor(linear_from_srgb(colours) * _LIGHT + 0.5).astype(np.uint16)
    whole = tree if len(roots) == 1 else frames_as_octants(tree, roots)
    means = _native.mean_materials(whole.words, whole.depth, light)[: tree.blocks]
    return replace(rom, octree=replace(tree, means=means))
