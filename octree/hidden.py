"""Hidden voxels, which no ray from outside can reach: solid, inside the world, with all 26 neighbours solid.

A ray crosses one plane at a time, so its first solid voxel shares a face with an empty one. Neighbours at edges and
corners count too: a camera may stand on an edge or a corner of an empty voxel and look into them.
"""

from __future__ import annotations

from voxrt.octree import _native
from voxrt.octree.octree import Octree
from voxrt.voxelize.arguments import instance, whole


def hidden_voxels(octree: Octree) -> Octree:
    """Find the hidden voxels. The cost grows with the surface.

    Returns
    -------
    Octree
        The hidden voxels, solid, of material 1; all else is empty.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import census, from_dense
    >>> census(hidden_voxels(from_dense(np.ones((4, 4, 4), int)))).solid_voxels
    8
    """
    instance("octree", octree, Octree)
    return Octree(octree.depth, _native.hidden_voxels(octree.words, octree.depth))


def fill_hidden(octree: Octree, hidden: Octree, material: int) -> Octree:
    """Make all hidden voxels one material.

    Parameters
    ----------
    octree
        The memory, canonical or not.
    hidden
        What :func:`hidden_voxels` found in it.
    material
        Material id, 1 … 255.

    Returns
    -------
    Octree
        Equal blocks are shared. A camera outside the solid sees the same picture.

    Raises
    ------
    TypeError, ValueError
        The material is no such id, or the octrees differ in depth.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import census, from_dense
    >>> tree = from_dense(np.ones((4, 4, 4), int))
    >>> census(fill_hidden(tree, hidden_voxels(tree), 2)).voxels
    {1: 56, 2: 8}
    """
    material = whole("material", material, 1, 255)
    _refuse_other_depth(octree, hidden)
    return Octree(octree.depth, _native.fill_hidden(octree.words, hidden.words, octree.depth, material))


def share_hidden(octree: Octree, hidden: Octree) -> Octree:
    """Give each hidden voxel the material that lets most blocks be shared.

    Hidden voxels may be of any material, so their blocks are incompletely specified. From the leaves up, blocks that do
    not contradict each other become one (after Shiple, Hojati, Sangiovanni-Vincentelli and Brayton, "Heuristic
    Minimization of BDDs Using Don't Cares", 1994). The choice is greedy, not optimal, and the same for equal voxels.

    Parameters
    ----------
    octree
        The memory, canonical or not.
    hidden
        What :func:`hidden_voxels` found in it.

    Returns
    -------
    Octree
        Equal blocks are shared. The same voxels are solid. A camera outside the solid sees the same picture.

    Raises
    ------
    TypeError, ValueError
        One is no octree, or they differ in depth.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import census, from_dense
    >>> world = np.ones((4, 4, 4), int)
    >>> world[1, 1, 1] = 2
    >>> tree = from_dense(world)
    >>> share_hidden(tree, hidden_voxels(tree))
    <Octree: depth 2, 1 words>
    """
    _refuse_other_depth(octree, hidden)
    return Octree(octree.depth, _native.share_hidden(octree.words, hidden.words, octree.depth))


def _refuse_other_depth(octree: Octree, hidden: Octree) -> None:
    instance("octree", octree, Octree)
    if octree.depth != instance("hidden", hidden, Octree).depth:
        raise ValueError(f"the hidden voxels are of depth {hidden.depth} and the octree of depth {octree.depth}")
