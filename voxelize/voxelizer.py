"""The front of the native voxelizer: a scene becomes voxels.

Each object becomes parts in grid space: its mesh, or one part per collider. Vertices are snapped to 1/4096 voxel; from
there on coverage is exact. Winding numbers tell inside from outside. The first object that covers a voxel keeps it.

Materials: a voxel of the shell takes the material of the first triangle, in authored order, that covers it. Where that
triangle has a material map, it takes the material at the triangle's point nearest to the voxel's centre. The inside,
which no ray from outside can see, takes the material of its object's first triangle. A surface that is cut away still
bounds the inside; voxels that only such a surface covers are empty.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.box_rounding import POW2_CHOICES, UNITS_PER_VOXEL, box_in_voxels, keeps_axes, keeps_shape, round_box
from voxrt.voxelize.collider_shapes import BOX_TRIANGLES, BoxCollider, HullCollider, SphereCollider, box_corners
from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.grid import Grid
from voxrt.voxelize.mesh import MaterialMap
from voxrt.voxelize.object_proxies import GEOMETRIES, proxies
from voxrt.voxelize.scene import Scene
from voxrt.voxelize.voxels import ObjectMode, ObjectReport, Voxelization, VoxelizationReport, Voxels

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.collider_shapes import Collider
    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.scene import SceneObject

_MESH, _BOX, _BALL, _ELLIPSOID = range(4)
_MOST_THREADS = 1024
_ZERO = (0.0, 0.0, 0.0)
_ONE_MATERIAL = np.empty(0, np.uint8)  # no material per triangle: the part has one
_NO_MAP = MaterialMap(np.empty((0, 2), np.int32), np.empty((0, 3, 2), np.float32), np.empty(0, np.uint8))


def voxelize(
    scene: Scene,
    grid: Grid,
    *,
    fill: Literal["solid", "surface", "auto"] = "solid",
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
    threads: int = 0,
) -> Voxelization:
    """Voxelize a scene: a voxel is solid when an object's closed solid overlaps its interior at all.

    Parameters
    ----------
    scene, grid
        The scene, and the grid to voxelize it on. What lies outside the grid is cut off.
    fill
        ``"solid"`` fills what surfaces enclose, small holes or not and whichever way each closed piece faces. It does
        not fill open pieces: those with an opening larger than 15 % of their area that other pieces do not close.
        ``"surface"`` keeps the shells alone. ``"auto"`` is ``"solid"``, but leaves open also pieces whose openings
        exceed 5 % of their area together, as those of clothes do.
    geometry
        ``"auto"``: an object's colliders where it has some, else its triangles; ``"render"``: always the triangles;
        ``"collider"``: always colliders, and the box of the mesh where the author gave none (with a warning).
    pow2
        ``"box"`` rounds box colliders that ask for it up to powers of two voxels; ``"none"`` never.
    threads
        The number of threads, 0 … 1024; 0 for as many as the machine has. The result does not depend on it.

    Returns
    -------
    Voxelization
        The voxels, a report per object, and warnings.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong kind or range.
    AssetError
        A coordinate that is not finite.
    DoesNotFitError
        An object that reaches into the grid from more than 2**18 voxels away.

    Examples
    --------
    >>> from voxrt.voxelize import Grid, authoring, voxelize
    >>> yard = authoring.Author("yard")
    >>> _ = yard.material("stone", "#9a9aa0")
    >>> yard.add("block", authoring.box((4, 4, 4), centre=(2, 2, 2)), material="stone")
    >>> result = voxelize(yard.build(), Grid(3, (0, 0, 0), 1.0))
    >>> [(one.name, str(one.mode), one.voxels) for one in result.objects]
    [('block', 'exact', 64)]
    """
    parts, reports = _parts_of(scene, grid, fill, geometry, pow2)
    result = _native_result(scene, parts, fill=fill, threads=arguments.whole("threads", threads, 0, _MOST_THREADS))
    objects, warnings = _told(scene, parts, reports, result, geometry)
    return Voxelization(_voxels_of(grid.depth, result), objects, warnings, result.seconds)


def voxelize_in_blocks(
    scene: Scene,
    grid: Grid,
    take: Callable[[Voxels], None],
    *,
    block_side: int,
    fill: Literal["solid", "surface", "auto"] = "solid",
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
    threads: int = 0,
) -> VoxelizationReport:
    """Voxelize a scene whose voxels do not fit the memory at once, square by square of columns.

    Parameters
    ----------
    scene, grid, fill, geometry, pow2, threads
        As :func:`voxelize` takes them.
    take
        Called with the voxels of each square that has geometry, in Morton order. Squares are disjoint, so the octrees
        of their voxels are joined by :class:`voxrt.octree.Assembly`.
    block_side
        Columns per side of a square, a multiple of 64. It reaches over the whole height of the grid.

    Returns
    -------
    VoxelizationReport
        What :func:`voxelize` returns besides the voxels.

    Raises
    ------
    TypeError, ValueError, AssetError, DoesNotFitError
        As :func:`voxelize` does.

    Examples
    --------
    >>> from voxrt.voxelize import fit_grid, load, voxelize_in_blocks
    >>> scene = load("examples/house.obj")
    >>> blocks = []
    >>> report = voxelize_in_blocks(scene, fit_grid(scene, depth=7), blocks.append, block_side=64)
    >>> len(blocks), sum(one.voxels for one in report.objects)
    (4, 1082472)
    """
    parts, reports = _parts_of(scene, grid, fill, geometry, pow2)

    def take_block(*arrays: Any) -> None:  # noqa: ANN401 - the arrays of Voxels, in order
        take(Voxels(grid.depth, *arrays))

    result = _native_result(
        scene,
        parts,
        fill=fill,
        threads=arguments.whole("threads", threads, 0, _MOST_THREADS),
        block_side=arguments.whole("block_side", block_side, 64, 1 << 16),
        take_block=take_block,
    )
    return VoxelizationReport(*_told(scene, parts, reports, result, geometry), result.seconds)


def _parts_of(scene: Scene, grid: Grid, fill: str, geometry: Geometry, pow2: Pow2) -> tuple[_Parts, list[_Report]]:
    arguments.instance("scene", scene, Scene)
    arguments.instance("grid", grid, Grid)
    arguments.choice("fill", fill, ("solid", "surface", "auto"))
    arguments.choice("geometry", geometry, GEOMETRIES)
    arguments.choice("pow2", pow2, POW2_CHOICES)
    parts = _Parts(grid)
    return parts, [_add_object(parts, item, geometry, pow2) for item in scene.objects]


def _native_result(
    scene: Scene,
    parts: _Parts,
    *,
    fill: str,
    threads: int,
    block_side: int = 0,
    take_block: Callable[..., None] | None = None,
) -> _native.Voxelized:
    try:
        return parts.voxelize(
            fill=fill, threads=threads, objects=len(scene.objects), block_side=block_side, take_block=take_block
        )
    except _native.OutOfRangeError as error:
        raise _unreachable(scene, int(error.args[0])) from None


def _voxels_of(depth: int, result: _native.Voxelized) -> Voxels:
    return Voxels(
        depth=depth,
        brick_codes=result.brick_codes,
        brick_masks=result.brick_masks,
        brick_materials=result.brick_materials,
        brick_rows=result.brick_rows,
        cells=result.cells,
        octant_codes=result.octant_codes,
        octant_levels=result.octant_levels,
        octant_materials=result.octant_materials,
    )


def _told(
    scene: Scene, parts: _Parts, reports: list[_Report], result: _native.Voxelized, geometry: Geometry
) -> tuple[tuple[ObjectReport, ...], tuple[SceneWarning, ...]]:
    """Return the report of each object, and the warnings."""
    objects = tuple(
        ObjectReport(item.name, source, ObjectMode(_native.OBJECT_MODES[mode]), int(count), moved, grown)
        for item, (source, moved, grown), mode, count in zip(
            scene.objects, reports, result.object_modes, result.object_voxels, strict=True
        )
        if geometry == "collider" or not item.hidden
    )
    for kind, message, count in _native.object_warnings(
        result.object_voxels,
        result.object_modes,
        result.object_flipped,
        result.object_mostly_filled,
        [item.name for item in scene.objects],
        [geometry == "collider" or not item.hidden for item in scene.objects],
    ):
        parts.warn(kind, message, count)
    return objects, tuple(parts.warnings())


class _Parts:
    """The parts of a scene as arrays for the native voxelizer, in authored order."""

    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        self._scale = UNITS_PER_VOXEL / grid.voxel_size
        self._meshes: list[_native.MeshArrays] = []
        self._mesh_index: dict[int, int] = {}
        self._keys: list[object] = []
        self._rows: list[tuple[int, int, int, int]] = []  # kind, mesh, material, object
        self._frames: list[NDArray[np.float64]] = []
        self._objects = 0
        self._counts: dict[tuple[str, str], int] = {}

    def start_object(self) -> None:
        self._objects += 1

    def warn(self, kind: str, message: str, count: int = 1) -> None:
        self._counts[kind, message] = self._counts.get((kind, message), 0) + count

    def warnings(self) -> list[SceneWarning]:
        return [SceneWarning(kind, message, count) for (kind, message), count in self._counts.items()]

    def to_grid(self, transform: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the transform from an object's frame to grid space, in 1/4096 voxel: float64, shape (3, 4)."""
        frame = transform[:3].astype(np.float64)
        frame[:, 3] -= self.grid.origin
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(frame * self._scale)

    def add(self, kind: int, frame: NDArray[np.float64], material: int, mesh: int = -1) -> None:
        padded = np.zeros(12)
        padded[: frame.size] = frame.ravel()
        self._rows.append((kind, mesh, material, self._objects - 1))
        self._frames.append(padded)

    def add_mesh(
        self,
        key: object,
        mesh: tuple[NDArray[np.floating], NDArray[np.int32], NDArray[np.uint8]],
        transform: NDArray[np.float64],
        material: int,
        material_map: MaterialMap = _NO_MAP,
    ) -> None:
        """Add a mesh part: positions, triangles, materials. Parts with the same object as `key` share their arrays."""
        if len(mesh[1]) == 0:
            return
        if id(key) not in self._mesh_index:
            self._keys.append(key)  # an id is unique only while its object lives
            self._mesh_index[id(key)] = len(self._meshes)
            self._meshes.append(
                _native.MeshArrays(
                    positions=_vertices(mesh[0], mesh[1]),
                    triangles=np.ascontiguousarray(mesh[1], dtype=np.int32),
                    materials=np.ascontiguousarray(mesh[2], dtype=np.uint8),
                    raster_sizes=np.ascontiguousarray(material_map.sizes, dtype=np.int32),
                    raster_coordinates=np.ascontiguousarray(material_map.corners, dtype=np.float32),
                    raster_materials=np.ascontiguousarray(material_map.materials, dtype=np.uint8),
                )
            )
        self.add(_MESH, self.to_grid(transform), material, self._mesh_index[id(key)])

    def voxelize(
        self, *, fill: str, threads: int, objects: int, block_side: int, take_block: Callable[..., None] | None
    ) -> _native.Voxelized:
        rows = np.array(self._rows, dtype=np.int32).reshape(-1, 4)
        return _native.voxelize(
            self.grid.depth,
            self._meshes,
            rows[:, 0].astype(np.uint8),
            np.ascontiguousarray(rows[:, 1]),
            np.array(self._frames, dtype=np.float64).reshape(-1, 12),
            rows[:, 2].astype(np.uint8),
            np.ascontiguousarray(rows[:, 3]),
            objects,
            fill,
            threads,
            block_side,
            take_block,
        )


