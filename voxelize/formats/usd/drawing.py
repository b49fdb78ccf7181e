"""Which prims of a stage are drawn, where, and of what."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom, UsdPhysics

from voxrt.voxelize.colour.material_table import MaterialTable
from voxrt.voxelize.colour.painted import Unfinished, finish
from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.formats.usd.geometry import Surface, solid_key, surface_of
from voxrt.voxelize.formats.usd.instancer import placed_copies
from voxrt.voxelize.formats.usd.materials import Materials
from voxrt.voxelize.formats.usd.physics import colliders_of
from voxrt.voxelize.formats.usd.skin import PREDICATE, Deformed, deformed_meshes
from voxrt.voxelize.scene import SceneObject

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.companions import Companions
    from voxrt.voxelize.formats.usd.looks import Look
    from voxrt.voxelize.notes import Notes
    from voxrt.voxelize.scene import Collider

MOST_OBJECTS = 1_000_000
"""A few lines of nested instancers may ask for more copies than there is memory."""

# Prims that hold others or describe them, and have no shape themselves.
_WITHOUT_SHAPE = frozenset(("", "Xform", "Scope", "Material", "Shader", "NodeGraph", "GeomSubset", "SkelRoot"))

# Prototypes may hang below prims that are only spoken of (``over``) or abstract (``class``).
_PROTOTYPE_PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimIsActive & Usd.PrimIsLoaded)


@dataclass(frozen=True, eq=False, slots=True)
class _Drawn:
    """An object whose mesh, a row of the drawing's, is not finished yet."""

    name: str
    mesh: int
    transform: NDArray[np.float64]
    colliders: tuple[Collider, ...]


