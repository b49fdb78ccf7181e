"""The octants as corners and sides, in NumPy alone: what files and PyVista's cells are made of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.octree.leaf_arrays import Leaves
from voxrt.octree.octant import addresses
from voxrt.view.sides import covered_sides

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Owners, Rom
    from voxrt.octree.query import Corner

SIDES = np.array([[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]])
"""The corners of each side, counter-clockwise from outside; corners count as octants do."""


class OctantMesh(Struct, frozen=True, eq=False):
    """Some solid octants of a memory.

    Attributes
    ----------
    points
        float32, shape (P, 3): their corners, each once, voxels, grid frame.
    corners
        int64, shape (N, 8): rows of `points`; corners count as octants do.
    levels
        uint8, shape (N,): log2 of the side in voxels.
    materials
        uint8, shape (N,): material ids.
    addresses
        uint32, shape (N,): addresses of their words.
    open_sides
        uint8, shape (N,): bit i is set if side i (low and high on x, y, z) is not covered by other octants.
    hidden
        How many octants were left out because others cover all of their sides.
    owners
        int16, shape (N,), as :meth:`voxrt.octree.Owners.of` returns it; None if they are not known.
    """

    points: NDArray[np.float32]
    corners: NDArray[np.int64]
    levels: NDArray[np.uint8]
    materials: NDArray[np.uint8]
    addresses: NDArray[np.uint32]
    open_sides: NDArray[np.uint8]
    hidden: int
    owners: NDArray[np.int16] | None = None

    def sides(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the sides that can be seen, and the octant of each (int64, shape (S,)).

        The sides are int64, shape (S, 4): rows of `points`, counter-clockwise seen from outside.
        """
        octants, sides = np.nonzero(self.open_sides[:, None] >> np.arange(6) & 1)
        return self.corners[octants[:, None], SIDES[sides]], octants


def octant_mesh(
    rom: Rom,
    solid: Leaves,
    box: tuple[Corner, Corner] | None = None,
    *,
    surface: bool = True,
    owners: Owners | None = None,
) -> OctantMesh:
    """Make the mesh of some solid leaves of a memory, both in Morton order.

    The octants are cut at the corners of `box`; None leaves them whole. `surface` leaves out octants that the others
    cover on all six sides. `owners` are those of the voxels, of the same grid.
    """
    covered = covered_sides(solid)
    shown = ~covered.all(axis=1) if surface else np.ones(len(solid.levels), np.bool_)
    some = Leaves(solid.corners[shown], solid.levels[shown], solid.materials[shown])
    points, corners = _corners(some, box)
    return OctantMesh(
        points=points,
        corners=corners,
        levels=some.levels,
        materials=some.materials,
        addresses=addresses(rom.octree, some),
        open_sides=(~covered[shown] @ (np.uint8(1) << np.arange(6, dtype=np.uint8))).astype(np.uint8),
        hidden=int(np.count_nonzero(~shown)),
        owners=None if owners is None else owners.of(some),
    )


def _corners(some: Leaves, box: tuple[Corner, Corner] | None) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Return the corners, each once (float32, shape (P, 3)), and those of each octant by index (shape (N, 8)).

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
