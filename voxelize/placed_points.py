"""Point clouds on a grid: the voxels that hold enough points become meshes, which build as any others do.

Coordinates are rounded to 1/4096 voxel. A voxel has the points at or above its lowest corner and below its highest.
Its colour is the median of its points' colours, channel by channel; of an even number, the lesser of the two in the
middle. So nothing depends on the order of the points. What those voxels enclose is filled, unless shells are asked for
(enclosed_runs.py).

Each voxel is shown by a tetrahedron in its middle, and each run that is filled by a box, a quarter of a voxel away from
all others: they meet those voxels alone. Tetrahedra come first, so that voxels of points keep their colours.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.box_rounding import UNITS_PER_VOXEL
from voxrt.voxelize.collider_shapes import BOX_TRIANGLES
from voxrt.voxelize.enclosed_runs import AXIS_BITS, coordinates, filled_runs, groups
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.grid import Grid
from voxrt.voxelize.materials import DEFAULT_COLOUR, MATERIAL_LIMIT, Material
from voxrt.voxelize.mesh import Mesh
from voxrt.voxelize.object_proxies import proxies
from voxrt.voxelize.point_cloud import PointCloud
from voxrt.voxelize.primitive_meshes import VOXEL_MARK, VOXEL_MARK_TRIANGLES
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.rules import ObjectFill
    from voxrt.voxelize.scene import SceneObject

_AXIS_BITS = 16  # of a voxel's coordinate: a key has x, y and z
_COLUMN = 1 << AXIS_BITS
_LAST = _COLUMN - 1
_MARGIN = 0.25


def place_points(scene: Scene, grid: Grid, *, colours: int, fill: ObjectFill, geometry: Geometry = "auto") -> Scene:
    """Return a scene whose point clouds have meshes on a grid; the scene itself where it has none.

    Their points are then the centres of the voxels that hold points, in the scene frame.

    Parameters
    ----------
    scene
        A scene as it was loaded.
    grid
        The grid on which it will be voxelized. Points outside of it are left out.
    colours
        The most materials to add for all clouds, 1 … 254.
    fill
        ``"surface"`` keeps voxels that hold points; any other also fills what they enclose. Objects with a fill of
        their own keep that.
    geometry
        As for :func:`voxrt.voxelize.voxelize`: points that colliders represent are left out.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong kind or range.
    DoesNotFitError
        The scene's own materials leave no id for the colours.

    Examples
    --------
    >>> from voxrt.voxelize import EMPTY, Grid, PointCloud, Scene, SceneObject
    >>> cloud = PointCloud([[0.2, 0.2, 0.2], [0.3, 0.3, 0.3], [1.5, 0, 0]], [[255, 0, 0], [255, 0, 0], [0, 0, 255]])
    >>> scene = Scene("scan", [SceneObject("scan", points=cloud)], [EMPTY])
    >>> placed = place_points(scene, Grid(1, (0, 0, 0), 1.0), colours=32, fill="auto")
    >>> [material.name for material in placed.materials]
    ['empty', 'points #0000ff', 'points #ff0000']
    """
    arguments.instance("scene", scene, Scene)
    arguments.instance("grid", grid, Grid)
    colours = arguments.whole("colours", colours, 1, MATERIAL_LIMIT - 1)
    held = {
        row: _held(item, item.points, grid)
        for row, item in enumerate(scene.objects)
        if item.points is not None and not len(item.mesh.triangles) and proxies(item, geometry) is None
    }
    if not held:
        return scene
    left = MATERIAL_LIMIT + 1 - len(scene.materials)
    if left < 1:
        raise DoesNotFitError(f"{scene.name}: its own materials take all 255 ids and leave none for its points")
    found = np.concatenate([one for _, one in held.values()])
    entries, rows = _native.quantize(found, np.ones(len(found)), min(colours, left))
    objects, used = list(scene.objects), 0
    for row, (keys, _) in held.items():
        ids = (rows[used : used + len(keys)] + len(scene.materials)).astype(np.uint8)
        used += len(keys)
        mesh = _mesh(keys, ids, grid, filled=(objects[row].fill or fill) != "surface")
        centres = PointCloud((coordinates(keys) + 0.5) * grid.voxel_size + grid.origin)
        objects[row] = replace(objects[row], mesh=mesh, transform=np.eye(4), points=centres)
    taken = {material.name for material in scene.materials}
    materials = tuple(Material(_name(entry, taken), tuple(entry)) for entry in entries.tolist())
    return replace(scene, objects=tuple(objects), materials=scene.materials + materials)


def _name(colour: list[int], taken: set[str]) -> str:
    name = "points #" + bytes(colour).hex()
    while name in taken:
        name += "'"
    return name


def _held(item: SceneObject, cloud: PointCloud, grid: Grid) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
    """Return the keys of the voxels that hold enough points, ascending, and their colours, uint8, shape (V, 3)."""
    keys, inside = np.zeros(len(cloud.positions), np.int64), np.ones(len(cloud.positions), np.bool_)
    for axis in range(3):
        place = np.full(len(keys), item.transform[axis, 3])
        for number, factor in enumerate(item.transform[axis, :3]):
            if factor:
                place += np.multiply(cloud.positions[:, number], factor, dtype=np.float64)
        # Snapped, as the vertices of meshes are; points on the grid's upper border are in its last voxels.
        units = np.rint((place - grid.origin[axis]) * (UNITS_PER_VOXEL / grid.voxel_size))
        inside &= (units >= 0) & (units <= grid.size * UNITS_PER_VOXEL)
        keys = keys << AXIS_BITS | np.clip(units // UNITS_PER_VOXEL, 0, grid.size - 1).astype(np.int64)
    keys = keys[inside]
    if cloud.colours is None:
        keys.sort()
        starts, counts = groups(keys)
        kept = starts[counts >= cloud.least]
        return keys[kept], np.broadcast_to(np.array(DEFAULT_COLOUR, np.uint8), (len(kept), 3))
    channels = []
    keys <<= 8
    for channel in range(3):
        coloured = keys | cloud.colours[inside, channel]
        coloured.sort()
        if channel == 0:
            starts, counts = groups(coloured >> 8)
            enough = counts >= cloud.least
            starts, counts = starts[enough], counts[enough]
            voxels = coloured[starts] >> 8
        channels.append((coloured[starts + (counts - 1) // 2] & 255).astype(np.uint8))
    return voxels, np.stack(channels, axis=1)


def _mesh(keys: NDArray[np.int64], ids: NDArray[np.uint8], grid: Grid, *, filled: bool) -> Mesh:
    corners = coordinates(keys)
    positions = [(corners[:, None] + VOXEL_MARK).reshape(-1, 3)]
    triangles = [_numbered(VOXEL_MARK_TRIANGLES, len(keys), len(VOXEL_MARK), 0)]
    materials = [np.repeat(ids, len(VOXEL_MARK_TRIANGLES))]
    if filled and len(keys):
        low, high = filled_runs(keys, grid.size)
        lowest, highest = coordinates(low) + _MARGIN, coordinates(high) + 1 - _MARGIN
        unit = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], np.bool_)
        positions.append(np.where(unit, highest[:, None], lowest[:, None]).reshape(-1, 3))
        triangles.append(_numbered(BOX_TRIANGLES, len(low), len(unit), len(positions[0])))
        materials.append(np.full(len(low) * len(BOX_TRIANGLES), ids[0]))
    places = np.concatenate(positions) * grid.voxel_size + grid.origin
    return Mesh(places, np.concatenate(triangles), np.concatenate(materials))


def _numbered(triangles: NDArray[np.int32], copies: int, corners: int, first: int) -> NDArray[np.int32]:
    begins = first + corners * np.arange(copies, dtype=np.int32)
    return (begins[:, None, None] + triangles).reshape(-1, 3)
