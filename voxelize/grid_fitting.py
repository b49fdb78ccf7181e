"""Fitting a grid to a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.box_rounding import POW2_CHOICES, UNITS_PER_VOXEL, box_in_voxels, keeps_axes, round_box
from voxrt.voxelize.collider_shapes import BoxCollider, bounding_points
from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.grid import DEPTH_LIMIT, Grid
from voxrt.voxelize.object_proxies import GEOMETRIES, proxies
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import TypeAlias

    from numpy.typing import NDArray

    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.object_proxies import Geometry

    Corner: TypeAlias = tuple[float, float, float]


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
    try:
        longest = _native.longest_side(low, high)
        if depth is not None:
            origin, fitted = _native.fit_grid(low, high, depth)
            return Grid(depth, origin, fitted)
    except _native.UnfitSceneError as error:
        problem, fix = error.args
        raise AssetError(scene.name, problem, fix=fix) from None
    assert voxel_size is not None
    voxels = longest / voxel_size
    if voxels < 2**DEPTH_LIMIT + 1:
        voxels = round(voxels * UNITS_PER_VOXEL) / UNITS_PER_VOXEL
    if voxels > 2**DEPTH_LIMIT:
        raise DoesNotFitError(
            f"{scene.name}: needs {voxels:.9g} voxels per side, and {2**DEPTH_LIMIT} are the most; "
            f"use a voxel size of {longest / 2**DEPTH_LIMIT:.6g} m or more"
        )
    fitted_depth = max(1, int(np.ceil(np.log2(voxels)))) if voxels > 1 else 1
    grid = Grid(fitted_depth, low, voxel_size)
    if bounds is None and pow2 == "box" and grid.depth < DEPTH_LIMIT and _rounding_overflows(scene, grid, geometry):
        return Grid(fitted_depth + 1, low, voxel_size)
    return grid


def _checked_bounds(bounds: object) -> tuple[Corner, Corner]:
    corners = arguments.real_array("bounds", bounds, (2, 3)).astype(np.float64, copy=False)
    if not (corners[0] < corners[1]).all():
        raise ValueError(f"bounds must be a lowest and a highest corner, not {corners[0]} and {corners[1]}")
    low, high = (tuple(corner) for corner in corners.tolist())
    return low, high


def scene_bounds(scene: Scene, geometry: Geometry) -> tuple[Corner, Corner]:
    """Return the lowest and the highest corner of what will be voxelized, metres, scene frame.

    Raise AssetError where there is nothing to voxelize, or a coordinate is not finite.
    """
    try:
        return _native.scene_bounds(_clouds(scene, geometry), sum(item.hidden for item in scene.objects))
    except _native.UnfitSceneError as error:
        problem, fix = error.args
        raise AssetError(scene.name, problem, fix=fix) from None


_NO_TRIANGLES = np.empty((0, 3), np.int32)


def _clouds(scene: Scene, geometry: Geometry) -> list[_native.Cloud]:
    """Return the points of a scene, the triangles whose vertices count, and the transforms that place them."""
    clouds: dict[int, tuple[object, NDArray[np.floating], NDArray[np.int32], list[NDArray[np.float64]]]] = {}

    def place(
        key: object,
        points: Callable[[], tuple[NDArray[np.floating], NDArray[np.int32]]],
        transform: NDArray[np.float64],
    ) -> None:
        if id(key) not in clouds:
            clouds[id(key)] = (key, *points(), [])  # an id is unique only while its object lives
        clouds[id(key)][3].append(transform[:3])

    for item in scene.objects:
        colliders = proxies(item, geometry)
        mesh = item.mesh
        if colliders is None and item.points is not None:
            place(item.points, lambda one=item.points: (one.positions, _NO_TRIANGLES), item.transform)  # type: ignore[misc]
        elif colliders is None and len(mesh.triangles):
            place(mesh, lambda mesh=mesh: (mesh.positions, mesh.triangles), item.transform)  # type: ignore[misc]
        for collider in colliders or ():
            bare = lambda one=collider: (bounding_points(one), _NO_TRIANGLES)  # noqa: E731 - its type is known
            place(collider, bare, item.transform)
    return [
        (np.ascontiguousarray(points), np.ascontiguousarray(triangles, np.int32), np.stack(transforms))
        for _, points, triangles, transforms in clouds.values()
        if len(points) > 0
    ]


def _rounding_overflows(scene: Scene, grid: Grid, geometry: Geometry) -> bool:
    """Tell whether a box that is rounded without regard to the grid would reach beyond it."""
    return any(
        bool((round_box(*box_in_voxels(item, collider, grid)).high > grid.size).any())
        for item in scene.objects
        for collider in proxies(item, geometry) or ()
        if isinstance(collider, BoxCollider) and collider.pow2 and keeps_axes(item.transform)
    )
