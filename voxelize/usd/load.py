"""A USD stage to a scene: which prims are drawn, where, and of what."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from pxr import Tf, Usd, UsdGeom, UsdPhysics, UsdShade

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.frames import scene_transform
from voxrt.voxelize.material_table import MaterialTable
from voxrt.voxelize.notes import Notes
from voxrt.voxelize.scene import Mesh, Scene, SceneObject
from voxrt.voxelize.usd.diagnostics import caught
from voxrt.voxelize.usd.geometry import Surface, surface_of
from voxrt.voxelize.usd.materials import Materials
from voxrt.voxelize.usd.physics import colliders_of

# Prims that hold others or describe them, and have no shape themselves.
_WITHOUT_SHAPE = frozenset(("", "Xform", "Scope", "Material", "Shader", "NodeGraph", "GeomSubset", "SkelRoot"))


def load_usd(path: str | Path) -> Scene:
    """Read a USD stage.

    Drawn are the active, visible prims of purpose ``default`` and ``render``, instances included, at the stage's
    start time. The unit and the up axis are the root layer's, as USD has it: layers that it refers to are not rescaled.

    Parameters
    ----------
    path
        A ``.usd``, ``.usda``, ``.usdc`` or ``.usdz`` file.

    Returns
    -------
    Scene
        One object a prim, named by its prim path; materials in order of first use.

    Raises
    ------
    AssetError
        The stage cannot be opened, contradicts itself, or draws nothing.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    notes = Notes()
    with caught(path, notes):
        stage = Usd.Stage.Open(str(path))
        reader = _Reader(path, stage, notes)
        objects = reader.objects()
    if not objects:
        said = "; ".join(one.message for one in notes.warnings())
        raise AssetError(path, "draws nothing" + (f" ({said})" if said else ""), fix="check it with usdview")
    return Scene(path.stem, objects, reader.materials.table.materials(), notes.warnings())


