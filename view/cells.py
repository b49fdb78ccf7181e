"""The octants as the cells of one unstructured grid, for PyVista: an optional dependency, ``voxrt-build[view]``."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.leaf_arrays import Leaves, solid_leaves
from voxrt.octree.octant import addresses
from voxrt.view.errors import ViewerError
from voxrt.view.sides import covered_sides

if TYPE_CHECKING:
    from types import ModuleType

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree.owners import Owners
    from voxrt.octree.query import Corner
    from voxrt.octree.rom import Rom


_SIDES = np.array([[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]])
"""The corners of each side, counter-clockwise from outside; corners count as octants do."""


def octants(
    rom: Rom,
    low: Corner = (0, 0, 0),
    high: Corner | None = None,
    *,
    surface: bool = True,
    cut: bool = False,
    owners: Owners | None = None,
) -> pyvista.UnstructuredGrid:
    """Give the solid octants of a memory as cells.

    Parameters
    ----------
    rom
        The memory and its materials.
    low, high
        Only octants that overlap the voxels from `low` up to and without `high` (default: the world's end), whole.
    surface
        Leave out octants that the others cover on all six sides.
    cut
        Cut the octants at `low` and `high`.
    owners
        Whose the voxels are, of the same grid.

    Returns
    -------
    pyvista.UnstructuredGrid
        Cells of type ``VTK_VOXEL`` in Morton order, in voxels, grid frame. Cell data: ``material`` (uint8, id),
        ``level`` (uint8, log2 of the side in voxels), ``address`` (uint32, of the octant's word), ``open`` (uint8, bit
        i: side i, low and high on x, y, z, is not covered by others), ``colour`` (uint8, shape (N, 3), sRGB); with
        `owners` also ``owner`` (int16, as :meth:`Owners.of` tells it). Field data: ``hidden`` (int64, shape (1,)), how
        many octants were left out.

    Raises
    ------
    ViewerError
        PyVista is not installed, or cannot be loaded.
    DoesNotFitError
        More than :data:`~voxrt.octree.leaf_arrays.LEAF_LIMIT` octants.
    """
    end = (rom.octree.size,) * 3 if high is None else high
    solid = solid_leaves(rom.octree, low, end)
    return octant_cells(rom, solid, (low, end) if cut else None, surface=surface, owners=owners)


def octant_cells(
    rom: Rom,
    solid: Leaves,
    box: tuple[Corner, Corner] | None = None,
    *,
    surface: bool = True,
    owners: Owners | None = None,
) -> pyvista.UnstructuredGrid:
    """Give some solid leaves of a memory as cells, cut at a box, as :func:`octants` does."""
    pv = import_pyvista()
    covered = covered_sides(solid)
    shown = ~covered.all(axis=1) if surface else np.ones(len(solid.levels), np.bool_)
    some = Leaves(solid.corners[shown], solid.levels[shown], solid.materials[shown])
    points, cells = _corners(some, box)
    grid = pv.UnstructuredGrid(
        np.insert(cells, 0, 8, axis=1).ravel(), np.full(len(cells), pv.CellType.VOXEL, np.uint8), points
    )
    grid.cell_data["material"] = some.materials
    grid.cell_data["level"] = some.levels
    grid.cell_data["address"] = addresses(rom.octree, some)
    grid.cell_data["open"] = ~covered[shown] @ (np.uint8(1) << np.arange(6, dtype=np.uint8))
    if len(cells):  # PyVista takes no empty table
        grid.cell_data["colour"] = np.array([material.colour for material in rom.materials], np.uint8)[some.materials]
    if owners is not None:
        grid.cell_data["owner"] = owners.of(some)
    grid.field_data["hidden"] = np.array([np.count_nonzero(~shown)], np.int64)
    return grid


def open_sides(grid: pyvista.UnstructuredGrid) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Give the sides of octants that are not covered: what can be seen of them.

    Returns
    -------
    tuple
        The sides (shape (S, 4), rows of the grid's points, counter-clockwise from outside), and each one's cell.
    """
    corners = np.asarray(grid.cells, np.int64).reshape(-1, 9)[:, 1:]
    cells, sides = np.nonzero(np.asarray(grid.cell_data["open"])[:, None] >> np.arange(6) & 1)
    return corners[cells[:, None], _SIDES[sides]], cells


def import_pyvista() -> ModuleType:
    """Import PyVista, or say how to install it.

    Raises
    ------
    ViewerError
        It is not installed, or its VTK cannot be loaded.
    """
    try:
        return import_module("pyvista")  # it and VTK are large, and optional
    except ModuleNotFoundError as error:
        raise ViewerError(
            "showing octants needs PyVista, which is not installed; pip install 'voxrt-build[view]'"
        ) from error
    except ImportError as error:
        raise ViewerError(f"PyVista cannot be loaded: {error}; on Debian apt install libgl1 libxrender1") from error


def _corners(some: Leaves, box: tuple[Corner, Corner] | None) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Give the corners, each once (float32, shape (P, 3)), and those of each octant by index (shape (N, 8)).

    Octants that share corners share whole sides too, which VTK then need not draw.
    """
    offsets = np.arange(8)[:, None] >> np.arange(3) & 1  # VTK_VOXEL counts corners as the octree does octants
    corners = some.corners[:, None, :] + (offsets << some.levels.astype(np.int64)[:, None, None])
    if box is not None:
        corners = np.clip(corners, *box)
    keys = corners @ (np.int64(1) << np.array([0, 17, 34]))  # 0 ... 2**16 each
    unique, cells = np.unique(keys, return_inverse=True)
    points = unique[:, None] >> np.array([0, 17, 34]) & 0x1FFFF
    return points.astype(np.float32), cells.reshape(-1, 8)
