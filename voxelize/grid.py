"""The grid of voxels and where it stands in the scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colliders import (
    UNITS_PER_VOXEL,
    box_in_voxels,
    corner_points,
    keeps_axes,
    round_box,
    stand_ins,
)
from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.scene import BoxCollider

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from voxrt.voxelize.colliders import Geometry, Pow2
    from voxrt.voxelize.scene import Mesh, Scene

DEPTH_LIMIT = 16
"""The deepest octree: 65536 voxels a side."""


@dataclass(frozen=True, slots=True)
class Grid:
    """A cube of 2**depth voxels a side. Its axes are the scene's axes: no swap, no mirror.

    Attributes
    ----------
    depth
        Levels of the octree, 1 … 16.
    origin
        Scene position (metres) of the lowest corner of voxel (0, 0, 0).
    voxel_size
        Metres a voxel.
    """

    depth: int
    origin: tuple[float, float, float]
    voxel_size: float

    @property
    def size(self) -> int:
        """Voxels a side."""
        return 1 << self.depth


def fit_grid(
    scene: Scene,
    *,
    depth: int | None = None,
    voxel_size: float | None = None,
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
) -> Grid:
    """Fit the smallest grid to a scene: its lowest corner is the lowest corner of what will be voxelized.

    Parameters
    ----------
    scene
        What is to be voxelized.
    depth
        Levels of the octree, 1 … 16; the voxels are as small as the scene's longest side allows.
    voxel_size
        Metres a voxel; the depth is the least that holds the scene, and the boxes rounded with `pow2`.
    geometry, pow2
        As for :func:`voxrt.voxelize.voxelize`.

    Raises
    ------
    ValueError
        Not exactly one of `depth` and `voxel_size`, or one out of range.
    AssetError
        The scene has nothing to voxelize, or coordinates that are no numbers.
    DoesNotFitError
        The scene needs more than 2**16 voxels a side.
    """
    if (depth is None) == (voxel_size is None):
        raise ValueError("give either depth or voxel_size")
    if depth is not None and not 1 <= depth <= DEPTH_LIMIT:
        raise ValueError(f"depth must be 1 … {DEPTH_LIMIT}, not {depth}")
    if voxel_size is not None and not (np.isfinite(voxel_size) and voxel_size > 0):
        raise ValueError(f"voxel_size must be a positive number of metres, not {voxel_size}")

    low, high = scene_bounds(scene, geometry)
    longest = float((high - low).max())
    if not np.isfinite(longest):
        raise AssetError(scene.name, "the scene is larger than a number can say", fix="scale it down")
    origin = (float(low[0]), float(low[1]), float(low[2]))
    if depth is not None:
        fitted = longest / 2**depth
        return Grid(depth, origin, fitted if fitted > 0 else 1.0)
    assert voxel_size is not None
    voxels = round(longest / voxel_size * UNITS_PER_VOXEL) / UNITS_PER_VOXEL
    if voxels > 2**DEPTH_LIMIT:
        raise DoesNotFitError(
            f"{scene.name}: {voxels:.0f} voxels a side are more than {2**DEPTH_LIMIT}; "
            f"the least voxel size is {longest / 2**DEPTH_LIMIT:.6g} m"
        )
    fitted_depth = max(1, int(np.ceil(np.log2(voxels)))) if voxels > 1 else 1
    grid = Grid(fitted_depth, origin, voxel_size)
    if pow2 == "box" and grid.depth < DEPTH_LIMIT and _rounding_leaves(scene, grid, geometry):
        return Grid(fitted_depth + 1, origin, voxel_size)
    return grid


def scene_bounds(scene: Scene, geometry: Geometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the lowest and the highest corner of what will be voxelized (float64, shape (3,), scene frame).

    Raises
    ------
    AssetError
        Nothing to voxelize, or coordinates that are no numbers.
    """
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for points, transforms in _instances(scene, geometry):
        step = max(1, 1_000_000 // len(points))
        for first in range(0, len(transforms), step):
            stack = np.stack(transforms[first : first + step])
            with np.errstate(over="ignore", invalid="ignore"):
                for axis in range(3):
                    row = stack[:, axis, :, None]
                    reach = row[:, 0] * points[:, 0] + row[:, 1] * points[:, 1] + row[:, 2] * points[:, 2] + row[:, 3]
                    low[axis] = np.minimum(low[axis], reach.min())
                    high[axis] = np.maximum(high[axis], reach.max())
    if np.isnan(low).any() or np.isnan(high).any():
        raise AssetError(scene.name, "a coordinate is not a number", fix="repair the mesh or its transform")
    if not (low <= high).all():
        raise AssetError(scene.name, "nothing to voxelize: no triangles and no colliders")
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        raise AssetError(scene.name, "a coordinate is infinite", fix="repair the mesh or its transform")
    return low, high


def _instances(scene: Scene, geometry: Geometry) -> list[tuple[NDArray[np.floating], list[NDArray[np.float64]]]]:
    """Give the point clouds of a scene (shape (V, 3), V > 0), each with the transforms that place it."""
    clouds: dict[int, tuple[object, NDArray[np.floating], list[NDArray[np.float64]]]] = {}

    def place(key: object, points: Callable[[], NDArray[np.floating]], transform: NDArray[np.float64]) -> None:
        if id(key) not in clouds:
            clouds[id(key)] = (key, points(), [])  # an id is unique only while its object lives
        clouds[id(key)][2].append(transform)

    for item in scene.objects:
        colliders = stand_ins(item, geometry)
        if colliders is None:
            mesh = item.mesh
            place(mesh, lambda mesh=mesh: _used(mesh), item.transform)  # type: ignore[misc]
        for collider in colliders or ():
            place(collider, lambda collider=collider: corner_points(collider), item.transform)  # type: ignore[misc]
    return [(points, transforms) for _, points, transforms in clouds.values() if len(points) > 0]


def _used(mesh: Mesh) -> NDArray[np.floating]:
    """Return the vertices that triangles use."""
    used = np.zeros(len(mesh.positions), np.bool_)
    used[mesh.triangles.reshape(-1).astype(np.intp)] = True  # twice as fast as indices of 32 bits
    return mesh.positions if used.all() else mesh.positions[used]


def _rounding_leaves(scene: Scene, grid: Grid, geometry: Geometry) -> bool:
    """Tell whether a box rounded without regard to the grid's rim would leave the grid."""
    endless = Grid(31, grid.origin, grid.voxel_size)
    return any(
        bool((round_box(*box_in_voxels(item, collider, grid), endless).high > grid.size).any())
        for item in scene.objects
        for collider in stand_ins(item, geometry) or ()
        if isinstance(collider, BoxCollider) and collider.pow2 and keeps_axes(item.transform)
    )
