"""From a scene to its voxels: the front of the native voxelizer.

Each object becomes parts in grid space: its mesh, or a part for each of its colliders. Vertices are snapped to 1/4096
voxel; from there on coverage is exact (see src/triangle_coverage.h), inside is told by winding numbers
(src/solid_fill.h), and the first object keeps a voxel.

Materials: a shell voxel takes the material of the first triangle, in authored order, that covers it; where the triangle
is tinted, the one of its point nearest to the voxel's centre. The inside, which no ray from outside can see, takes that
of its object's first triangle. Surface that is cut away is still surface to the inside: it ends there, and the voxels
that only such surface is in are empty.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from voxrt.voxelize import _native
from voxrt.voxelize.colliders import (
    BOX_TRIANGLES,
    UNITS_PER_VOXEL,
    box_corners,
    box_in_voxels,
    keeps_axes,
    keeps_shape,
    round_box,
    stand_ins,
)
from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.grid import DEPTH_LIMIT
from voxrt.voxelize.scene import BoxCollider, HullCollider, SphereCollider, Tints
from voxrt.voxelize.voxels import ObjectMode, ObjectReport, Voxelization, Voxels

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.colliders import Geometry, Pow2
    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.scene import Collider, Scene, SceneObject

_MESH, _BOX, _BALL, _ELLIPSOID = range(4)
_ZERO = (0.0, 0.0, 0.0)
_ONE_MATERIAL = np.empty(0, np.uint8)  # no materials by triangle: the part has one
_NO_TINTS = Tints(np.empty((0, 2), np.int32), np.empty((0, 3, 2), np.float32), np.empty(0, np.uint8))


def voxelize(
    scene: Scene,
    grid: Grid,
    *,
    fill: Literal["solid", "surface"] = "solid",
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
    threads: int = 0,
) -> Voxelization:
    """Voxelize a scene: a voxel is solid when an object's closed solid overlaps its interior at all.

    Parameters
    ----------
    scene, grid
        What to voxelize and where. Whatever lies outside the grid is cut off.
    fill
        ``"solid"`` fills what surfaces enclose, holes or not and whichever way each closed piece faces, but not what
        stands open: a connected piece of an object of which one opening is larger than 15 % of its area, unless other
        pieces close it. ``"surface"`` keeps shells alone.
    geometry
        ``"auto"``: an object's colliders where it has some, else its triangles; ``"render"``: always the triangles;
        ``"collider"``: always colliders, the box of the mesh where the author gave none (with a warning).
    pow2
        ``"box"`` rounds box colliders that ask for it up to powers of two voxels; ``"none"`` never.
    threads
        0 takes as many as the machine has. The result does not depend on it.

    Raises
    ------
    ValueError
        An argument out of range.
    AssetError
        A coordinate that is not a number.
    DoesNotFitError
        An object that reaches into the grid from more than 2**18 voxels away.
    """
    _check(grid, fill, geometry, pow2, threads)
    parts = _Parts(grid)
    reports = [_add_object(parts, item, geometry, pow2) for item in scene.objects]
    try:
        result = parts.voxelize(fill=fill == "solid", threads=threads, objects=len(scene.objects))
    except _native.OutOfRangeError as error:
        raise _unreachable(scene, int(error.args[0])) from None
    objects = tuple(
        ObjectReport(item.name, source, ObjectMode(_native.OBJECT_MODES[mode]), int(count), moved, grown)
        for item, (source, moved, grown), mode, count in zip(
            scene.objects, reports, result.object_modes, result.object_voxels, strict=True
        )
    )
    standing_open = sum(report.mode is ObjectMode.OPEN for report in objects)
    if standing_open:
        parts.warn(
            "open-surface",
            "objects that stand open, like a room without a front, were not filled: close them or give them colliders",
            standing_open,
        )
    if pieces := int(result.object_flipped.sum()):
        parts.warn(
            "turned-pieces",
            "closed pieces that were inside out beside others of their object were turned: recalculate their normals",
            pieces,
        )
    voxels = Voxels(
        depth=grid.depth,
        brick_codes=result.brick_codes,
        brick_masks=result.brick_masks,
        brick_materials=result.brick_materials,
        brick_rows=result.brick_rows,
        cells=result.cells,
        octant_codes=result.octant_codes,
        octant_levels=result.octant_levels,
        octant_materials=result.octant_materials,
    )
    return Voxelization(voxels, objects, tuple(parts.warnings()), result.seconds)


def _check(grid: Grid, fill: str, geometry: str, pow2: str, threads: int) -> None:
    if not 1 <= grid.depth <= DEPTH_LIMIT:
        raise ValueError(f"grid.depth must be 1 … {DEPTH_LIMIT}, not {grid.depth}")
    if not (np.isfinite(grid.voxel_size) and grid.voxel_size > 0 and np.isfinite(grid.origin).all()):
        raise ValueError("grid.voxel_size must be a positive number, grid.origin three numbers")
    for name, value, choices in (
        ("fill", fill, ("solid", "surface")),
        ("geometry", geometry, ("auto", "render", "collider")),
        ("pow2", pow2, ("box", "none")),
    ):
        if value not in choices:
            raise ValueError(f"{name} must be one of {', '.join(choices)}, not {value!r}")
    if not 0 <= threads <= 1024:
        raise ValueError(f"threads must be 0 … 1024, not {threads}")


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
        """Compose an object's transform with the way to grid space, in 1/4096 voxel: shape (3, 4)."""
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
        tints: Tints = _NO_TINTS,
    ) -> None:
        """Add a mesh part: positions, triangles, materials. Parts whose `key` is one and the same object share them."""
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
                    raster_sizes=np.ascontiguousarray(tints.sizes, dtype=np.int32),
                    raster_coordinates=np.ascontiguousarray(tints.places, dtype=np.float32),
                    raster_materials=np.ascontiguousarray(tints.materials, dtype=np.uint8),
                )
            )
        self.add(_MESH, self.to_grid(transform), material, self._mesh_index[id(key)])

    def voxelize(self, *, fill: bool, threads: int, objects: int) -> _native.Voxelized:
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
        )