def _vertices(positions: NDArray[np.floating], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return vertices for the native voxelizer; those that no triangle uses move to a used one, for they may be far."""
    exact = np.ascontiguousarray(positions, dtype=np.float64)
    if triangles.min() < 0 or triangles.max() >= len(exact):
        return exact  # which the native voxelizer refuses
    return _native.placed_vertices(exact, np.ascontiguousarray(triangles, np.int32))


_Report = tuple[str, tuple[float, float, float], tuple[float, float, float]]


def _add_object(parts: _Parts, item: SceneObject, geometry: Geometry, pow2: Pow2) -> _Report:
    """Add an object's parts. Return its source, and how far rounding moved and grew it."""
    parts.start_object()
    colliders = proxies(item, geometry)
    mesh = item.mesh
    if colliders is None:
        materials = np.flatnonzero(np.bincount(mesh.materials))
        only = int(materials[0]) if len(materials) == 1 and mesh.material_map is None else 0
        arrays = (mesh.positions, mesh.triangles, mesh.materials)
        parts.add_mesh(mesh, arrays, item.transform, only, mesh.material_map or _NO_MAP)
        return "mesh", _ZERO, _ZERO
    material = item.collider_material
    if not item.colliders and colliders:
        material = int(mesh.materials[0])
        parts.warn("no-collider", "objects without a collider took the box of their mesh")
    sources: list[str] = []
    moved, grown = np.zeros(3), np.zeros(3)
    for collider in colliders:
        source, by, growth = _add_collider(parts, item, collider, material, pow2)
        sources.append(source)
        moved = np.where(np.abs(by) > np.abs(moved), by, moved)
        grown = np.maximum(growth, grown)
    return "+".join(dict.fromkeys(sources)) or "mesh", _triple(moved), _triple(grown)


def _triple(vector: NDArray[np.float64]) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])


