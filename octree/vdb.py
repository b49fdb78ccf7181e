"""OpenVDB grids to octrees, by the grid's own iterators: a tile of equal voxels is one step of them.

Works with any module that has OpenVDB's Python interface (``openvdb``, ``pyopenvdb``), and imports none.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Protocol

import numpy as np

from voxrt.octree.construct import from_points
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from voxrt.octree.query import Corner

_VOXEL_LIMIT = 1 << 24
_LEVEL_SET = "level set"


class VdbValue(Protocol):
    """A voxel or a tile of a grid: `value` from index coordinates `min` to `max`, both within."""

    min: Corner
    max: Corner
    value: float


class VdbGrid(Protocol):
    """What is needed of an OpenVDB grid."""

    gridClass: str  # noqa: N815 - OpenVDB's name

    def citerOnValues(self) -> Iterable[VdbValue]:  # noqa: N802
        """Give active voxels and tiles."""

    def citerOffValues(self) -> Iterable[VdbValue]:  # noqa: N802
        """Give inactive voxels and tiles."""


def from_vdb(grid: VdbGrid) -> tuple[Octree, Corner]:
    """Build the octree of an OpenVDB grid.

    Parameters
    ----------
    grid
        A level set is solid (material 1) where it is negative. The active values of a grid of integers are material
        ids, 0 … 255. Any other grid of numbers or booleans is solid (material 1) where it is active and above zero.

    Returns
    -------
    tuple[Octree, Corner]
        The octree, whose axes are the grid's, and the index coordinates of its voxel (0, 0, 0). The world is the
        smallest that holds what is solid.

    Raises
    ------
    ValueError
        Nothing is solid, an integer is no material id, or the grid holds vectors.
    DoesNotFitError
        More than 2**24 voxels are solid, or they reach over more than 2**16 voxels.

    Examples
    --------
    With OpenVDB: ``octree, corner = from_vdb(openvdb.read("smoke.vdb", "density"))``. Any object with its iterators
    does:

    >>> from types import SimpleNamespace
    >>> tile = SimpleNamespace(min=(8, 0, 0), max=(15, 7, 7), value=3)
    >>> grid = SimpleNamespace(gridClass="unknown", citerOnValues=lambda: [tile])
    >>> from_vdb(grid)
    (<Octree: depth 3, 1 words>, (8, 0, 0))
    """
    boxes, materials = _solid_boxes(grid)
    if not boxes:
        raise ValueError("nothing in the OpenVDB grid is solid")
    corners = np.array(boxes, dtype=np.int64)
    low, high = corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)
    sides = corners[:, 1] - corners[:, 0] + 1
    depth = max(1, (int((high - low).max())).bit_length())
    counts = sides.prod(axis=1)
    if depth > MAX_DEPTH or int(counts.sum()) > _VOXEL_LIMIT:
        raise DoesNotFitError(
            f"an OpenVDB grid of {int(counts.sum())} solid voxels, {int((high - low).max()) + 1} from end to end, is "
            f"more than {_VOXEL_LIMIT} or {1 << MAX_DEPTH}; resample it with larger voxels"
        )
    box = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(box)) - np.repeat(np.cumsum(counts) - counts, counts)
    width, height = sides[box, 0], sides[box, 1]
    places = np.stack([number % width, number // width % height, number // (width * height)], axis=1)
    points = corners[box, 0] - low + places
    x, y, z = low.tolist()
    return from_points(points, np.array(materials, dtype=np.int64)[box], depth), (x, y, z)


def _solid_boxes(grid: VdbGrid) -> tuple[list[tuple[Corner, Corner]], list[int]]:
    level_set = grid.gridClass == _LEVEL_SET
    # The inside of a level set, beyond its narrow band, is inactive.
    values = chain(grid.citerOnValues(), grid.citerOffValues()) if level_set else grid.citerOnValues()
    boxes: list[tuple[Corner, Corner]] = []
    materials = []
    for item in values:
        value = item.value
        if isinstance(value, tuple | list):
            raise ValueError("an OpenVDB grid of vectors is no solid; give a level set, or a grid of material ids")  # noqa: TRY004
        is_id = isinstance(value, int) and not isinstance(value, bool)
        if is_id and not 0 <= value <= 255:
            raise ValueError(f"{value} at {tuple(item.min)} of the OpenVDB grid is no material id; ids are 0 ... 255")
        if value < 0 if level_set else value > 0:
            boxes.append((item.min, item.max))
            materials.append(int(value) if is_id else 1)
    return boxes, materials
