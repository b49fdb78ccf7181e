"""What no ray from outside can reach: solid voxels with nothing but solid ones around them, all 26, inside the world.

A ray crosses one plane at a time, so its first solid voxel shares a face with an empty one. The voxels at edges and
corners count too since a camera may stand on an edge or a corner of an empty voxel, and looks into what lies there.
"""

from __future__ import annotations

from voxrt.octree import _native
from voxrt.octree.octree import Octree


def hidden_voxels(octree: Octree) -> Octree:
    """Find the hidden voxels: solid, of material 1, in what is given back. Cost grows with the surface."""
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
        Equal blocks shared. Cameras outside what is solid see what they saw before.
    """
    if not 1 <= material <= 255:
        raise ValueError(f"material must be 1 ... 255, not {material}")
    _refuse_other_depth(octree, hidden)
    return Octree(octree.depth, _native.fill_hidden(octree.words, hidden.words, octree.depth, material))


def share_hidden(octree: Octree, hidden: Octree) -> Octree:
    """Give each hidden voxel whatever material lets most blocks be shared.

    Voxels that may be anything leave blocks incompletely specified; from the leaves up, blocks that contradict each
    other nowhere become one (after Shiple, Hojati, Sangiovanni-Vincentelli and Brayton, "Heuristic Minimization of BDDs
    Using Don't Cares", 1994). Which choice is best is not known to be found quickly; this one is greedy, and the same
    for equal voxels.

    Parameters
    ----------
    octree
        The memory, canonical or not.
    hidden
        What :func:`hidden_voxels` found in it.

    Returns
    -------
    Octree
        Equal blocks shared. What is solid is the same, and cameras outside it see what they saw before.
    """
    _refuse_other_depth(octree, hidden)
    return Octree(octree.depth, _native.share_hidden(octree.words, hidden.words, octree.depth))


def _refuse_other_depth(octree: Octree, hidden: Octree) -> None:
    if octree.depth != hidden.depth:
        raise ValueError(f"the hidden voxels are of depth {hidden.depth} and the octree of depth {octree.depth}")
