"""The traversal of a stage: which prims are visible, where, and of which material."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from msgspec import Struct
from msgspec.structs import replace
from pxr import Usd, UsdGeom, UsdPhysics

from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.usd.geometry import Surface, solid_key, surface_of
from voxrt.voxelize.formats.usd.images import Images
from voxrt.voxelize.formats.usd.instancer import placed_copies
from voxrt.voxelize.formats.usd.materials import Materials
from voxrt.voxelize.formats.usd.normals import authored_normals
from voxrt.voxelize.formats.usd.physics import colliders_of
from voxrt.voxelize.formats.usd.skin import PREDICATE, Deformed, deformed_meshes
from voxrt.voxelize.mesh import NO_TRIANGLES
from voxrt.voxelize.rules import OBJECT_FILLS, RULES
from voxrt.voxelize.scene import SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.collider_shapes import Collider
    from voxrt.voxelize.formats.external_files import ExternalFiles
    from voxrt.voxelize.formats.reader_process.limits import Allowance
    from voxrt.voxelize.formats.usd.shading import Shading
    from voxrt.voxelize.rules import ObjectFill, Rule

MOST_OBJECTS = 1_000_000
"""The most objects of a stage: nested instancers can request more copies than memory holds."""

_AFFINE_TOLERANCE = 1e-6

# Prim types that group or describe others and have no shape.
_WITHOUT_SHAPE = frozenset(("", "Xform", "Scope", "Material", "Shader", "NodeGraph", "GeomSubset", "SkelRoot"))

# Prototypes may be below prims that are not defined (``over``) or abstract (``class``).
_PROTOTYPE_PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimIsActive & Usd.PrimIsLoaded)


class _PlacedMesh(Struct, frozen=True, eq=False):
    """An object whose mesh, an index into the traversal's meshes, has no materials yet; None for a hidden object.

    `body` is the path of the rigid body that it is part of; empty for none. `rule` and `fill`: see
    :func:`_own_choice`.
    """

    name: str
    mesh: int | None
    transform: NDArray[np.float64]
    colliders: tuple[Collider, ...]
    body: str
    rule: Rule | None
    fill: ObjectFill | None


@dataclass(eq=False, slots=True)
class StageTraversal:
    """A traversal of a stage. Instances share surfaces and meshes."""

    path: Path
    stage: Usd.Stage
    external_files: ExternalFiles
    log: WarningLog
    allowance: Allowance
    time: Usd.TimeCode
    opaque_from: float
    materials: Materials = field(init=False)
    _transforms: UsdGeom.XformCache = field(init=False)
    _deformed: dict[str, Deformed] = field(init=False)
    _surfaces: dict[str, Surface | None] = field(default_factory=dict)
    _rows: dict[tuple[str, tuple[Shading, ...], bytes], int] = field(default_factory=dict)
    _meshes: list[LoadedMesh] = field(default_factory=list)
    _open_instancers: list[str] = field(default_factory=list)
    _count: int = 0

    def __post_init__(self) -> None:
        images = Images(self.path, self.external_files, self.log, self.allowance)
        self.materials = Materials(self.path, images, MaterialTable(), self.log, self.time, self.opaque_from)
        self._transforms = UsdGeom.XformCache(self.time)
        self._deformed = deformed_meshes(self.stage, self.time, self.log)

    def objects(self, to_scene: NDArray[np.float64]) -> tuple[SceneObject, ...]:
        """Return the visible objects in the order of traversal.

        `to_scene`, float64, shape (4, 4), takes the stage's frame to the scene's.
        """
        placed = self._below(self.stage.GetPseudoRoot(), PREDICATE)
        transforms = self._to_scene(placed, to_scene)
        meshes = assign_materials(self._meshes, self.materials.table, self.log, self.opaque_from)
        bodies = {one.body for one in placed if one.body and one.colliders}
        objects = []
        nearest: dict[str, int] = {}  # material by path: that of the first visible object below
        for one, transform in zip(placed, transforms, strict=True):
            if one.mesh is None or not len(meshes[one.mesh].triangles):
                continue
            material = int(meshes[one.mesh].materials[0])
            for above in _ancestors(one.name):
                nearest.setdefault(above, material)
            represented = not one.colliders and one.body in bodies
            objects.append(
                SceneObject(
                    one.name,
                    meshes[one.mesh],
                    transform,
                    one.colliders,
                    material,
                    represented=represented,
                    rule=one.rule,
                    fill=one.fill,
                )
            )
        for one, transform in zip(placed, transforms, strict=True):
            if one.mesh is None:
                material = next((nearest[above] for above in _ancestors(one.name) if above in nearest), 0)
                material = material or self.materials.table.default(self.log)
                objects.append(
                    SceneObject(
                        one.name,
                        NO_TRIANGLES,
                        transform,
                        one.colliders,
                        material,
                        hidden=True,
                        rule=one.rule,
                        fill=one.fill,
                    )
                )
        return tuple(objects)

    def _to_scene(self, placed: list[_PlacedMesh], to_scene: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the transforms of objects to the scene's frame, float64, shape (N, 4, 4)."""
        own = np.array([one.transform for one in placed], np.float64).reshape(-1, 4, 4)
        with np.errstate(over="ignore", invalid="ignore"):
            transforms: NDArray[np.float64] = to_scene @ own
        broken = ~np.isfinite(transforms).all(axis=(1, 2))
        if broken.any():
            name = placed[int(np.argmax(broken))].name
            raise AssetError(self.path, "its transform is not finite", place=name, fix="repair its xformOps")
        projective = np.abs(own[:, 3] - (0, 0, 0, 1)).max(axis=1) > _AFFINE_TOLERANCE
        message = "the projective part of transforms that are not affine was ignored"
        self.log.add("transform", message, int(projective.sum()))
        transforms[projective, 3] = (0.0, 0.0, 0.0, 1.0)
        return transforms

    def _below(self, root: Usd.Prim, predicate: object) -> list[_PlacedMesh]:
        """Return the objects of `root` and its descendants, in the stage's frame."""
        placed: list[_PlacedMesh] = []
        walk = iter(Usd.PrimRange(root, predicate))
        for prim in walk:
            if not self._is_visible(prim):
                walk.PruneChildren()
                placed += self._hidden(prim, predicate)
            elif prim.IsA(UsdGeom.PointInstancer):
                walk.PruneChildren()
                placed += self._copies(prim)
            else:
                placed += self._object(prim)
        return placed

    def _copies(self, prim: Usd.Prim) -> list[_PlacedMesh]:
        place = str(prim.GetPath())
        if place in self._open_instancers:
            raise AssetError(self.path, "the point instancer copies itself", place=place, fix="repair its prototypes")
        self._open_instancers.append(place)
        prototypes, indices, transforms, numbers = placed_copies(prim, self.path, self.time, self.log)
        here = self._to_stage(prim)
        models: list[list[_PlacedMesh]] = []
        for index, prototype in enumerate(prototypes):
            model = self._below(prototype, _PROTOTYPE_PREDICATE) if (indices == index).any() else []
            back = np.linalg.inv(self._to_stage(prototype)) if model else np.eye(4)
            models.append([replace(one, transform=back @ one.transform) for one in model])
        self._open_instancers.pop()
        self._charge(int(sum(len(models[index]) for index in indices)))
        to_stage = here @ transforms
        ends: list[list[tuple[_PlacedMesh, str, str | None]]] = []  # of each model: how names and bodies of copies end
        moved: list[NDArray[np.float64]] = []  # by model and object: the transforms of its copies
        for index, prototype in enumerate(prototypes):
            source = str(prototype.GetPath())
            ends.append(
                [
                    (
                        one,
                        one.name.removeprefix(source),
                        one.body.removeprefix(source) if one.body.startswith(source) else None,
                    )
                    for one in models[index]
                ]
            )
            own = np.array([one.transform for one in models[index]]).reshape(-1, 1, 4, 4)
            moved.append(to_stage[indices == index] @ own)
        placed: list[_PlacedMesh] = []
        nth = [0] * len(prototypes)
        for index, number in zip(indices.tolist(), numbers.tolist(), strict=True):
            copy, at = f"{place}[{number}]", nth[index]
            nth[index] += 1
            for (one, name, body), of_copies in zip(ends[index], moved[index], strict=True):
                own_body = one.body if body is None else copy + body
                placed.append(
                    _PlacedMesh(copy + name, one.mesh, of_copies[at], one.colliders, own_body, one.rule, one.fill)
                )
        return placed

    def _charge(self, count: int) -> None:
        self._count += count
        if self._count > MOST_OBJECTS:
            raise DoesNotFitError(f"shows more than {MOST_OBJECTS:,} objects; make its instancers sparser")

    def _to_stage(self, prim: Usd.Prim) -> NDArray[np.float64]:
        return np.array(self._transforms.GetLocalToWorldTransform(prim), dtype=np.float64).T

    def _is_visible(self, prim: Usd.Prim) -> bool:
        """Tell whether the prim and its descendants are visible, as far as the prim decides it."""
        imageable = UsdGeom.Imageable(prim)
        if not imageable:
            return True
        if imageable.GetVisibilityAttr().Get(self.time) == UsdGeom.Tokens.invisible:
            self.log.add("invisible", "invisible prims and their descendants were left out")
            return False
        purpose = imageable.ComputePurpose()
        if purpose not in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render):
            self.log.add("purpose", f"prims of purpose {purpose} and their descendants were left out")
            return False
        return True

    def _hidden(self, root: Usd.Prim, predicate: object) -> list[_PlacedMesh]:
        """Return the colliders of `root` and its descendants, none of which is shown, as objects without a mesh."""
        placed = []
        ignored = WarningLog()  # what is not shown needs no warnings
        for prim in Usd.PrimRange(root, predicate):
            if not prim.HasAPI(UsdPhysics.CollisionAPI):
                continue
            source = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
            deformed = self._deformed.get(str(prim.GetPath()))
            surface = surface_of(source, self.path, self.time, ignored, deformed)
            colliders = () if surface is None else colliders_of(source, surface, self.time, ignored)
            if colliders:
                self._charge(1)
                transform = self._to_stage(deformed.frame if deformed else prim)
                placed.append(self._placed(prim, None, transform, colliders))
        self.log.add("collider", "colliders that are not shown count with geometry collider alone", len(placed))
        return placed

    def _object(self, prim: Usd.Prim) -> list[_PlacedMesh]:
        """Return the object of one prim, or none."""
        name = str(prim.GetPath())
        # Instances of one prim share its surface, unless each has its own pose. Equal solids share one, too.
        source = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        deformed = self._deformed.get(name)
        key = name if deformed else solid_key(source, self.time) or str(source.GetPath())
        if key not in self._surfaces:
            self._surfaces[key] = surface_of(source, self.path, self.time, self.log, deformed)
        surface = self._surfaces[key]
        if surface is None:
            self._count_without_surface(prim)
            return []
        shadings, rows = self.materials.shadings_of_faces(prim, surface)
        shared = (key, tuple(shadings), rows.tobytes())
        if shared not in self._rows:
            materials, appearance = self.materials.assign(prim, surface, shadings, rows)
            self._rows[shared] = len(self._meshes)
            normals = None if deformed else authored_normals(source, surface, self.time, self.log)
            self._meshes.append(LoadedMesh(surface.positions, surface.triangles, materials, appearance, normals))
        self._charge(1)
        colliders = colliders_of(source, surface, self.time, self.log)
        transform = self._to_stage(deformed.frame if deformed else prim)
        return [self._placed(prim, self._rows[shared], transform, colliders)]

    def _placed(
        self, prim: Usd.Prim, mesh: int | None, transform: NDArray[np.float64], colliders: tuple[Collider, ...]
    ) -> _PlacedMesh:
        rule, fill = _own_choice(prim, "rule", RULES, self.path), _own_choice(prim, "fill", OBJECT_FILLS, self.path)
        return _PlacedMesh(str(prim.GetPath()), mesh, transform, colliders, _body_of(prim), rule, fill)

    def _count_without_surface(self, prim: Usd.Prim) -> None:
        """Count a prim without a surface."""
        kind = str(prim.GetTypeName())
        if prim.HasAPI(UsdPhysics.CollisionAPI):
            self.log.add("collider", "colliders on prims without a shape were ignored")
        if prim.IsA(UsdGeom.Gprim) and not prim.IsA(UsdGeom.Mesh):
            self.log.add("unsupported-prim", f"{kind} prims are not supported and were left out")
        elif not prim.IsA(UsdGeom.Mesh) and kind not in _WITHOUT_SHAPE and prim.IsA(UsdGeom.Imageable):
            self.log.add("no-shape", f"{kind} prims have no shape and were left out")


def _body_of(prim: Usd.Prim) -> str:
    """Return the path of the rigid body that a prim is part of: its own or its nearest ancestor's; empty for none."""
    while prim and not prim.HasAPI(UsdPhysics.RigidBodyAPI):
        prim = prim.GetParent()
    return str(prim.GetPath()) if prim else ""


def _ancestors(path: str) -> Iterator[str]:
    """Yield a prim path's ancestors, the nearest first, and at last the empty path of all."""
    while path:
        path = path.rpartition("/")[0]
        yield path


T = TypeVar("T", bound=str)


def _own_choice(prim: Usd.Prim, name: str, choices: tuple[T, ...], path: Path) -> T | None:
    """Return what a prim says by the token ``voxrt:NAME``, or its nearest ancestor; None for what the build says."""
    attribute = f"voxrt:{name}"
    at = prim
    while at and not at.HasAttribute(attribute):
        at = at.GetParent()
    wanted = at.GetAttribute(attribute).Get() if at else None
    if wanted is None or wanted in choices:
        return wanted
    place = f"{at.GetPath()}.{attribute}"
    raise AssetError(path, f"{str(wanted)[:60]!r} is no {name}", place=place, fix=f"name one of {', '.join(choices)}")
