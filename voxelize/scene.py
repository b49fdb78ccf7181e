"""The scene: what every loader makes and the voxelizer takes.

Scene frame: right-handed, metres, y up. A material's id is its index in :attr:`Scene.materials`; id 0 is empty space.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import field
from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.collider_shapes import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.materials import MATERIAL_LIMIT, Material
from voxrt.voxelize.mesh import NO_TRIANGLES, Mesh
from voxrt.voxelize.point_cloud import PointCloud
from voxrt.voxelize.rules import OBJECT_FILLS, RULES, ObjectFill, Rule
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.errors import SceneWarning


class SceneObject(Value, frozen=True, eq=False):
    """One object of the scene.

    Attributes
    ----------
    name
        The author's name, with the path in the file where names repeat.
    mesh
        Its triangles; instances of one mesh hold the same value. Without triangles for an object of points or of
        colliders alone.
    transform
        float64, shape (4, 4), affine, column vectors: object frame to scene frame. May mirror.
    colliders
        The colliders that its author gave it; they are filled with `collider_material`.
    collider_material
        Material id 1 … 255.
    hidden
        Whether it is not shown: its colliders count with ``geometry="collider"`` alone, its triangles never.
    represented
        Whether other objects' colliders stand for it with ``geometry="collider"``: it needs none of its own.
    points
        Its points, which become voxels where it has no colliders; None for none. :func:`place_points` makes the mesh
        that is voxelized in their place.
    rule
        Which voxels it fills, as :func:`voxelize` takes it; None for what the build says.
    fill
        Whether what it encloses is filled, as :func:`voxelize` takes it; None for what the build says.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind or range, or a transform that is not affine and finite.

    Examples
    --------
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [1])
    >>> SceneObject("sail", mesh)
    SceneObject(name='sail', mesh=Mesh(vertices=3, triangles=1), colliders=0)
    """

    name: str
    mesh: Mesh = NO_TRIANGLES
    transform: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    colliders: tuple[Collider, ...] = ()
    collider_material: int = 1
    hidden: bool = False
    represented: bool = False
    points: PointCloud | None = None
    rule: Rule | None = None
    fill: ObjectFill | None = None

    def __post_init__(self) -> None:
        arguments.text("SceneObject.name", self.name)
        arguments.instance("SceneObject.mesh", self.mesh, Mesh)
        transform = arguments.real_array("SceneObject.transform", self.transform, (4, 4))
        x, y, z, w = transform[3].tolist()
        if max(abs(x), abs(y), abs(z), abs(w - 1)) > _AFFINE_TOLERANCE:
            raise ValueError(f"SceneObject.transform must be affine: its last row is {transform[3].tolist()}")
        colliders = tuple(self.colliders)
        for index, one in enumerate(colliders):
            if not isinstance(one, (BoxCollider, SphereCollider, HullCollider, MeshCollider)):
                raise TypeError(f"SceneObject.colliders[{index}] must be a collider, not {type(one).__name__}")
        material = arguments.whole("SceneObject.collider_material", self.collider_material, 1, MATERIAL_LIMIT)
        if self.points is not None:
            arguments.instance("SceneObject.points", self.points, PointCloud)
        if self.rule is not None:
            arguments.choice("SceneObject.rule", self.rule, RULES)
        if self.fill is not None:
            arguments.choice("SceneObject.fill", self.fill, OBJECT_FILLS)
        force_setattr(self, "transform", transform.astype(np.float64, copy=False))
        force_setattr(self, "colliders", colliders)
        force_setattr(self, "collider_material", material)
        force_setattr(self, "hidden", arguments.flag("SceneObject.hidden", self.hidden))
        force_setattr(self, "represented", arguments.flag("SceneObject.represented", self.represented))

    def __repr__(self) -> str:
        shape = f"mesh={self.mesh!r}" if self.points is None else f"points={self.points!r}"
        return f"SceneObject(name={self.name!r}, {shape}, colliders={len(self.colliders)})"


_AFFINE_TOLERANCE = 1e-6


class Viewpoint(Value, frozen=True):
    """The camera that an author gave a scene.

    Attributes
    ----------
    eye, target
        Metres, scene frame: the camera's position and a point straight ahead, in the middle of a picture that is not
        shifted.
    field_of_view
        Degrees from the picture's top to its bottom, between 0 and 180; None where the author does not say.
    up
        The direction that points up in the picture, scene frame, of any length; None for the scene's y axis.
    name
        The author's name for it; empty for none.
    shift
        How far the middle of the picture lies to the right of the point straight ahead, and above it, in heights of the
        picture: the shift of an architect's lens.

    Raises
    ------
    TypeError, ValueError
        A point that is not three finite numbers, an eye at the target, a direction without length, or a field of view
        out of range.

    Examples
    --------
    >>> Viewpoint([6, 4, 9], [0, 1, 0], 45).field_of_view
    45.0
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    field_of_view: float | None = None
    up: tuple[float, float, float] | None = None
    name: str = ""
    shift: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        eye = arguments.vector("Viewpoint.eye", self.eye)
        target = arguments.vector("Viewpoint.target", self.target)
        if eye == target:
            raise ValueError(f"Viewpoint.eye and Viewpoint.target must differ; both are {eye}")
        force_setattr(self, "eye", eye)
        force_setattr(self, "target", target)
        if self.field_of_view is not None:
            angle = arguments.real("Viewpoint.field_of_view", self.field_of_view, above=0, below=180)
            force_setattr(self, "field_of_view", angle)
        if self.up is not None:
            up = arguments.vector("Viewpoint.up", self.up)
            if not any(up):
                raise ValueError("Viewpoint.up must have a direction, and is (0, 0, 0)")
            force_setattr(self, "up", up)
        force_setattr(self, "name", arguments.text("Viewpoint.name", self.name))
        across, above = arguments.real_array("Viewpoint.shift", self.shift, (2,)).tolist()
        force_setattr(self, "shift", (float(across), float(above)))


