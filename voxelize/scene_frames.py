"""The scenes of an animation's frames, with one grid and one palette for all of them.

What frames have in common is kept once: meshes that do not change, and the triangles, textures and materials of those
that do.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from msgspec import Struct
from msgspec.structs import asdict, astuple, replace

from voxrt.voxelize.colour.voxel_colours import DEFAULT_COLOURS, assign_colours
from voxrt.voxelize.errors import DoesNotFitError, SceneWarning
from voxrt.voxelize.materials import MATERIAL_LIMIT
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.materials import Material
    from voxrt.voxelize.mesh import Mesh
    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.scene import Scene, SceneObject

    Part = TypeVar("Part")

_DEFORMED = {"positions", "normals"}
"""What an animation changes of a mesh; its triangles and their appearance stay."""


class SceneFrames(Value, frozen=True, eq=False):
    """The scenes of all frames, as :func:`join_scenes` makes them.

    Attributes
    ----------
    union
        One scene with the objects of all frames, frame by frame. Its viewpoint and its light are those of the first.
    counts
        The number of objects of each frame.

    Examples
    --------
    >>> from voxrt.voxelize import load
    >>> frames = join_scenes([load("examples/dog.usda"), load("examples/dog.usda")])
    >>> frames.counts, frames.moves
    ((19, 19), False)
    >>> frames.scene(1)
    Scene(name='dog', objects=19, triangles=228, materials=6, warnings=0)
    """

    union: Scene
    counts: tuple[int, ...]

    @property
    def moves(self) -> bool:
        """Whether any two frames differ in their objects."""
        first = self.scene(0).objects
        return any(not _same_objects(first, self.scene(number).objects) for number in range(1, len(self.counts)))

    def scene(self, number: int) -> Scene:
        """Return the scene of a frame, counted from 0, with the materials of all."""
        start = sum(self.counts[:number])
        return replace(self.union, objects=self.union.objects[start : start + self.counts[number]])

    def coloured(self, grid: Grid, *, colours: int = DEFAULT_COLOURS, geometry: Geometry = "auto") -> SceneFrames:
        """Return the frames with one palette: :func:`assign_colours` for all of them.

        A mesh that changes its shape is coloured once, in the shape in which it is largest.
        """
        largest: dict[tuple[int, ...], tuple[float, Mesh]] = {}
        keys: dict[int, tuple[int, ...]] = {}
        for mesh in {id(item.mesh): item.mesh for item in self.union.objects}.values():
            key = keys[id(mesh)] = tuple(
                id(getattr(mesh, name)) for name in mesh.__struct_fields__ if name not in _DEFORMED
            )
            extent = _extent(mesh)
            if key not in largest or extent > largest[key][0]:
                largest[key] = extent, mesh
        shown = tuple(replace(item, mesh=largest[keys[id(item.mesh)]][1]) for item in self.union.objects)
        painted = assign_colours(replace(self.union, objects=shown), grid, colours=colours, geometry=geometry)
        made: dict[int, Mesh] = {}
        objects = []
        for item, paint in zip(self.union.objects, painted.objects, strict=True):
            if id(item.mesh) not in made:
                materials, material_map = paint.mesh.materials, paint.mesh.material_map
                made[id(item.mesh)] = replace(item.mesh, materials=materials, material_map=material_map)
            objects.append(replace(item, mesh=made[id(item.mesh)]))
        return replace(self, union=replace(painted, objects=tuple(objects)))


def join_scenes(scenes: Iterable[Scene]) -> SceneFrames:
    """Join the scenes of frames. Each is released before the next one is taken, but for what is new in it.

    Parameters
    ----------
    scenes
        One or more, in the order of the frames.

    Returns
    -------
    SceneFrames
        All frames. A warning that several frames have counts once, with the largest of their counts.

    Raises
    ------
    ValueError
        There is no scene.
    DoesNotFitError
        All frames together have more than 255 materials.

    Examples
    --------
    >>> from voxrt.voxelize import load
    >>> frames = join_scenes([load("examples/house.obj"), load("examples/house.obj")])
    >>> frames.scene(0).objects[0].mesh is frames.scene(1).objects[0].mesh
    True
    """
    known: dict[object, object] = {}
    table = _MaterialTable()
    warnings: list[SceneWarning] = []
    objects: list[SceneObject] = []
    counts: list[int] = []
    first: Scene | None = None
    for scene in scenes:
        if first is None:
            first = replace(scene, objects=(), warnings=())
        ids = table.add(scene.name, scene.materials)
        warnings += scene.warnings
        meshes: dict[int, Mesh] = {}
        for item in scene.objects:
            if id(item.mesh) not in meshes:
                meshes[id(item.mesh)] = _kept_mesh(_recoloured(item.mesh, ids), known)
            objects.append(
                replace(
                    item,
                    mesh=meshes[id(item.mesh)],
                    points=_kept(item.points, known),
                    colliders=tuple(_kept(one, known) for one in item.colliders),
                    collider_material=int(ids[item.collider_material]) if item.colliders else 1,
                )
            )
        counts.append(len(scene.objects))
    if first is None:
        raise ValueError("an animation has one frame or more")
    union = replace(first, objects=tuple(objects), materials=table.materials, warnings=merge_warnings(warnings))
    return SceneFrames(union, tuple(counts))


def merge_warnings(warnings: Iterable[SceneWarning]) -> tuple[SceneWarning, ...]:
    """Return each warning that several frames have once, with the largest of their counts.

    >>> from voxrt.voxelize import SceneWarning
    >>> merge_warnings([SceneWarning("hole", "has a hole", 2), SceneWarning("hole", "has a hole", 3)])
    (SceneWarning(kind='hole', message='has a hole', count=3),)
    """
    counts: dict[tuple[str, str], int] = {}
    for one in warnings:
        counts[one.kind, one.message] = max(counts.get((one.kind, one.message), 0), one.count)
    return tuple(SceneWarning(kind, message, count) for (kind, message), count in counts.items())


class _MaterialTable:
    """The materials of all frames. The n-th of several equal materials of a frame is the n-th of them in the table."""

    def __init__(self) -> None:
        self._rows: dict[tuple[Material, int], int] = {}

    @property
    def materials(self) -> tuple[Material, ...]:
        return tuple(material for material, _ in self._rows)

    def add(self, name: str, materials: tuple[Material, ...]) -> NDArray[np.uint8]:
        """Return the ids in this table of the materials of a scene: uint8, shape (256,)."""
        ids = np.zeros(256, np.uint8)
        seen: Counter[Material] = Counter()
        for row, material in enumerate(materials):
            found = self._rows.setdefault((material, seen[material]), len(self._rows))
            if found > MATERIAL_LIMIT:
                raise DoesNotFitError(
                    f"{name}: with this frame, all frames have more than {MATERIAL_LIMIT} materials; "
                    "use the same materials in all of them"
                )
            ids[row] = found
            seen[material] += 1
        return ids


def _recoloured(mesh: Mesh, ids: NDArray[np.uint8]) -> Mesh:
    """Return a mesh with the materials of the table of all frames."""
    materials = ids[mesh.materials]
    return mesh if np.array_equal(materials, mesh.materials) else replace(mesh, materials=materials)


def _kept_mesh(mesh: Mesh, known: dict[object, object]) -> Mesh:
    """Return a mesh whose parts are those of an earlier frame where they are equal: itself where all are."""
    parts = {name: _kept(part, known) for name, part in asdict(mesh).items()}
    key = tuple(map(id, parts.values()))  # `known` keeps them alive
    if key not in known:
        known[key] = replace(mesh, **parts)
    return known[key]  # type: ignore[return-value]


def _kept(value: Part, known: dict[object, object]) -> Part:
    """Return the first value that was equal to this one."""
    return value if value is None else known.setdefault(_fingerprint(value), value)  # type: ignore[return-value]


def _fingerprint(value: object) -> bytes:
    """Return what equal values have in common and others do not: arrays by their bytes, structs by their fields."""
    digest = hashlib.blake2b(type(value).__name__.encode(), digest_size=16)
    if isinstance(value, np.ndarray):
        digest.update(f"{value.dtype.str}{value.shape}".encode())
        digest.update(np.ascontiguousarray(value).data)
    elif isinstance(value, Struct):
        for part in astuple(value):
            digest.update(_fingerprint(part))
    elif isinstance(value, tuple | list):
        digest.update(str(len(value)).encode())
        for part in value:
            digest.update(_fingerprint(part))
    else:
        digest.update(repr(value).encode("utf-8", "surrogatepass"))
    return digest.digest()


def _extent(mesh: Mesh) -> float:
    """Return the sum of all sides of the triangles of a mesh."""
    with np.errstate(over="ignore", invalid="ignore"):
        corners = mesh.positions[mesh.triangles].astype(np.float64)
        return float(np.nan_to_num(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)).sum())


def _same_objects(some: tuple[SceneObject, ...], others: tuple[SceneObject, ...]) -> bool:
    return len(some) == len(others) and all(
        one.mesh is other.mesh
        and one.points is other.points
        and one.hidden == other.hidden
        and np.array_equal(one.transform, other.transform)
        and one.colliders == other.colliders
        for one, other in zip(some, others, strict=True)
    )
