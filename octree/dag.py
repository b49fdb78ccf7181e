"""Octrees in the form of the literature on sparse voxel DAGs: child masks and pointers, without materials.

Sources: Kämpe, Sintorn, Assarsson, "High Resolution Sparse Voxel DAGs", 2013; Jaspe-Villanueva, Marton, Gobbetti,
"SSVDAGs: Symmetry-aware Sparse Voxel DAGs", 2016.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from voxrt.octree import _native
from voxrt.octree.errors import RomError
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MIN_DAG_DEPTH = 2
"""The least levels of a graph: its lowest nodes are cubes of 4 voxels per side."""


@dataclass(frozen=True, eq=False, slots=True)
class OccupancyDag:
    """Which voxels are solid, as a directed acyclic graph of nodes with child masks.

    Attributes
    ----------
    depth
        Levels, 2 … 16: the world has 2**depth voxels per side.
    words
        uint32, shape (N,), read-only. A node of level 3 or higher is its child mask (bit i: octant i has solid voxels)
        and the address of the node of each such octant; a node of level 2 is 64 bits in two words, least significant
        first, of which bit x + 4 y + 16 z is that voxel. The root has address 0; an empty world has no words.
    """

    depth: int
    words: NDArray[np.uint32]

    def octree(self) -> Octree:
        """Return the octree of the same voxels, with material 1.

        Raises
        ------
        RomError
            The words are no such graph. The message names the word.

        Examples
        --------
        >>> from voxrt.octree import from_points
        >>> occupancy_dag(from_points([[1, 2, 3]], [7], depth=4)).octree()
        <Octree: depth 4, 33 words>
        """
        if not MIN_DAG_DEPTH <= self.depth <= MAX_DEPTH:
            raise RomError(f"depth {self.depth} is outside {MIN_DAG_DEPTH} ... {MAX_DEPTH}; the file is damaged")
        try:
            words = _native.occupied_octree(self.words, self.depth)
        except ValueError as error:
            raise RomError(f"{error}; the file is damaged") from None
        return Octree(self.depth, words)


@dataclass(frozen=True, eq=False, slots=True)
class DagCensus:
    """How often the nodes of an octree are stored, in the forms of the literature.

    Attributes
    ----------
    tree_nodes, tree_words
        Of the plain octree, every node once for each place where it stands. uint64, shape (depth + 1,), by level. Under
        level 1 and 0, which have no nodes of their own, stand the cubes of 2 voxels per side that are not empty, and
        the solid voxels.
    nodes, words
        Of the graph: equal nodes once.
    mirrored_nodes, mirrored_words
        If nodes that are equal up to mirroring along axes were stored once, and each pointer held its mirror in three
        of its bits.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> counts = dag_census(from_points([[0, 0, 0], [4, 0, 0]], [1, 1], depth=3))
    >>> counts.tree_nodes.tolist(), counts.nodes.tolist()
    ([2, 2, 2, 1], [0, 0, 1, 1])
    """

    tree_nodes: NDArray[np.uint64]
    tree_words: NDArray[np.uint64]
    nodes: NDArray[np.uint64]
    words: NDArray[np.uint64]
    mirrored_nodes: NDArray[np.uint64]
    mirrored_words: NDArray[np.uint64]


def occupancy_dag(octree: Octree) -> OccupancyDag:
    """Return which voxels of an octree are solid, as a graph. Materials are left out, and nodes are shared again.

    Raises
    ------
    DoesNotFitError
        The octree has depth 1, or the graph more than 2**32 words.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> occupancy_dag(from_points([[0, 0, 0], [4, 0, 0]], [7, 8], depth=3)).words.tolist()
    [3, 3, 3, 1, 0]
    """
    tree = _deep_enough(octree)
    try:
        return OccupancyDag(tree.depth, _native.occupancy_dag(tree.words, tree.depth))
    except ValueError as error:
        raise DoesNotFitError(str(error)) from None


def dag_census(octree: Octree) -> DagCensus:
    """Count the nodes and words of the graph of an octree, and what symmetry would save.

    Raises
    ------
    DoesNotFitError
        As :func:`occupancy_dag`.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> counts = dag_census(from_points([[0, 0, 0], [7, 0, 0]], [1, 1], depth=3))
    >>> counts.nodes.tolist(), counts.mirrored_nodes.tolist()
    ([0, 0, 2, 1], [0, 0, 1, 1])
    """
    tree = _deep_enough(octree)
    return DagCensus(*_native.dag_levels(tree.words, tree.depth).T)


def mirrored_blocks(octree: Octree) -> int:
    """Count the blocks that would remain of a memory if those equal up to mirroring along axes were stored once.

    The memory is counted as it is, with its materials.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> tree = from_points([[0, 0, 0], [7, 0, 0]], [1, 1], depth=3)
    >>> tree.blocks, mirrored_blocks(tree)
    (5, 3)
    """
    return _native.mirrored_blocks(instance("octree", octree, Octree).words, octree.depth)


def _deep_enough(octree: Octree) -> Octree:
    if instance("octree", octree, Octree).depth < MIN_DAG_DEPTH:
        raise DoesNotFitError(f"a graph has {MIN_DAG_DEPTH} levels or more, and the octree {octree.depth}")
    return octree
