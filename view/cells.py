"""The octants as the cells of one unstructured grid, for PyVista: an optional dependency."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.leaf_arrays import solid_leaves
from voxrt.view.errors import ViewerError
from voxrt.view.octant_mesh import SIDES, octant_mesh

if TYPE_CHECKING:
    from types import ModuleType

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree.leaf_arrays import Leaves
    from voxrt.octree.owners import Owners
    from voxrt.octree.query import Corner
    from voxrt.octree.rom import Rom


def octants(
    rom: Rom,
    low: Corner = (0, 0, 0),
    high: Corner | None = None,
    *,
    surface: bool = True,
    cut: bool = False,
    owners: Owners | None = None,
) -> pyvista.UnstructuredGrid:
    """Return the solid octants of a memory as cells.

    Parameters
    ----------
    rom
        The memory and its materials.
    low, high
        Integers (x, y, z): the lowest voxel, and one behind the highest (default: the world's end). Octants that
        overlap this box are returned, whole.
    surface
        Leave out octants that the others cover on all six sides.
    cut
        Cut the octants at `low` and `high`.
    owners
        The owners of the voxels, of the same grid.

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

    Examples
    --------
    >>> import voxrt
    >>> grid = octants(voxrt.build("examples/house.obj", depth=4).rom)
    >>> grid.n_cells > 100, sorted(grid.cell_data.keys())
    (True, ['address', 'colour', 'level', 'material', 'open'])
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
    """Return some solid leaves of a memory as cells, cut at a box, as :func:`octants` does."""
    pv = import_pyvista()
    mesh = octant_mesh(rom, solid, box, surface=surface, owners=owners)
    count = len(mesh.levels)
    grid = pv.UnstructuredGrid(
        np.insert(mesh.corners, 0, 8, axis=1).ravel(), np.full(count, pv.CellType.VOXEL, np.uint8), mesh.points
    )
    grid.cell_data["material"] = mesh.materials
    grid.cell_data["level"] = mesh.levels
    grid.cell_data["address"] = mesh.addresses
    grid.cell_data["open"] = mesh.open_sides
    if count:  # PyVista takes no empty table
        grid.cell_data["colour"] = np.array([material.colour for material in rom.materials], np.uint8)[mesh.materials]
    if mesh.owners is not None:
        grid.cell_data["owner"] = mesh.owners
    grid.field_data["hidden"] = np.array([mesh.hidden], np.int64)
    return grid


def open_sides(grid: pyvista.UnstructuredGrid) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the sides of octants that others do not cover.

    Parameters
    ----------
    grid
        What :func:`octants` returned.

    Returns
    -------
    quads
        int64, shape (S, 4): rows of the grid's points, counter-clockwise seen from outside.
    cells
        int64, shape (S,): the cell of each.

    Examples
    --------
    >>> import voxrt
    >>> quads, cells = open_sides(octants(voxrt.build("examples/house.obj", depth=4).rom))
    >>> quads.shape == (len(cells), 4)
    True
    """
    corners = np.asarray(grid.cells, np.int64).reshape(-1, 9)[:, 1:]
    cells, sides = np.nonzero(np.asarray(grid.cell_data["open"])[:, None] >> np.arange(6) & 1)
    return corners[cells[:, None], SIDES[sides]], cells


def import_pyvista() -> ModuleType:
    """Import PyVista; ViewerError where it is not installed, or its VTK cannot be loaded."""
    try:
        return import_module("pyvista")  # it and VTK are large, and optional
    except ModuleNotFoundError as error:
        raise ViewerError("this needs PyVista, which is not installed; pip install pyvista") from error
    except ImportError as error:
        raise ViewerError(f"PyVista cannot be loaded: {error}; on Debian apt install libgl1 libxrender1") from error