@dataclass(eq=False, slots=True)
class Drawing:
    """A walk over a stage; surfaces and meshes are made once and shared by instances."""

    path: Path
    stage: Usd.Stage
    companions: Companions
    notes: Notes
    time: Usd.TimeCode
    materials: Materials = field(init=False)
    _placed: UsdGeom.XformCache = field(init=False)
    _deformed: dict[str, Deformed] = field(init=False)
    _surfaces: dict[str, Surface | None] = field(default_factory=dict)
    _rows: dict[tuple[str, tuple[Look, ...], bytes], int] = field(default_factory=dict)
    _meshes: list[Unfinished] = field(default_factory=list)
    _within: list[str] = field(default_factory=list)
    _count: int = 0

    def __post_init__(self) -> None:
        self.materials = Materials(self.path, self.companions, MaterialTable(), self.notes, self.time)
        self._placed = UsdGeom.XformCache(self.time)
        self._deformed = deformed_meshes(self.stage, self.time, self.notes)

    def objects(self, to_scene: NDArray[np.float64]) -> tuple[SceneObject, ...]:
        """Return everything that is drawn, in the order of the stage's traversal.

        Parameters
        ----------
        to_scene
            float64, shape (4, 4): from the stage's frame to the scene's.
        """
        drawn = self._below(self.stage.GetPseudoRoot(), PREDICATE)
        for one in drawn:
            if not np.isfinite(one.transform).all():
                raise AssetError(self.path, "its transform has no finite value", place=one.name)
        meshes = finish(self._meshes, self.materials.table, self.notes)
        return tuple(
            SceneObject(
                one.name,
                meshes[one.mesh],
                to_scene @ one.transform,
                one.colliders,
                int(meshes[one.mesh].materials[0]),
            )
            for one in drawn
            if len(meshes[one.mesh].triangles)
        )

    def _below(self, root: Usd.Prim, predicate: object) -> list[_Drawn]:
        """Draw `root` and what is below it, in the stage's frame."""
        drawn: list[_Drawn] = []
        walk = iter(Usd.PrimRange(root, predicate))
        for prim in walk:
            if not self._is_drawn(prim):
                walk.PruneChildren()
            elif prim.IsA(UsdGeom.PointInstancer):
                walk.PruneChildren()
                drawn += self._copies(prim)
            else:
                drawn += self._object(prim)
        return drawn

    def _copies(self, prim: Usd.Prim) -> list[_Drawn]:
        place = str(prim.GetPath())
        if place in self._within:
            raise AssetError(self.path, "the point instancer copies itself", place=place, fix="repair its prototypes")
        self._within.append(place)
        prototypes, indices, transforms, numbers = placed_copies(prim, self.path, self.time, self.notes)
        here = self._to_stage(prim)
        models: list[list[_Drawn]] = []
        for index, prototype in enumerate(prototypes):
            model = self._below(prototype, _PROTOTYPE_PREDICATE) if (indices == index).any() else []
            back = np.linalg.inv(self._to_stage(prototype)) if model else np.eye(4)
            models.append([_Drawn(one.name, one.mesh, back @ one.transform, one.colliders) for one in model])
        self._within.pop()
        self._charge(int(sum(len(models[index]) for index in indices)))
        drawn: list[_Drawn] = []
        for index, to_instancer, number in zip(indices.tolist(), here @ transforms, numbers.tolist(), strict=True):
            for one in models[index]:
                name = f"{place}[{number}]{one.name.removeprefix(str(prototypes[index].GetPath()))}"
                drawn.append(_Drawn(name, one.mesh, to_instancer @ one.transform, one.colliders))
        return drawn

    def _charge(self, count: int) -> None:
        self._count += count
        if self._count > MOST_OBJECTS:
            raise DoesNotFitError(f"{self.path}: draws more than {MOST_OBJECTS:,} objects; make its instancers sparser")

    def _to_stage(self, prim: Usd.Prim) -> NDArray[np.float64]:
        return np.array(self._placed.GetLocalToWorldTransform(prim), dtype=np.float64).T

    def _is_drawn(self, prim: Usd.Prim) -> bool:
        """Whether the prim and what is below it are drawn, as far as the prim itself says."""
        imageable = UsdGeom.Imageable(prim)
        if not imageable:
            return True
        if imageable.GetVisibilityAttr().Get(self.time) == UsdGeom.Tokens.invisible:
            self.notes.add("invisible", "invisible prims were left out, with what is below them")
            return False
        purpose = imageable.ComputePurpose()
        if purpose not in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render):
            self.notes.add("purpose", f"prims of purpose {purpose} were left out, with what is below them")
            colliders = sum(one.HasAPI(UsdPhysics.CollisionAPI) for one in Usd.PrimRange(prim, PREDICATE))
            if colliders:
                self.notes.add("collider", f"colliders of purpose {purpose} were left out", colliders)
            return False
        return True

    def _object(self, prim: Usd.Prim) -> list[_Drawn]:
        """Draw one prim: an object, or none."""
        name = str(prim.GetPath())
        # Instances of one prim share its surface, unless each has a pose of its own; so do equal solids.
        source = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        deformed = self._deformed.get(name)
        key = name if deformed else solid_key(source, self.time) or str(source.GetPath())
        if key not in self._surfaces:
            self._surfaces[key] = surface_of(source, self.path, self.time, self.notes, deformed)
        surface = self._surfaces[key]
        if surface is None:
            self._note_undrawn(prim)
            return []
        looks, rows = self.materials.looks_of_faces(prim, surface)
        shared = (key, tuple(looks), rows.tobytes())
        if shared not in self._rows:
            materials, coat = self.materials.wear(prim, surface, looks, rows)
            self._rows[shared] = len(self._meshes)
            self._meshes.append(Unfinished(surface.positions, surface.triangles, materials, coat))
        self._charge(1)
        colliders = colliders_of(source, surface, self.time, self.notes)
        transform = self._to_stage(deformed.frame if deformed else prim)
        return [_Drawn(name, self._rows[shared], transform, colliders)]

    def _note_undrawn(self, prim: Usd.Prim) -> None:
        """Count a prim that has no surface."""
        kind = str(prim.GetTypeName())
        if prim.HasAPI(UsdPhysics.CollisionAPI):
            self.notes.add("collider", "colliders on prims that have no shape themselves were ignored")
        if prim.IsA(UsdGeom.Gprim) and not prim.IsA(UsdGeom.Mesh):
            self.notes.add("unsupported-prim", f"{kind} prims are not honoured")
        elif not prim.IsA(UsdGeom.Mesh) and kind not in _WITHOUT_SHAPE and prim.IsA(UsdGeom.Imageable):
            self.notes.add("no-shape", f"{kind} prims have no shape and were left out")
