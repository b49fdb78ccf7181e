"""What is solid in a box, for whoever walks there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.octree import _native
from voxrt.octree.octree import Octree
from voxrt.octree.query import as_box
from voxrt.octree.world import World

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_MOST_SIDE = 1 << 16


def solid_box(source: Octree | World, low: ArrayLike, high: ArrayLike, *, words: int, octants: int) -> Octree:
    """Cut the solid voxels of a box out, all of material 1; its lowest corner becomes voxel 0, 0, 0.

    Parameters
    ----------
    source
        An octree, or a world as it is now.
    low, high
        Integers (x, y, z): the lowest voxel, and one behind the highest. What lies outside of the world is empty.
    words
        The most words of the result.
    octants
        The most octants of the source to look into: a bound of the time.

    Raises
    ------
    TypeError, ValueError
        A corner is not three integers, or the box is empty or too large, also for `words` or `octants`.

    Examples
    --------
    >>> from voxrt.octree import from_points, to_points
    >>> octree = from_points([[1, 2, 3], [9, 9, 9]], [7, 8], depth=4)
    >>> to_points(solid_box(octree, (1, 1, 1), (6, 6, 6), words=100, octants=100))
    (array([[0, 1, 2]], dtype=int32), array([1], dtype=uint8))
    """
    start, end = as_box(low, high)
    sides = [above - below for below, above in zip(start, end, strict=True)]
    if min(sides) < 1:
        raise ValueError(f"the box from {start} to {end} is empty; its end is one behind the highest voxel")
    if max(sides) > _MOST_SIDE:
        raise ValueError(f"a box of {' x '.join(map(str, sides))} voxels is too large; make it smaller")
    try:
        if isinstance(source, World):
            found, depth = source.native.solid_box(start, end, octants)
        else:
            found, depth = _native.solid_box(source.words, source.depth, start, end, octants)
    except ValueError as error:
        raise ValueError(f"{error}; make it smaller") from error
    if len(found) > words:
        raise ValueError(f"the box takes {len(found):,} words, and {words:,} are the most; make it smaller")
    return Octree(depth, found)
