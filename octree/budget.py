"""Fit an octree to the memory that a board has, giving up what is seen least.

How it works: equal blocks are shared first, which costs nothing. If that is not enough, blocks two and three levels
above the voxels let similar blocks stand for them (van der Laan, Scandolo and Eisemann, "Lossy Geometry Compression for
High Resolution Voxel Scenes", 2020): a block goes where the voxels that change, counted wherever it stands, weigh less
than the price of a block, and the price rises until the memory fits. A stand-in holds every solid voxel of what it
stands for, so a wall never gets a hole; what it holds beyond that is what silhouettes grow by. Materials that no ray
from outside reaches change for nothing. Memories far too large start from a world made coarser by one level or more;
every candidate that fits is measured against the original, the plain coarser world among them; the closest is taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import _native
from voxrt.octree.diff import diff
from voxrt.octree.octree import Octree
from voxrt.octree.surface import SurfaceChange, surface_change
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

BOARDS = {"pynq-z1": 1 + 8 * 4096}
"""Words that the octree memory of a board's design holds: its configuration's 2**BlockBits blocks, and the root."""

_LEVELS_KEPT = 3
"""However small the budget, octants of more than 1/8 of the world's side are never filled up."""

_EXPONENTS = (0.0, 44.0)
_COARSE_DISCOUNT = 0.75
_FINE_EXPONENTS = (-1.5, 2.5)
_MANY_BLOCKS = 30_000
"""With fewer blocks there is time to start from a world twice as fine as need be, too."""


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """An octree that fits, and what that took.

    Attributes
    ----------
    octree
        The memory, blocks shared.
    words_before
        Words of the memory that was given.
    words_shared
        Words once equal blocks are shared and nothing is given up.
    surface
        Surface voxels of the original: solid, one of the six neighbours empty.
    changed
        Of those, no longer on the surface, or of another material.
    appeared, recoloured
        Voxels that became solid; voxels of another material, hidden ones included.
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
    """Store equal blocks once, breadth-first: the canonical memory of the same voxels."""
    return Octree(octree.depth, _native.coarsen(octree.words, octree.depth, 0))


def coarsen(octree: Octree, level: int) -> Octree:
    """Make every octant of side 2**level uniform, in a world of unchanged depth: the plain way to a smaller memory.

    An octant is empty where all of it was, else solid, of the material that most of its solid voxels had.
    """
    if not 0 <= level <= octree.depth:
        raise ValueError(f"level must be 0 ... {octree.depth}, not {level}")
    return Octree(octree.depth, _native.coarsen(octree.words, octree.depth, level))


def fit(octree: Octree, words: int, *, colours: NDArray[np.uint8] | None = None) -> Fit:
    """Make `octree` fit a memory of `words` words, changing as little of its surface as it can.

    Parameters
    ----------
    octree
        The memory, canonical or not.
    words
        What the result may take.
    colours
        uint8, shape (M, 3), sRGB by material id: the nearer two colours, the rather one stands for the other. Without
        them all materials are equally far apart.

    Returns
    -------
    Fit
        No voxel that was solid is empty in it.

    Raises
    ------
    DoesNotFitError
        Where even a world of 8 octants a side takes more: names the smallest size that can.
    """
    shared = share(octree)
    if len(shared.words) <= words:
        return _measure(octree, shared, shared)
    candidates = list(_candidates(shared, words, _recolour_costs(colours)))
    fits = [_measure(octree, shared, candidate) for candidate in candidates]
    return min(fits, key=lambda fitting: (fitting.changed + fitting.appeared, len(fitting.octree.words)))


def _candidates(shared: Octree, words: int, costs: NDArray[np.uint16]) -> Iterator[Octree]:
    """Memories of at most `words` words: the finest plain coarser world, and finer ones with merged blocks."""
    worlds = [shared]
    while len(worlds[-1].words) > words and len(worlds) <= shared.depth - _LEVELS_KEPT:
        worlds.append(coarsen(shared, len(worlds)))
    if len(worlds[-1].words) > words:
        raise DoesNotFitError(
            f"the octree does not fit {words} words: as coarse as it may become it takes {len(worlds[-1].words)}; "
            f"give it at least {len(worlds[-1].words)} words"
        )
    yield worlds[-1]
    starts = 1 if shared.blocks > _MANY_BLOCKS else 2
    for finest in range(max(0, len(worlds) - 1 - starts), len(worlds) - 1):
        yield from _merged(worlds[finest], finest, words, costs)


def _merged(world: Octree, finest: int, words: int, costs: NDArray[np.uint16]) -> Iterator[Octree]:
    """Memories that fit at the least price for which they do.

    First one price for all blocks; then, with blocks three levels above the voxels cheaper than that, the least price
    for those two levels above them, which are shared more and so deserve one of their own.
    """
    hidden = _native.hidden_voxels(world.words, world.depth)

    def merge(fine_exponent: float, coarse_exponent: float) -> Octree:
        fine_price, coarse_price = int(2**fine_exponent), int(2**coarse_exponent)
        words = _native.merge_blocks(world.words, hidden, world.depth, finest, costs, fine_price, coarse_price)
        return Octree(world.depth, words)

    exponent, found = _least_exponent(lambda e: merge(e, e), words, _EXPONENTS, 8)
    if found is None:
        return
    yield found
    around = (exponent + _FINE_EXPONENTS[0], exponent + _FINE_EXPONENTS[1])
    _, found = _least_exponent(lambda e: merge(e, exponent - _COARSE_DISCOUNT), words, around, 4)
    if found is not None:
        yield found


def _least_exponent(
    merge: Callable[[float], Octree], words: int, exponents: tuple[float, float], steps: int
) -> tuple[float, Octree | None]:
    """Halve the range of exponents: the least found whose memory fits, and the largest memory that did."""
    low, high = exponents
    fitting: Octree | None = None
    for _ in range(steps):
        middle = (low + high) / 2
        merged = merge(middle)
        if len(merged.words) > words:
            low = middle
            continue
        high = middle
        if fitting is None or len(merged.words) >= len(fitting.words):
            fitting = merged
    return high, fitting


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


def _recolour_costs(colours: NDArray[np.uint8] | None) -> NDArray[np.uint16]:
    """Cost of showing one material for another, uint16 of shape (256, 256); 256 is that of a voxel that appears."""
    costs = np.full((256, 256), 128, dtype=np.uint16)
    if colours is not None:
        table = np.asarray(colours, dtype=np.float64)
        if table.ndim != 2 or table.shape[1] != 3 or len(table) > 256:
            raise ValueError(f"colours must have the shape (M, 3), M at most 256, not {table.shape}")
        apart = np.linalg.norm(table[:, None] - table[None], axis=-1) / np.linalg.norm([255.0] * 3)
        costs[: len(table), : len(table)] = np.maximum(8, np.rint(256 * apart))
    np.fill_diagonal(costs, 0)
    return costs
