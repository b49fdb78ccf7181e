"""Fit an octree to the memory of a board, giving up the least visible detail.

How it works: equal blocks are shared first, without loss. If that is not enough, bricks of 8 x 8 x 8 cells are replaced
by representatives: other bricks of the scene, and coarser or fuller versions of all (the idea is that of van der Laan,
Scandolo and Eisemann, "Lossy Geometry Compression for High Resolution Voxel Scenes", 2020). The cost of a
representative is the change of the brick's appearance along the eight diagonals of its cube: faces that turn or change
colour, and what is covered. The choice of bricks to keep is a facility location problem. It is solved by adding and
dropping (Kuehn and Hamburger, "A Heuristic Program for Locating Warehouses", 1963) at a falling price per block, until
the memory is full. A representative holds every solid voxel of the brick that it replaces, so walls get no holes;
silhouettes grow by its other voxels. Octants that no ray from outside reaches change at no cost. Memories far too large
start from a world that is coarser by one level or more. Every candidate that fits is compared with the original, the
plain coarser world included, and the most similar one is taken.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.difference import SurfaceChange, diff, surface_change
from voxrt.octree.octree import Octree
from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.arguments import instance, whole, whole_array
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray


class Fit(Value, frozen=True, eq=False):
    """An octree that fits a memory, and what changed, as :func:`fit` returns it.

    Attributes
    ----------
    octree
        The memory; equal blocks are shared.
    words_before
        Words of the memory that was given.
    words_shared
        Words of that memory with equal blocks shared and nothing given up.
    surface
        Surface voxels of the original: solid, with one of the six neighbours empty.
    changed
        Those of them that are no longer on the surface, or of another material.
    appeared
        Voxels that became solid.
    recoloured
        Voxels of another material, hidden ones included.
    """

    octree: Octree
    words_before: int
    words_shared: int
    surface: int
    changed: int
    appeared: int
    recoloured: int

    @property
    def percent_changed(self) -> float:
        """Percent of the surface voxels that changed."""
        return SurfaceChange(self.surface, self.changed).percent


def share(octree: Octree) -> Octree:
    """Store equal blocks once, breadth-first: the canonical memory of the same voxels.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import Octree
    >>> words = np.array([1, 9, *[0xFFFFFF01] * 6, 17, *[0xFFFFFF00] * 7, 0xFFFFFF02, *[0xFFFFFF00] * 7, 0xFFFFFF02])
    >>> share(Octree(2, words.astype(np.uint32)))
    <Octree: depth 2, 17 words>
    """
    instance("octree", octree, Octree)
    return Octree(octree.depth, _native.coarsen(octree.words, octree.depth, 0))


def shared_words(octree: Octree) -> int:
    """Return the words of :func:`share` without making them, in half of the memory that `octree` takes.

    Examples
    --------
    >>> import numpy as np
    >>> words = np.array([1, 9, *[0xFFFFFF01] * 6, 17, *[0xFFFFFF00] * 7, 0xFFFFFF02, *[0xFFFFFF00] * 7, 0xFFFFFF02])
    >>> shared_words(Octree(2, words.astype(np.uint32)))
    17
    """
    instance("octree", octree, Octree)
    return _native.shared_words(octree.words, octree.depth)


def coarsen(octree: Octree, level: int) -> Octree:
    """Make every octant of 2**level voxels per side uniform, in a world of unchanged depth.

    Parameters
    ----------
    octree
        The memory.
    level
        0 … depth.

    Returns
    -------
    Octree
        An octant is empty if all of it was empty. Else it is solid, of the material that most of its solid voxels had.

    Raises
    ------
    TypeError, ValueError
        The level is none of these.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> coarse = coarsen(from_points([[1, 2, 3]], [7], depth=2), 1)
    >>> coarse.blocks
    1
    """
    instance("octree", octree, Octree)
    level = whole("level", level, 0, octree.depth)
    return Octree(octree.depth, _native.coarsen(octree.words, octree.depth, level))


def fit(
    octree: Octree,
    words: int,
    *,
    colours: NDArray[np.uint8] | None = None,
    choose: Callable[[Sequence[Fit]], Fit] | None = None,
) -> Fit:
    """Make an octree fit a memory of `words` words, with as little visible change as possible.

    Parameters
    ----------
    octree
        The memory, canonical or not.
    words
        Largest size of the result.
    colours
        Integers 0 … 255, shape (M, 3), sRGB by material id; entry 0 is the background. Materials of similar colours
        replace each other first. None makes all materials equally different.
    choose
        Chooses one of the candidates; the first is the plain coarser world. None takes the candidate with the fewest
        voxels that appeared or changed on the surface.

    Returns
    -------
    Fit
        Every voxel that was solid is solid in it.

    Raises
    ------
    TypeError, ValueError
        The size or the colours are none of these.
    DoesNotFitError
        Even a world of 8 octants per side takes more words. The message names the smallest possible size.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import from_dense
    >>> tree = from_dense(np.random.default_rng(1).random((32, 32, 32)) < 0.1)
    Traceback (most recent call last):
        ...
    TypeError: materials must be an array of integers, not of booleans
    >>> tree = from_dense((np.random.default_rng(1).random((32, 32, 32)) < 0.1).astype(np.uint8))
    >>> fitted = fit(tree, 2000)
    >>> len(fitted.octree.words) <= 2000 < fitted.words_shared
    True
    """
    instance("octree", octree, Octree)
    words = whole("words", words, 1, 1 << 32)
    table = _colours(colours)
    shared = share(octree)
    if len(shared.words) <= words:
        return _measure(octree, shared, shared)
    found, problem = _native.fit_candidates(shared.words, shared.depth, words, table)
    if problem:
        raise DoesNotFitError(problem)
    fits = [_measure(octree, shared, Octree(shared.depth, one)) for one in found]
    return choose(fits) if choose else min(fits, key=lambda fit: (fit.changed + fit.appeared, len(fit.octree.words)))


def _colours(rows: NDArray[np.uint8] | None) -> NDArray[np.uint8]:
    if rows is None:
        return np.zeros((0, 3), np.uint8)
    colours = whole_array("colours", rows, ("M", 3), np.uint8, low=0, high=255)
    if len(colours) > 256:
        raise ValueError(f"colours must have shape (M, 3), M at most 256, not {colours.shape}")
    return np.ascontiguousarray(colours)


def _measure(original: Octree, shared: Octree, result: Octree) -> Fit:
    seen = surface_change(original, result)
    difference = diff(original, result)
    return Fit(
        octree=result,
        words_before=len(original.words),
        words_shared=len(shared.words),
        surface=seen.surface,
        changed=seen.changed,
        appeared=difference.appeared,
        recoloured=difference.recoloured,
    )
