"""Scenes made in Python: solids, asset files, materials, colliders, a camera and a light."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.voxelize import arguments
from voxrt.voxelize.authoring.asset_materials import AssetMaterials
from voxrt.voxelize.authoring.declared_materials import AuthoringError, DeclaredMaterials
from voxrt.voxelize.authoring.solid import Solid
from voxrt.voxelize.authoring.transforms import placement
from voxrt.voxelize.collider_shapes import COLLIDER_KINDS, collider_around
from voxrt.voxelize.materials import EMPTY
from voxrt.voxelize.mesh import Mesh
from voxrt.voxelize.scene import PointLight, Scene, SceneObject, Viewpoint
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from voxrt.voxelize.authoring.declared_materials import Colour
    from voxrt.voxelize.collider_shapes import ColliderKind
    from voxrt.voxelize.rules import ObjectFill, Rule


class Author:
    """A scene under construction.

    Material ids follow the order of declaration, whether materials are used or not, so that ids stay when objects
    change. Materials of asset files follow, in order of first use.

    Parameters
    ----------
    name
        The scene's name.
    background
        The colour of empty space: ``"#rrggbb"`` or three integers 0 … 255.

    Examples
    --------
    >>> from voxrt.voxelize import authoring
    >>> yard = authoring.Author("yard", background="#9fc5e8")
    >>> yard.material("stone", "#9a9aa0")
    'stone'
    >>> yard.add("step", authoring.box((1, 0.25, 0.5)), material="stone")
    >>> yard.look(eye=(6, 4, 9), target=(0, 1, 0))
    >>> yard.light((3, 8, 4))
    >>> yard.build()
    Scene(name='yard', objects=1, triangles=12, materials=2, warnings=0)
    """

    def __init__(self, name: str, *, background: Colour = EMPTY.colour) -> None:
        self._name = arguments.text("name", name)
        self._materials = DeclaredMaterials(background)
        self._objects: dict[str, SceneObject] = {}
        self._log = WarningLog()
        self._viewpoint: Viewpoint | None = None
        self._light: PointLight | None = None

    def material(
        self, name: str, colour: Colour | None = None, *, mirror: bool = False, number: int | None = None
    ) -> str:
        """Declare a material and return its name.

        Parameters
        ----------
        name
            A name that is not declared yet.
        colour
            sRGB: ``"#rrggbb"`` or three integers 0 … 255. None takes the colour of the first asset material of that
            name.
        mirror
            Whether it reflects, where the hardware has mirrors. A mirror of an asset stays one.
        number
            Its id, 1 … 255; None for the lowest that is free.

        Raises
        ------
        TypeError, ValueError
            An argument of the wrong kind or range.
        AuthoringError
            The name or the id is taken.
        DoesNotFitError
            More than 255 materials.
        """
        self._materials.declare(
            arguments.text("name", name), colour, mirror=arguments.flag("mirror", mirror), number=number
        )
        return name

    def add(
        self,
        name: str,
        solid: Solid,
        *,
        material: str | None = None,
        translate: Sequence[float] = (0, 0, 0),
        rotate: Sequence[float] = (0, 0, 0),
        scale: float | Sequence[float] = 1,
        collider: ColliderKind | None = None,
        pow2: bool = True,
        rule: Rule | None = None,
        fill: ObjectFill | None = None,
    ) -> None:
        """Add a solid as one object.

        Parameters
        ----------
        name
            A name that no other object has.
        solid
            Its shape.
        material
            The material of the solid's surfaces that have none; None for the default material.
        translate, rotate, scale
            Its placement, as for :func:`placement`.
        collider
            The collider to voxelize in its place: ``"box"``, ``"sphere"``, ``"hull"`` or ``"mesh"``; None for none.
        pow2
            Whether a box collider is rounded up to powers of two voxels.
        rule
            Which voxels it fills: ``"touch"``, ``"centre"`` or ``"half"``; None for what the build says.
        fill
            Whether what it encloses is filled: ``"solid"``, ``"surface"`` or ``"auto"``; None for what the build says.

        Raises
        ------
        TypeError, ValueError
            An argument of the wrong kind or range.
        AuthoringError
            The name is taken, or the material is not declared.
        SolidError
            The solid is empty, or the placement is not valid.
        """
        self.add_transformed(
            name,
            solid,
            placement(translate, rotate, scale),
            material=material,
            collider=collider,
            pow2=pow2,
            rule=rule,
            fill=fill,
        )

    def add_transformed(
        self,
        name: str,
        solid: Solid,
        transform: ArrayLike,
        *,
        material: str | None = None,
        collider: ColliderKind | None = None,
        pow2: bool = True,
        rule: Rule | None = None,
        fill: ObjectFill | None = None,
    ) -> None:
        """Add a solid as :meth:`add` does, placed by a matrix (shape (4, 4), affine, column vectors)."""
        arguments.instance("solid", solid, Solid)
        positions, triangles, runs = (solid if material is None else solid.of(material)).surface()
        ids = np.concatenate([np.full(count, self._id_of(own, count), dtype=np.uint8) for own, count in runs])
        colliders = [] if collider is None else [collider_around(collider, positions, triangles, pow2=pow2)]
        mesh = Mesh(positions, triangles, ids)
        placed = _finite(name, transform)
        self._enter(SceneObject(name, mesh, placed, tuple(colliders), int(ids[0]), rule=rule, fill=fill))

    def add_asset(
        self,
        name: str,
        asset: Scene,
        transform: ArrayLike,
        *,
        materials: Mapping[str, str] | None = None,
        collider: ColliderKind | None = None,
        pow2: bool = True,
        rule: Rule | None = None,
        fill: ObjectFill | None = None,
    ) -> None:
        """Add all objects of a loaded file, named ``name/…``.

        Parameters
        ----------
        name
            What their names begin with.
        asset
            The file's scene.
        transform
            Shape (4, 4), affine, column vectors: the file's frame to this scene's.
        materials
            The file's material names to those declared here. A file's material of a declared name becomes the declared
            one without an entry. A declared material replaces a texture, too.
        collider
            Replaces the colliders of each of its objects.
        pow2
            Whether a box `collider` is rounded up to powers of two voxels.
        rule
            Which voxels those of its objects fill that have no rule of their own.
        fill
            Whether what those of its objects enclose is filled that have no fill of their own.

        Raises
        ------
        TypeError, ValueError
            An argument of the wrong kind or range.
        AuthoringError
            A name is taken, or a material does not exist.
        """
        arguments.instance("asset", asset, Scene)
        if collider is not None:
            arguments.choice("collider", collider, COLLIDER_KINDS)
        outer = _finite(name, transform)
        asset_materials = AssetMaterials(self._materials, asset, dict(materials or {}), name)
        meshes: dict[int, Mesh] = {}
        for one in asset.objects:
            if collider and one.points is not None:
                raise AuthoringError(f"{name}: points have no collider; leave it out")
            if id(one.mesh) not in meshes:
                meshes[id(one.mesh)] = asset_materials.replaced(one.mesh)
            mesh = meshes[id(one.mesh)]
            colliders, filling = one.colliders, int(mesh.materials[0]) if len(mesh.triangles) else 0
            if collider and filling:
                colliders = (collider_around(collider, mesh.positions, mesh.triangles, pow2=pow2),)
            elif colliders:
                filling = asset_materials.id_of(one.collider_material)
            path = f"{name}/{one.name.strip('/')}"
            with np.errstate(over="ignore", invalid="ignore"):
                placed = outer @ one.transform
            flags = (one.hidden and not (collider and filling), one.represented)
            placed = _finite(path, placed)
            made = SceneObject(path, mesh, placed, colliders, filling or 1, *flags, one.points)
            self._enter(replace(made, rule=one.rule or rule, fill=one.fill or fill))
        for warning in asset.warnings:
            self._log.add(warning.kind, f"{name}: {warning.message}", warning.count)

    def look(self, eye: Sequence[float], target: Sequence[float], *, field_of_view: float | None = None) -> None:
        """Set the camera for pictures for which no other is given.

        Parameters
        ----------
        eye, target
            Metres: the camera's position and the point in the middle of its picture.
        field_of_view
            Degrees from the picture's top to its bottom; None for the default.

        Raises
        ------
        TypeError, ValueError
            A point that is not three finite numbers, an eye at the target, or a field of view out of range.
        """
        eye, target = arguments.vector("eye", eye), arguments.vector("target", target)
        if eye == target:
            raise AuthoringError("the camera's eye and target must differ")
        if field_of_view is not None:
            field_of_view = arguments.real("field_of_view", field_of_view, above=0, below=180)
        self._viewpoint = Viewpoint(eye, target, field_of_view, name="camera")

    def light(self, position: Sequence[float]) -> None:
        """Set the point light's position, in metres.

        Raises
        ------
        TypeError, ValueError
            A position that is not three finite numbers.
        """
        self._light = PointLight(arguments.vector("position", position))

    def warn(self, kind: str, message: str) -> None:
        """Count one more case of a warning about how the scene was written."""
        self._log.add(kind, message)

    def build(self) -> Scene:
        """Return the scene.

        Raises
        ------
        AuthoringError
            It has no objects, or a material without a colour.
        """
        if not self._objects:
            raise AuthoringError("the scene has no objects")
        for name in self.without_colour:
            raise AuthoringError(f"material {name!r} has no colour, and no asset has a material of that name")
        return Scene(
            self._name,
            tuple(self._objects.values()),
            self._materials.table(),
            self._log.warnings(),
            self._viewpoint,
            self._light,
            () if self._viewpoint is None else (self._viewpoint,),
        )

    @property
    def without_colour(self) -> tuple[str, ...]:
        """The declared materials that have no colour so far, in alphabetical order."""
        return self._materials.without_colour

    def _id_of(self, name: str | None, faces: int) -> int:
        return self._materials.default(self._log, faces) if name is None else self._materials.id_of(name)

    def _enter(self, one: SceneObject) -> None:
        if one.name in self._objects:
            raise AuthoringError(f"two objects are named {one.name!r}")
        self._objects[one.name] = one


def _finite(name: str, transform: ArrayLike) -> NDArray[np.float64]:
    """Return the transform of an object as float64, shape (4, 4)."""
    matrix = arguments.real_array("transform", transform, (4, 4), finite=False).astype(np.float64, copy=False)
    if not np.isfinite(matrix).all():
        raise AuthoringError(f"the transform of {name!r} is not finite")
    return matrix
