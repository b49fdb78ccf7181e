"""The evaluated scene of Blender to a :class:`~voxrt.voxelize.scene.Scene`."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from voxrt.voxelize.collider_shapes import Collider, collider_around
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.formats.authored_properties import PREFIX, ObjectProperties, checked_properties
from voxrt.voxelize.formats.blend.axes import placed
from voxrt.voxelize.formats.blend.colliders import rigid_collider
from voxrt.voxelize.formats.blend.images import Images
from voxrt.voxelize.formats.blend.materials import Materials
from voxrt.voxelize.formats.blend.meshes import MeshArrays, colours, coordinates, read_triangles
from voxrt.voxelize.formats.blend.views import read_daylight, read_viewpoint
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.opacity import OPAQUE_FROM, log_left_out
from voxrt.voxelize.materials import DEFAULT_COLOUR, Material
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.blend.materials import SurfaceMaterial
    from voxrt.voxelize.mesh import Mesh
    from voxrt.voxelize.scene import Viewpoint

_WITHOUT_VOXELS = {
    "VOLUME": "volumes",
    "POINTCLOUD": "point clouds",
    "CURVES": "hair curves",
    "GREASEPENCIL": "grease pencils",
    "GPENCIL": "grease pencils",
}


def read_depsgraph(
    depsgraph: Any, named: Any, name: str, *, path: object = "", opaque_from: float = OPAQUE_FROM
) -> Scene:
    """Read what an evaluated dependency graph shows: objects as their modifiers and node groups make them.

    Parameters
    ----------
    depsgraph
        A ``bpy.types.Depsgraph``; that of a render has what renders show.
    named
        The file's materials, ``bpy.data.materials``, of which the property `voxrt_material` names one.
    name
        The scene's name.
    path
        What errors call it; empty for the name.
    opaque_from
        Faces of lower opacity are left out.

    Returns
    -------
    Scene
        One object per object and instance; instances share their meshes. The first camera is the scene's.

    Raises
    ------
    AssetError
        A property for voxrt is wrong, an image too large, or there are no triangles.
    DoesNotFitError
        More than 255 materials.
    """
    return SceneReader(named, path or name, opaque_from).scene(depsgraph, name)


class _Placed(Struct, frozen=True, eq=False):
    """An object before its mesh has its materials."""

    name: str
    mesh: int  # a row of the loaded meshes
    transform: NDArray[np.float64]
    properties: ObjectProperties
    collider: Collider | None


class _Instance(Struct, frozen=True):
    """An object that is no instance, in the place of a ``bpy.types.DepsgraphObjectInstance``."""

    object: Any
    matrix_world: Any
    is_instance: bool = False
    show_self: bool = True


class SceneReader:
    """Reads a scene, and single objects of it again. Arguments are those of :func:`read_depsgraph`."""

    def __init__(self, named: Any, path: object, opaque_from: float = OPAQUE_FROM) -> None:
        self._path = path
        self._opaque_from = opaque_from
        self._log = WarningLog()
        self._table = MaterialTable()
        self._images = Images(path, self._log)
        self._materials = Materials(named, self._log, self._error, opaque_from)
        self._arrays: dict[int, MeshArrays] = {}  # by the address of the mesh
        self._colliders: dict[tuple[int, str], Collider | None] = {}  # by the row of the mesh
        self._rows: dict[tuple[object, ...], int] = {}
        self._loaded: list[LoadedMesh] = []

    def scene(self, depsgraph: Any, name: str) -> Scene:
        """Read a whole scene, as :func:`read_depsgraph` does; once."""
        things = [one for instance in depsgraph.object_instances if (one := self._placed(instance)) is not None]
        cameras = self._cameras(depsgraph)
        meshes = assign_materials(self._loaded, self._table, self._log, self._opaque_from)
        repeats = Counter(one.name for one in things)
        numbers: Counter[str] = Counter()
        objects = []
        for one in things:
            mesh = meshes[one.mesh]
            if not len(mesh.triangles):
                continue
            called = one.name
            if repeats[called] > 1:
                called = f"{called} [{numbers[called]}]"
                numbers[one.name] += 1
            objects.append(self._object(called, one, mesh))
        objects += self._hidden(depsgraph)
        if not objects:
            raise self._nothing_shown(depsgraph.scene)
        materials = self._table.materials()
        sky = read_daylight(depsgraph).sky
        if sky is not None:
            materials = (Material(materials[0].name, sky), *materials[1:])
        viewpoint = cameras[0] if cameras else None
        return Scene(name, tuple(objects), materials, self._log.warnings(), viewpoint=viewpoint, cameras=cameras)

    def _nothing_shown(self, scene: Any) -> AssetError:
        """Return the error for a scene without triangles; it says what the scene has instead."""
        kinds = Counter(one.type.replace("GREASEPENCIL", "grease pencil").lower() for one in scene.objects)
        has = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())) or "no objects"
        meshes = sum(one.type == "MESH" and one.hide_render for one in scene.objects)
        fix = (
            f"show a mesh in renders: hidden from them are {meshes}"
            if meshes
            else "check that renders of that scene show a mesh"
        )
        return AssetError(self._path, f"has no triangles to voxelize: the scene {scene.name!r} has {has}", fix=fix)

    def _hidden(self, depsgraph: Any) -> list[SceneObject]:
        """Return the rigid bodies that renders do not show, as colliders without a mesh; modifiers do not count."""
        found: list[SceneObject] = []
        if depsgraph.mode != "RENDER":
            return found
        for one in depsgraph.view_layer.objects:
            if one.type != "MESH" or one.rigid_body is None or not one.hide_render or not len(one.data.polygons):
                continue
            authored = self._properties(one)
            if authored is None:
                continue
            collider = rigid_collider(one.rigid_body, read_triangles(one.data), self._log)
            if collider is not None:
                material = self._materials.of(one.active_material)
                number = self._uniform(replace(material, cutoff=0.0), 1)
                transform = placed(one.matrix_world)
                found.append(
                    SceneObject(
                        one.name,
                        transform=transform,
                        colliders=(collider,),
                        collider_material=number,
                        hidden=True,
                        rule=authored.voxrt_rule,
                        fill=authored.voxrt_fill,
                    )
                )
        self._log.add("collider", "colliders that are not shown count with geometry collider alone", len(found))
        return found

    def again(self, one: Any) -> tuple[SceneObject, tuple[Material, ...]] | None:
        """Read an evaluated object that was edited, and all materials so far.

        None where it cannot be read by itself: it shows textures or colour attributes, or nothing, or there are more
        than 255 materials, with those that no object has any more.
        """
        if one.type != "MESH":
            return None
        self._arrays.pop(one.data.as_pointer(), None)
        for key in [key for key in self._rows if key[0] == one.data.as_pointer()]:
            del self._rows[key]
        try:
            thing = self._placed(_Instance(one, one.matrix_world))
            if thing is None or self._loaded[thing.mesh].appearance is not None:
                return None
            mesh = assign_materials([self._loaded[thing.mesh]], self._table, self._log, self._opaque_from)[0]
        except DoesNotFitError:
            return None
        if not len(mesh.triangles):
            return None
        return self._object(thing.name, thing, mesh), self._table.materials()

    def _object(self, name: str, one: _Placed, mesh: Mesh) -> SceneObject:
        material = int(mesh.materials[0])
        collider = one.collider
        if one.properties.voxrt_collider is not None:
            collider = collider_around(one.properties.voxrt_collider, mesh.positions, mesh.triangles)
        if collider is not None and (mesh.materials != material).any():
            self._log.add("collider-material", "colliders of objects with several materials took the first of them")
        colliders = () if collider is None else (collider,)
        rule, fill = one.properties.voxrt_rule, one.properties.voxrt_fill
        return SceneObject(name, mesh, one.transform, colliders, material, rule=rule, fill=fill)

    def _error(self, place: str, problem: str, fix: str) -> AssetError:
        return AssetError(self._path, problem, place=place, fix=fix)

    def _placed(self, instance: Any) -> _Placed | None:
        one = instance.object
        if one.type != "MESH":
            if one.type in _WITHOUT_VOXELS:
                self._log.add("unsupported", f"{_WITHOUT_VOXELS[one.type]} were left out: they have no surface")
            return None
        if not instance.show_self or not len(one.data.polygons):
            return None
        name = one.name
        if instance.is_instance and instance.parent is not None and instance.parent.name != name:
            name = f"{instance.parent.name}/{name}"
        properties = self._properties(one)
        if properties is None:
            return None
        transform = placed(instance.matrix_world)
        if not np.isfinite(transform).all():
            raise self._error(
                f"object {one.name!r}", "the transform is not finite", "clear its scale and its constraints"
            )
        key = one.data.as_pointer()
        if key not in self._arrays:
            self._arrays[key] = self._triangles(one)
        arrays = self._arrays[key]
        row = self._mesh(one, key, arrays, properties)
        collider = None
        if one.rigid_body is not None:
            shape = row, one.rigid_body.collision_shape
            if shape not in self._colliders:
                self._colliders[shape] = rigid_collider(one.rigid_body, arrays, self._log)
            collider = self._colliders[shape]
        return _Placed(name, row, transform, properties, collider)

    def _triangles(self, one: Any) -> MeshArrays:
        arrays = read_triangles(one.data)
        finite = np.isfinite(arrays.positions).all(axis=1)
        if not finite.all():
            place = f"object {one.name!r}, vertex {int(np.argmin(finite))}"
            raise self._error(place, "its coordinates are not finite", "delete it, or the modifier that makes it")
        return arrays

    def _properties(self, one: Any) -> ObjectProperties | None:
        """Return what an object says to voxrt; None where that is to leave it out."""
        authored = checked_properties(
            {key: one[key] for key in one.keys() if key.startswith(PREFIX)},  # noqa: SIM118 - not a dict
            ObjectProperties,
            f"object {one.name!r}",
            self._error,
        )
        if not authored.voxrt_ignore:
            return authored
        self._log.add("ignored", "objects with voxrt_ignore were left out")
        return None

    def _mesh(self, one: Any, key: int, arrays: MeshArrays, properties: ObjectProperties) -> int:
        """Return the row of an object's mesh with the materials of its slots."""
        slots = [slot.material for slot in one.material_slots]
        mirrored = bool(properties.voxrt_reflect)
        if properties.voxrt_material is not None:
            place = f"object {one.name!r}.voxrt_material"
            slots = [self._materials.called(properties.voxrt_material, place)] * max(len(slots), 1)
        shared = key, mirrored, *(slot and slot.name_full for slot in slots)
        if shared not in self._rows:
            spans = [
                (
                    self._materials.of(slots[min(slot, len(slots) - 1)] if slots else None, mirrored=mirrored),
                    start,
                    stop,
                )
                for slot, start, stop in arrays.spans()
            ]
            self._rows[shared] = len(self._loaded)
            self._loaded.append(self._painted(one.data, arrays, spans))
        return self._rows[shared]

    def _painted(self, mesh: Any, arrays: MeshArrays, spans: list[tuple[SurfaceMaterial, int, int]]) -> LoadedMesh:
        count = len(arrays.triangles)
        materials = np.zeros(count, np.uint8)
        entries: list[Appearance] = []
        rows = np.full(count, -1, np.int32)
        uv: NDArray[np.float64] | None = None
        tints: NDArray[np.float32] | None = None
        for material, start, stop in spans:
            part = slice(start, stop)
            texture, places = self._texture(mesh, arrays, material, part)
            tint = None
            if material.attribute is not None:
                tint = colours(mesh, material.attribute, arrays)
                if tint is None:
                    self._log.add("colour-attribute", "colour attributes that a mesh does not have were taken as white")
                elif (tint[part] == 1).all():
                    tint = None
            if texture is None and tint is None:
                materials[part] = self._uniform(material, stop - start)
                continue
            uv = np.zeros((count, 3, 2)) if uv is None else uv
            tints = np.ones((count, 3, 4), np.float32) if tints is None else tints
            rows[part] = len(entries)
            entries.append(Appearance(material.name, material.factor, texture, material.cutoff, material.mirror))
            if places is not None:
                uv[part] = places
            if tint is not None:
                tints[part] = tint[part]
        appearance = None
        if uv is not None and tints is not None:
            appearance = SurfaceAppearance(tuple(entries), rows, uv, tints)
        return LoadedMesh(arrays.positions, arrays.triangles, materials, appearance, arrays.normals)

    def _uniform(self, material: SurfaceMaterial, faces: int) -> int:
        """Return the id of a material of one colour; 0 where it is not opaque enough."""
        if material.factor[3] < material.cutoff:
            log_left_out(self._log, material.factor[3], material.cutoff, self._opaque_from, faces)
            return 0
        if not material.authored:
            self._log.add("default-material", "faces without a material got the default one", faces)
            return self._table.id_of(
                material.key, material.name, DEFAULT_COLOUR, mirror=material.mirror, authored=False
            )
        red, green, blue = srgb_from_linear(material.factor[:3]).tolist()
        found = self._table.id_of(material.key, material.name, (red, green, blue), mirror=material.mirror)
        if self._table.materials()[found].colour != (red, green, blue):
            message = f"materials renamed {material.name!r} took the colour of the first"
            self._log.add("merged-materials", message)
        return found

    def _texture(
        self, mesh: Any, arrays: MeshArrays, material: SurfaceMaterial, part: slice
    ) -> tuple[Any, NDArray[np.float64] | None]:
        """Return a material's texture and its coordinates at some triangles, v downwards; None and None for none."""
        use = material.image or material.opacity
        if use is None:
            return None, None
        places = coordinates(mesh, use.uv)
        if places is None:
            self._log.add("texture", "meshes without the UV map that their texture needs took the colour of its factor")
            return None, None
        texture = self._images.texture(material.image, material.opacity, material.channel)
        if texture is None:
            return None, None
        if use.transform is not None:
            places = places @ use.transform[:2, :2].T + use.transform[:2, 2]
        flipped = places[arrays.corners[part]]
        flipped[..., 1] = 1.0 - flipped[..., 1]
        return texture, flipped

    def _cameras(self, depsgraph: Any) -> tuple[Viewpoint, ...]:
        """Return the perspective cameras, the scene's own first."""
        own = depsgraph.scene.camera
        found: list[Viewpoint] = []
        for instance in depsgraph.object_instances:
            camera = instance.object
            if camera.type != "CAMERA" or instance.is_instance:
                continue
            viewpoint = read_viewpoint(depsgraph, camera, self._log)
            if viewpoint is not None:
                is_own = own is not None and camera.name_full == own.name_full
                found.insert(0 if is_own else len(found), viewpoint)
        return tuple(found)
