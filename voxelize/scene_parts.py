"""The parts of a scene in grid space, as arrays for the native voxelizer."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.box_rounding import POW2_CHOICES, UNITS_PER_VOXEL, box_in_voxels, keeps_axes, keeps_shape, round_box
from voxrt.voxelize.collider_shapes import BOX_TRIANGLES, BoxCollider, HullCollider, SphereCollider, box_corners
from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.grid import Grid
from voxrt.voxelize.mesh import MaterialMap
from voxrt.voxelize.object_proxies import GEOMETRIES, proxies
from voxrt.voxelize.rules import OBJECT_FILLS, RULES, THIN_CHOICES
from voxrt.voxelize.scene import Scene
from voxrt.voxelize.voxels import ObjectMode, ObjectReport
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.collider_shapes import Collider
    from voxrt.voxelize.errors import SceneWarning
    from voxrt.voxelize.mesh import Mesh
    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.rules import ObjectFill, Rule, Thin
    from voxrt.voxelize.scene import SceneObject

_MESH, _BOX, _BALL, _ELLIPSOID = range(4)
_ZERO = (0.0, 0.0, 0.0)
_ONE_MATERIAL = np.empty(0, np.uint8)  # no material per triangle: the part has one
_NO_MAP = MaterialMap(np.empty((0, 2), np.int32), np.empty((0, 3, 2), np.float32), np.empty(0, np.uint8))


class SceneParts:
    """The parts of a scene as arrays for the native voxelizer, in authored order."""

    def __init__(
        self, scene: Scene, grid: Grid, *, fill: ObjectFill, rule: Rule, thin: Thin, geometry: Geometry, pow2: Pow2
    ) -> None:
        arguments.instance("scene", scene, Scene)
        arguments.instance("grid", grid, Grid)
        arguments.choice("fill", fill, OBJECT_FILLS)
        arguments.choice("rule", rule, RULES)
        arguments.choice("thin", thin, THIN_CHOICES)
        arguments.choice("geometry", geometry, GEOMETRIES)
        arguments.choice("pow2", pow2, POW2_CHOICES)
        self.scene = scene
        self.grid = grid
        self.choices = {"thin": thin}
        self._fill = fill
        self._rule = rule
        self._geometry = geometry
        self._scale = UNITS_PER_VOXEL / grid.voxel_size
        self._meshes: list[_native.MeshArrays] = []
        self._mesh_index: dict[int, int] = {}
        self._keys: list[object] = []
        self._rows: list[tuple[int, int, int, int]] = []  # kind, mesh, material, object
        self._frames: list[NDArray[np.float64]] = []
        self._objects = 0
        self._only_materials: dict[int, int] = {}  # an id is unique, for the scene keeps its meshes
        self.log = WarningLog()
        self._placements: list[ObjectPlacement] = []
        for item in scene.objects:
            self._objects += 1
            self._placements.append(_add_object(self, item, geometry, pow2))

    def to_grid(self, transform: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the transform from an object's frame to grid space, in 1/4096 voxel: float64, shape (3, 4)."""
        frame = transform[:3].astype(np.float64)
        frame[:, 3] -= self.grid.origin
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(frame * self._scale)

    def only_material(self, mesh: Mesh) -> int:
        """Return the material of all triangles of a mesh; 0 where there are several."""
        if id(mesh) not in self._only_materials:
            materials = np.flatnonzero(np.bincount(mesh.materials))
            only = int(materials[0]) if len(materials) == 1 and mesh.material_map is None else 0
            self._only_materials[id(mesh)] = only
        return self._only_materials[id(mesh)]

    def add(self, kind: int, frame: NDArray[np.float64], material: int, mesh: int = -1) -> None:
        """Add a part of the last object: its kind, frame, material, and mesh if it has one."""
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

    def described(self, result: _native.Voxelized) -> tuple[tuple[ObjectReport, ...], tuple[SceneWarning, ...]]:
        """Return the report of each object, and the warnings, from what the native voxelizer says."""
        shown = [self._geometry == "collider" or not item.hidden for item in self.scene.objects]
        objects = tuple(
            ObjectReport(
                item.name,
                source,
                ObjectMode(_native.OBJECT_MODES[mode]),
                int(count),
                moved,
                grown,
                rule=item.rule or self._rule,
            )
            for item, (source, moved, grown), mode, count, wanted in zip(
                self.scene.objects, self._placements, result.object_modes, result.object_voxels, shown, strict=True
            )
            if wanted
        )
        found = _native.object_warnings(
            result.object_voxels,
            result.object_modes,
            result.object_notes,
            [item.name for item in self.scene.objects],
            shown,
        )
        log = copy.deepcopy(self.log)
        for warning in found:
            log.add(*warning)
        return objects, log.warnings()

    def arrays(self) -> dict[str, Any]:
        """Return the parts as arguments of the native :class:`SceneParts`, by name."""
        rows = np.array(self._rows, dtype=np.int32).reshape(-1, 4)
        return {
            "depth": self.grid.depth,
            "meshes": self._meshes,
            "kinds": rows[:, 0].astype(np.uint8),
            "mesh_of": np.ascontiguousarray(rows[:, 1]),
            "frames": np.array(self._frames, dtype=np.float64).reshape(-1, 12),
            "materials": rows[:, 2].astype(np.uint8),
            "objects_of": np.ascontiguousarray(rows[:, 3]),
            "rules": np.array([RULES.index(one.rule or self._rule) for one in self.scene.objects], np.uint8),
            "fills": np.array([OBJECT_FILLS.index(one.fill or self._fill) for one in self.scene.objects], np.uint8),
        }


def _vertices(positions: NDArray[np.floating], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return vertices for the native voxelizer; those that no triangle uses move to a used one, for they may be far."""
    exact = np.ascontiguousarray(positions, dtype=np.float64)
    if triangles.min() < 0 or triangles.max() >= len(exact):
        return exact  # which the native voxelizer refuses
    return _native.placed_vertices(exact, np.ascontiguousarray(triangles, np.int32))


ObjectPlacement = tuple[str, tuple[float, float, float], tuple[float, float, float]]


def _add_object(parts: SceneParts, item: SceneObject, geometry: Geometry, pow2: Pow2) -> ObjectPlacement:
    """Add an object's parts. Return its source, and how far rounding moved and grew it."""
    colliders = proxies(item, geometry)
    mesh = item.mesh
    if colliders is None:
        if item.points is not None and len(item.points.positions) and not len(mesh.triangles):
            raise ValueError(f"object {item.name!r} has points that are on no grid: call place_points first")
        arrays = (mesh.positions, mesh.triangles, mesh.materials)
        parts.add_mesh(mesh, arrays, item.transform, parts.only_material(mesh), mesh.material_map or _NO_MAP)
        return "mesh", _ZERO, _ZERO
    material = item.collider_material
    if not item.colliders and colliders:
        material = int(mesh.materials[0])
        parts.log.add("no-collider", "objects without a collider took the box of their mesh")
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


def _add_collider(
    parts: SceneParts, item: SceneObject, collider: Collider, material: int, pow2: Pow2
) -> ObjectPlacement:
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


def _add_box(parts: SceneParts, item: SceneObject, box: BoxCollider, material: int, pow2: Pow2) -> ObjectPlacement:
    wants_rounding = pow2 == "box" and box.pow2
    if not keeps_axes(item.transform):
        if wants_rounding:
            parts.log.add(
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


def unreachable(scene: Scene, index: int) -> Exception:
    """Return the error for an object that the native voxelizer refuses."""
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
