"""The octants as the cells of one unstructured grid, for PyVista: an optional dependency, ``voxrt[view]``."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.errors import ViewerError
from voxrt.octree.hidden import hidden_leaves
from voxrt.octree.leaves import Leaves, leaves
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from types import ModuleType

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree.query import Corner
    from voxrt.octree.rom import Rom

OCTANT_LIMIT = 1 << 24
"""The most solid octants that are taken into a grid."""


def octants(
    rom: Rom, low: Corner = (0, 0, 0), high: Corner | None = None, *, surface: bool = True
) -> pyvista.UnstructuredGrid:
    """Give the solid octants of a memory as cells.

    Parameters
    ----------
    rom
        The memory and its materials.
    low, high
        Only octants that overlap the voxels from `low` up to and without `high` (default: the world's end), whole.
    surface
        Leave out octants that the others enclose, edges and corners included.

    Returns
    -------
    pyvista.UnstructuredGrid
        Cells of type ``VTK_VOXEL`` in Morton order, in voxels, grid frame. Cell data: ``material`` (uint8, id),
        ``level`` (uint8, log2 of the side in voxels), ``colour`` (uint8, shape (N, 3), sRGB). Field data: ``hidden``
        (int64, shape (1,)), how many octants were left out.

    Raises
    ------
    ViewerError
        PyVista is not installed.
    DoesNotFitError
        More than :data:`OCTANT_LIMIT` octants.
    """
    pv = import_pyvista()
    solid = _collect(rom, low, high)
    shown = ~hidden_leaves(solid) if surface else np.ones(len(solid.levels), np.bool_)
    materials, levels = solid.materials[shown], solid.levels[shown]
    points, cells = _corners(solid.corners[shown], levels)
    grid = pv.UnstructuredGrid(
        np.insert(cells, 0, 8, axis=1).ravel(), np.full(len(cells), pv.CellType.VOXEL, np.uint8), points
    )
    grid.cell_data["material"] = materials
    grid.cell_data["level"] = levels
    if len(materials):  # PyVista takes no empty table
        grid.cell_data["colour"] = np.array([material.colour for material in rom.materials], np.uint8)[materials]
    grid.field_data["hidden"] = np.array([np.count_nonzero(~shown)], np.int64)
    return grid


def import_pyvista() -> ModuleType:
    """Import PyVista, or say how to install it.

    Raises
    ------
    ViewerError
        It is not installed.
    """
    try:
        return import_module("pyvista")  # it and VTK are large, and optional
    except ImportError as error:
        raise ViewerError("showing octants needs PyVista, which is not installed; pip install 'voxrt[view]'") from error


def _collect(rom: Rom, low: Corner, high: Corner | None) -> Leaves:
    chunks, count = [Leaves(np.zeros((0, 3), np.int32), np.zeros(0, np.uint8), np.zeros(0, np.uint8))], 0
    for chunk in leaves(rom.octree, low, high, solid_only=True):
        count += len(chunk.levels)
        if count > OCTANT_LIMIT:
            raise DoesNotFitError(
                f"{rom.name}: more than {OCTANT_LIMIT} octants cannot be shown; show a part, or coarser octants"
            )
        chunks.append(chunk)
    return Leaves(
        np.concatenate([chunk.corners for chunk in chunks]),
        np.concatenate([chunk.levels for chunk in chunks]),
        np.concatenate([chunk.materials for chunk in chunks]),
    )


def _corners(lowest: NDArray[np.int32], levels: NDArray[np.uint8]) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Give the corners, each once (float32, shape (P, 3)), and those of each octant by index (shape (N, 8)).

    Octants that share corners share whole sides too, which VTK then need not draw.
    """
    offsets = np.arange(8)[:, None] >> np.arange(3) & 1  # VTK_VOXEL counts corners as the octree does octants
    corners = lowest[:, None, :] + (offsets << levels.astype(np.int64)[:, None, None])
    keys = corners @ (np.int64(1) << np.array([0, 17, 34]))  # 0 ... 2**16 each
    unique, cells = np.unique(keys, return_inverse=True)
    points = unique[:, None] >> np.array([0, 17, 34]) & 0x1FFFF
    return points.astype(np.float32), cells.reshape(-1, 8)