def _vertices(positions: NDArray[np.floating], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return vertices as the native voxelizer takes them: those that no triangle uses brought in from wherever."""
    exact = np.ascontiguousarray(positions, dtype=np.float64)
    if triangles.min() < 0 or triangles.max() >= len(exact):
        return exact  # which the native voxelizer refuses
    unused = np.ones(len(exact), np.bool_)
    unused[triangles.reshape(-1).astype(np.intp)] = False  # twice as fast as indices of 32 bits
    if unused.any():
        exact = np.where(unused[:, None], exact[triangles[0, 0]], exact)
    return exact


_Report = tuple[str, tuple[float, float, float], tuple[float, float, float]]


def _add_object(parts: _Parts, item: SceneObject, geometry: Geometry, pow2: Pow2) -> _Report:
    """Add an object's parts; returns its source and how far rounding moved and grew it."""
    parts.start_object()
    colliders = stand_ins(item, geometry)
    mesh = item.mesh
    if colliders is None:
        materials = np.unique(mesh.materials)
        only = int(materials[0]) if len(materials) == 1 and mesh.tints is None else 0
        arrays = (mesh.positions, mesh.triangles, mesh.materials)
        parts.add_mesh(mesh, arrays, item.transform, only, mesh.tints or _NO_TINTS)
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
            parts.warn("oriented-box", "boxes turned against the grid's axes were not rounded to powers of two")
        parts.add_mesh(box, (box_corners(box), BOX_TRIANGLES, _ONE_MATERIAL), item.transform, material)
        return "box", _ZERO, _ZERO
    low, high = box_in_voxels(item, box, parts.grid)
    moved, grown = _ZERO, _ZERO
    if wants_rounding:
        rounded = round_box(low, high, parts.grid)
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