def _add_collider(parts: _Parts, item: SceneObject, collider: Collider, material: int, pow2: Pow2) -> _Report:
    if isinstance(collider, BoxCollider):
        return _add_box(parts, item, collider, material, pow2)
    if isinstance(collider, SphereCollider):
        frame = parts.to_grid(item.transform)
        centre = frame[:, :3] @ collider.centre + frame[:, 3]
        if keeps_shape(item.transform):
            radius = collider.radius * float(np.sqrt((frame[:, :3] ** 2).sum() / 3))
            parts.add(_BALL, np.rint(np.append(centre, max(radius, 1.0))), material)
        else:
            parts.add(_ELLIPSOID, np.column_stack([frame[:, :3] * collider.radius, centre]), material)
        return "sphere", _ZERO, _ZERO
    if isinstance(collider, HullCollider):
        triangles = _native.convex_hull(np.ascontiguousarray(collider.positions), parts.to_grid(item.transform))
        parts.add_mesh(collider, (collider.positions, triangles, _ONE_MATERIAL), item.transform, material)
        return "hull", _ZERO, _ZERO
    parts.add_mesh(collider, (collider.positions, collider.triangles, _ONE_MATERIAL), item.transform, material)
    return "mesh", _ZERO, _ZERO


def _add_box(parts: _Parts, item: SceneObject, box: BoxCollider, material: int, pow2: Pow2) -> _Report:
    wants_rounding = pow2 == "box" and box.pow2
    if not keeps_axes(item.transform):
        if wants_rounding:
            parts.warn(
                "oriented-box", "boxes that are rotated against the grid's axes were not rounded to powers of two"
            )
        parts.add_mesh(box, (box_corners(box), BOX_TRIANGLES, _ONE_MATERIAL), item.transform, material)
        return "box", _ZERO, _ZERO
    low, high = box_in_voxels(item, box, parts.grid)
    moved, grown = _ZERO, _ZERO
    if wants_rounding:
        rounded = round_box(low, high, parts.grid.size)
        low, high = rounded.low.astype(np.float64), rounded.high.astype(np.float64)
        moved, grown = rounded.moved, rounded.grown
    parts.add(_BOX, np.rint(np.concatenate([low, high]) * UNITS_PER_VOXEL), material)
    return "box", moved, grown


def _unreachable(scene: Scene, index: int) -> Exception:
    item = scene.objects[index]
    points = [item.mesh.positions[item.mesh.triangles], item.transform]
    if not all(np.isfinite(values).all() for values in points):
        return AssetError(
            scene.name, "a coordinate is not a number", place=item.name, fix="repair the mesh or its transform"
        )
    return DoesNotFitError(
        f"{scene.name}: {item.name}: reaches more than {2**18} voxels away from the grid; "
        "use a larger voxel size or remove the object"
    )