class PointLight(Value, frozen=True):
    """The light that an author gave a scene.

    Attributes
    ----------
    position
        Metres, scene frame.

    Raises
    ------
    TypeError, ValueError
        A position that is not three finite numbers.

    Examples
    --------
    >>> PointLight([3, 8, 4])
    PointLight(position=(3.0, 8.0, 4.0))
    """

    position: tuple[float, float, float]

    def __post_init__(self) -> None:
        force_setattr(self, "position", arguments.vector("PointLight.position", self.position))


class Scene(Value, frozen=True, eq=False):
    """The content of an asset file, in the scene frame.

    Attributes
    ----------
    name
        The asset's name without folder and suffix.
    objects
        In authored order: where objects compete for a voxel, the first wins.
    materials
        Indexed by material id; entry 0 is :data:`EMPTY`; at most 256 entries.
    warnings
        What the loader ignored or replaced.
    viewpoint
        The author's camera, used where no other is given; None where the author gave none.
    light
        The author's light, likewise.
    cameras
        All cameras that the author gave, in authored order; the first is the `viewpoint` of scenes from files.
    voxel_size
        Metres per voxel of a scene that is made of voxels; None for others. Builds take it where no other is given.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind, more than 256 materials, or an object whose material is not declared.

    Examples
    --------
    >>> from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [1])
    >>> Scene("boat", [SceneObject("sail", mesh)], [EMPTY, Material("cloth", (240, 240, 230))])
    Scene(name='boat', objects=1, triangles=1, materials=2, warnings=0)
    >>> Scene("boat", [SceneObject("sail", mesh)], [EMPTY])
    Traceback (most recent call last):
        ...
    ValueError: object 'sail' uses material 1, and Scene.materials ends at 0: declare the material
    """

    name: str
    objects: tuple[SceneObject, ...]
    materials: tuple[Material, ...]
    warnings: tuple[SceneWarning, ...] = ()
    viewpoint: Viewpoint | None = None
    light: PointLight | None = None
    cameras: tuple[Viewpoint, ...] = ()
    voxel_size: float | None = None

    def __post_init__(self) -> None:
        arguments.text("Scene.name", self.name)
        force_setattr(self, "objects", tuple(self.objects))
        force_setattr(self, "materials", tuple(self.materials))
        force_setattr(self, "warnings", tuple(self.warnings))
        force_setattr(self, "cameras", tuple(self.cameras))
        for index, camera in enumerate(self.cameras):
            arguments.instance(f"Scene.cameras[{index}]", camera, Viewpoint)
        for index, one in enumerate(self.objects):
            arguments.instance(f"Scene.objects[{index}]", one, SceneObject)
        for index, material in enumerate(self.materials):
            arguments.instance(f"Scene.materials[{index}]", material, Material)
        if self.viewpoint is not None:
            arguments.instance("Scene.viewpoint", self.viewpoint, Viewpoint)
        if self.light is not None:
            arguments.instance("Scene.light", self.light, PointLight)
        if self.voxel_size is not None:
            force_setattr(self, "voxel_size", arguments.real("Scene.voxel_size", self.voxel_size, above=0))
        if not 1 <= len(self.materials) <= MATERIAL_LIMIT + 1:
            raise ValueError(f"Scene.materials must have 1 … {MATERIAL_LIMIT + 1} entries, not {len(self.materials)}")
        self._refuse_undeclared_materials()

    def _refuse_undeclared_materials(self) -> None:
        highest: dict[int, int] = {}
        for one in self.objects:
            key = id(one.mesh)
            if key not in highest:
                highest[key] = _highest_material(one.mesh)
            used = max(highest[key], one.collider_material if one.colliders else 0)
            if used >= len(self.materials):
                raise ValueError(
                    f"object {one.name!r} uses material {used}, and Scene.materials ends at {len(self.materials) - 1}: "
                    "declare the material"
                )

    def __repr__(self) -> str:
        triangles = sum(len(one.mesh.triangles) for one in self.objects)
        return (
            f"Scene(name={self.name!r}, objects={len(self.objects)}, triangles={triangles}, "
            f"materials={len(self.materials)}, warnings={len(self.warnings)})"
        )


def _highest_material(mesh: Mesh) -> int:
    mapped = 0 if mesh.material_map is None else int(mesh.material_map.materials.max(initial=0))
    return max(mapped, int(mesh.materials.max(initial=0)))
