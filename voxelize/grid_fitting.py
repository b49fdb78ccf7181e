"""Fitting a grid to a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import arguments
from voxrt.voxelize.box_rounding import POW2_CHOICES, UNITS_PER_VOXEL, box_in_voxels, keeps_axes, round_box
from voxrt.voxelize.collider_shapes import BoxCollider, bounding_points
from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.grid import DEPTH_LIMIT, Grid
from voxrt.voxelize.object_proxies import GEOMETRIES, proxies
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.mesh import Mesh
    from voxrt.voxelize.object_proxies import Geometry


def fit_grid(
    scene: Scene,
    *,
    depth: int | None = None,
    voxel_size: float | None = None,
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
    bounds: tuple[Sequence[float], Sequence[float]] | None = None,
) -> Grid:
    """Fit the smallest grid to a scene: its lowest corner is the lowest corner of what will be voxelized.

    Parameters
    ----------
    scene
        The scene to voxelize.
    depth
        Levels of the octree, 1 … 16. The voxels are as small as the scene's longest side allows.
    voxel_size
        Metres per voxel. The depth is the least that holds the scene and its rounded boxes.
    geometry, pow2
        As for :func:`voxrt.voxelize.voxelize`.
    bounds
        The lowest and the highest corner of what the grid holds, metres, scene frame; None for the scene's own.

    Returns
    -------
    Grid
        The grid, in the scene frame.

    Raises
    ------
    TypeError, ValueError
        Not exactly one of `depth` and `voxel_size`, or an argument of the wrong kind or range.
    AssetError
        The scene has nothing to voxelize, or a coordinate that is not finite.
    DoesNotFitError
        The scene needs more than 2**16 voxels per side.

    Examples
    --------
    >>> from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject, fit_grid
    >>> mesh = Mesh([[0, 0, 0], [4, 0, 0], [0, 2, 1]], [[0, 1, 2]], [1])
    >>> scene = Scene("sail", [SceneObject("sail", mesh)], [EMPTY, Material("cloth", (240, 240, 230))])
    >>> fit_grid(scene, depth=5)
    Grid(depth=5, origin=(0.0, 0.0, 0.0), voxel_size=0.125)
    >>> fit_grid(scene, voxel_size=0.5).size
    8
    """
    arguments.instance("scene", scene, Scene)
    arguments.choice("geometry", geometry, GEOMETRIES)
    arguments.choice("pow2", pow2, POW2_CHOICES)
    if (depth is None) == (voxel_size is None):
        raise ValueError("fit_grid needs one of depth and voxel_size: pass one, leave out the other")
    if depth is not None:
        depth = arguments.whole("depth", depth, 1, DEPTH_LIMIT)
    if voxel_size is not None:
        voxel_size = arguments.real("voxel_size", voxel_size, above=0)
    low, high = scene_bounds(scene, geometry) if bounds is None else _checked_bounds(bounds)
    longest = float((high - low).max())
    if not np.isfinite(longest):
        raise AssetError(scene.name, "the scene's size overflows float64", fix="scale it down")
    origin = (float(low[0]), float(low[1]), float(low[2]))
    if depth is not None:
        fitted = longest / 2**depth
        return Grid(depth, origin, fitted if fitted > 0 else 1.0)
    assert voxel_size is not None
    voxels = longest / voxel_size
    if voxels < 2**DEPTH_LIMIT + 1:
        voxels = round(voxels * UNITS_PER_VOXEL) / UNITS_PER_VOXEL
    if voxels > 2**DEPTH_LIMIT:
        raise DoesNotFitError(
            f"{scene.name}: needs {voxels:.0f} voxels per side, and {2**DEPTH_LIMIT} are the most; "
            f"use a voxel size of {longest / 2**DEPTH_LIMIT:.6g} m or more"
        )
    fitted_depth = max(1, int(np.ceil(np.log2(voxels)))) if voxels > 1 else 1
    grid = Grid(fitted_depth, origin, voxel_size)
    if bounds is None and pow2 == "box" and grid.depth < DEPTH_LIMIT and _rounding_overflows(scene, grid, geometry):
        return Grid(fitted_depth + 1, origin, voxel_size)
    return grid


def _checked_bounds(bounds: object) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    corners = arguments.real_array("bounds", bounds, (2, 3)).astype(np.float64, copy=False)
    if not (corners[0] < corners[1]).all():
        raise ValueError(f"bounds must be a lowest and a highest corner, not {corners[0]} and {corners[1]}")
    return corners[0], corners[1]


def scene_bounds(scene: Scene, geometry: Geometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the lowest and the highest corner of what will be voxelized: float64, shape (3,), scene frame.

    Raises
    ------
    AssetError
        Nothing to voxelize, or a coordinate that is not finite.
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
        hidden = sum(item.hidden for item in scene.objects)
        fix = f"{hidden} objects are hidden: use geometry collider for their colliders" if hidden else ""
        raise AssetError(scene.name, "nothing to voxelize: no triangles and no colliders", fix=fix)
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        raise AssetError(scene.name, "a coordinate is infinite", fix="repair the mesh or its transform")
    return low, high


def _instances(scene: Scene, geometry: Geometry) -> list[tuple[NDArray[np.floating], list[NDArray[np.float64]]]]:
    """Return the point clouds of a scene (shape (V, 3), V > 0), each with the transforms that place it."""
    clouds: dict[int, tuple[object, NDArray[np.floating], list[NDArray[np.float64]]]] = {}

    def place(key: object, points: Callable[[], NDArray[np.floating]], transform: NDArray[np.float64]) -> None:
        if id(key) not in clouds:
            clouds[id(key)] = (key, points(), [])  # an id is unique only while its object lives
        clouds[id(key)][2].append(transform)

    for item in scene.objects:
        colliders = proxies(item, geometry)
        if colliders is None:
            mesh = item.mesh
            place(mesh, lambda mesh=mesh: _used(mesh), item.transform)  # type: ignore[misc]
        for collider in colliders or ():
            place(collider, lambda collider=collider: bounding_points(collider), item.transform)  # type: ignore[misc]
    return [(points, transforms) for _, points, transforms in clouds.values() if len(points) > 0]


def _used(mesh: Mesh) -> NDArray[np.floating]:
    """Return the vertices that triangles use."""
    used = np.zeros(len(mesh.positions), np.bool_)
    used[mesh.triangles.reshape(-1).astype(np.intp)] = True  # twice as fast as indices of 32 bits
    return mesh.positions if used.all() else mesh.positions[used]


def _rounding_overflows(scene: Scene, grid: Grid, geometry: Geometry) -> bool:
    """Tell whether a box that is rounded without regard to the grid would reach beyond it."""
    return any(
        bool((round_box(*box_in_voxels(item, collider, grid)).high > grid.size).any())
        for item in scene.objects
        for collider in proxies(item, geometry) or ()
        if isinstance(collider, BoxCollider) and collider.pow2 and keeps_axes(item.transform)
    )
