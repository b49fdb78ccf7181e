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

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.difference import diff
from voxrt.octree.octree import Octree
from voxrt.octree.surface import SurfaceChange, surface_change
from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.arguments import instance, whole, whole_array

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    _SightCosts = tuple[NDArray[np.uint32], NDArray[np.uint32], NDArray[np.uint32]]

BOARDS = {
    "icepi-zero": 1 + 8 * 2048,
    "pynq-z1": 1 + 8 * 4096,
    "ulx3s-12f": 1 + 8 * 2048,
    "ulx3s-45f": 1 + 8 * 4096,
    "ulx3s-85f": 1 + 8 * 4096,
}
"""Words of the octree memory of each board's design: 2**BlockBits blocks of 8, and the root."""

_LEVELS_KEPT = 3
"""However small the budget, octants of more than 1/8 of the world's side are never filled up."""

_MANY_BLOCKS = 30_000
"""With fewer blocks there is time to start from a world four times as fine as what fits, not twice."""

_FACES = np.array((0.21, 0.25, 0.54))
"""How bright the faces along the three axes are in the default picture of a scene."""

_STANDING_OUT = 6
"""Another material's colour counts so many times: it stands out where a face that turns is lost among others."""

_PASSED = 0.5
"""A ray that is stopped by more than stopped it before would mostly have met a face close by: this share of the error
of a face that turns, ..."""

_BACKGROUND = 0.1
"""... and this share of that of a face before the background."""


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
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
    costs = _sight_costs(colours)
    shared = share(octree)
    if len(shared.words) <= words:
        return _measure(octree, shared, shared)
    fits = [_measure(octree, shared, candidate) for candidate in _candidates(shared, words, costs)]
    return choose(fits) if choose else min(fits, key=lambda fit: (fit.changed + fit.appeared, len(fit.octree.words)))


def _candidates(shared: Octree, words: int, costs: _SightCosts) -> Iterator[Octree]:
    """Memories of at most `words` words: the finest plain coarser world, and finer ones with fewer different bricks."""
    worlds = [shared]
    while len(worlds[-1].words) > words and len(worlds) <= shared.depth - _LEVELS_KEPT:
        worlds.append(coarsen(shared, len(worlds)))
    if len(worlds[-1].words) > words:
        raise DoesNotFitError(
            f"the octree does not fit {words} words: as coarse as it may become it takes {len(worlds[-1].words)}; "
            f"give it at least {len(worlds[-1].words)} words"
        )
    yield worlds[-1]
    finest = max(0, len(worlds) - (2 if shared.blocks > _MANY_BLOCKS else 3))
    world = worlds[finest]
    hidden = _native.hidden_voxels(world.words, world.depth)
    for found in _native.fit_bricks(world.words, hidden, world.depth, finest, *costs, words):
        yield Octree(world.depth, found)


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


def _sight_costs(colours: NDArray[np.uint8] | None) -> _SightCosts:
    """Mean squared differences of colour where a ray meets another material, another face, or a voxel that appeared.

    Returns
    -------
    tuple
        uint32 of the shapes (256, 256), (256, 256) and (256,): a material becomes another on a face that stays, on a
        face that turns, and where a ray passed. 256 is a middling grey face that turns.
    """
    table = np.full((256, 3), 150.0)
    if colours is not None:
        given = whole_array("colours", colours, ("M", 3), np.int64, low=0, high=255)
        if len(given) > 256:
            raise ValueError(f"colours must have shape (M, 3), M at most 256, not {given.shape}")
        table[: len(given)] = given
    turns = [(a, b) for a in _FACES for b in _FACES if a != b]
    unit = 256 / np.mean([3 * (150 * (a - b)) ** 2 for a, b in turns])
    same = _STANDING_OUT * unit * np.mean(_FACES**2) * _squares(table, table)
    turned = same + unit * np.mean([_squares(a * table, b * table) for a, b in turns], axis=0)
    if colours is None:
        other = 128 * (1 - np.eye(256))
        same, turned = same + other, turned + other
    behind = unit * np.mean([_squares(a * table, table[:1])[:, 0] for a in _FACES], axis=0)
    covering = _PASSED * np.diag(turned) + _BACKGROUND * behind
    same, turned, covering = (np.maximum(8, np.rint(cost)).astype(np.uint32) for cost in (same, turned, covering))
    np.fill_diagonal(same, 0)
    return same, turned, covering


def _squares(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    squares: NDArray[np.float64] = ((a[:, None] - b[None]) ** 2).sum(axis=-1)
    return squares