@dataclass(eq=False, slots=True)
class _Reader:
    path: Path
    stage: Usd.Stage
    notes: Notes
    time: Usd.TimeCode = field(init=False)
    materials: Materials = field(init=False)
    surfaces: dict[str, Surface | None] = field(default_factory=dict)
    meshes: dict[tuple[str, bytes], Mesh] = field(default_factory=dict)

    def __post_init__(self) -> None:
        timed = self.stage.HasAuthoredTimeCodeRange()
        self.time = Usd.TimeCode(self.stage.GetStartTimeCode()) if timed else Usd.TimeCode.EarliestTime()
        self.materials = Materials(MaterialTable(), self.notes, self.time)

    def objects(self) -> tuple[SceneObject, ...]:
        """Everything that is drawn, in the order of the stage's traversal."""
        to_scene = scene_transform(self._up(), self._unit())
        self._note_layers_that_disagree()
        placed = UsdGeom.XformCache(self.time)
        objects: list[SceneObject] = []
        prims = Usd.PrimRange(self.stage.GetPseudoRoot(), Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate))
        walk = iter(prims)
        for prim in walk:
            if not self._is_drawn(prim):
                walk.PruneChildren()
                continue
            surface = self._surface(prim)
            if surface is None:
                if self._note_undrawn(prim):
                    walk.PruneChildren()
                continue
            transform = to_scene @ np.array(placed.GetLocalToWorldTransform(prim), dtype=np.float64).T
            if not np.isfinite(transform).all():
                raise AssetError(self.path, "its transform has no finite value", place=str(prim.GetPath()))
            made = self._object(prim, surface, transform)
            if made is not None:
                objects.append(made)
        return tuple(objects)

    def _up(self) -> str:
        up = str(UsdGeom.GetStageUpAxis(self.stage))
        if up.lower() not in ("x", "y", "z"):
            self.notes.add("up-axis", f"upAxis {up!r} is none of X, Y, Z; Y was taken")
            return "y"
        return up.lower()

    def _unit(self) -> float:
        try:
            unit = float(UsdGeom.GetStageMetersPerUnit(self.stage))
        except Tf.ErrorException:  # some exporters store a float where USD wants a double
            unit = float(self.stage.GetRootLayer().pseudoRoot.GetInfo("metersPerUnit"))
        if not (math.isfinite(unit) and unit > 0):
            raise AssetError(self.path, f"metersPerUnit {unit} is no length", fix="give a positive number of metres")
        return unit

    def _note_layers_that_disagree(self) -> None:
        root = self.stage.GetRootLayer()
        for key, says in (("metersPerUnit", "unit"), ("upAxis", "up axis")):
            own = root.pseudoRoot.GetInfo(key)
            other = [
                layer
                for layer in self.stage.GetUsedLayers()
                if layer != root and layer.pseudoRoot.HasInfo(key) and layer.pseudoRoot.GetInfo(key) != own
            ]
            self.notes.add(
                "layers-disagree", f"layers of another {says} were taken in the root layer's, as USD does", len(other)
            )

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
            return False
        return True

    def _surface(self, prim: Usd.Prim) -> Surface | None:
        # Instances of one prim share its surface.
        source = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        key = str(source.GetPath())
        if key not in self.surfaces:
            self.surfaces[key] = surface_of(source, self.path, self.time, self.notes)
        return self.surfaces[key]

    def _note_undrawn(self, prim: Usd.Prim) -> bool:
        """Count a prim that has no surface here; True where nothing below it is drawn either."""
        kind = str(prim.GetTypeName())
        if prim.HasAPI(UsdPhysics.CollisionAPI):
            self.notes.add("collider", "colliders on prims that have no shape themselves were ignored")
        if prim.IsA(UsdGeom.PointInstancer):
            self.notes.add("point-instancer", "point instancers are not honoured; their copies are missing")
            return True
        if prim.IsA(UsdGeom.Gprim) and not prim.IsA(UsdGeom.Mesh):
            self.notes.add("unsupported-prim", f"{kind} prims are not honoured")
        elif not prim.IsA(UsdGeom.Mesh) and kind not in _WITHOUT_SHAPE and prim.IsA(UsdGeom.Imageable):
            self.notes.add("no-shape", f"{kind} prims have no shape and were left out")
        return False

    def _object(self, prim: Usd.Prim, surface: Surface, transform: np.ndarray) -> SceneObject | None:
        materials = self._materials_of_faces(prim, surface)[surface.faces]
        solid = materials != 0
        if not solid.any():
            return None
        source = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        key = (str(source.GetPath()), materials.tobytes())
        if key not in self.meshes:
            triangles = surface.triangles if solid.all() else surface.triangles[solid]
            self.meshes[key] = Mesh(surface.positions, triangles, materials[solid])
        colliders = colliders_of(source, surface, self.time, self.notes)
        first = int(materials[solid][0])
        return SceneObject(str(prim.GetPath()), self.meshes[key], transform, colliders, first)

    def _materials_of_faces(self, prim: Usd.Prim, surface: Surface) -> np.ndarray:
        """uint8, a face each; 0 for air."""
        ids = np.zeros(surface.face_count, dtype=np.uint8)
        left = np.ones(surface.face_count, dtype=bool)
        for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
            indices = np.array(subset.GetIndicesAttr().Get(self.time) or (), dtype=np.int64)
            inside = indices[(indices >= 0) & (indices < surface.face_count)]
            if len(inside) != len(indices):
                problem = f"a face subset names faces beyond the mesh's {surface.face_count}"
                raise AssetError(self.path, problem, place=str(subset.GetPath()), fix="export the mesh again")
            number = self.materials.of_subset(subset, len(inside))
            if number is not None:
                ids[inside] = number
                left[inside] = False
        without = np.unique(surface.faces[left[surface.faces]])
        if len(without):
            ids[left] = self.materials.of_prim(prim, len(without))
        return ids
