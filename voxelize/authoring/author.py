"""Scenes made in Python: solids, asset files, materials, colliders, a view and a light.

>>> from voxrt.voxelize.authoring import author
>>> yard = author.Author("yard")
>>> _ = yard.material("grass", "#3f7f2f")
>>> _ = yard.material("stone", (150, 150, 160))
>>> yard.add("lawn", author.box((8, 0.5, 8), centre=(0, -0.25, 0)), material="grass", collider="box")
>>> well = author.cylinder(1, 1.5) - author.cylinder(0.8, 2)
>>> yard.add("well", well, material="stone", translate=(2, 0.75, 1))
>>> scene = yard.build()

The same in a file is ``scene.toml`` (:mod:`voxrt.voxelize.authoring.scene_toml`).
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from voxrt.voxelize.authoring.solid import (
    Solid,
    SolidError,
    box,
    box_between,
    closed,
    cone,
    cylinder,
    extrude,
    hull,
    placement,
    sphere,
)
from voxrt.voxelize.errors import DoesNotFitError, SceneWarning
from voxrt.voxelize.notes import Notes
from voxrt.voxelize.scene import (
    DEFAULT_COLOUR,
    EMPTY,
    MATERIAL_LIMIT,
    BoxCollider,
    Collider,
    HullCollider,
    Material,
    Mesh,
    MeshCollider,
    PointLight,
    Scene,
    SceneObject,
    SphereCollider,
    Viewpoint,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

__all__ = [
    "Author",
    "AuthoringError",
    "ColliderKind",
    "Solid",
    "SolidError",
    "box",
    "box_between",
    "closed",
    "collider_around",
    "cone",
    "cylinder",
    "extrude",
    "hull",
    "parse_colour",
    "placement",
    "sphere",
]

ColliderKind: TypeAlias = Literal["box", "sphere", "hull", "mesh"]
Colour: TypeAlias = "str | Sequence[int]"

_HEX = re.compile(r"#[0-9a-fA-F]{6}")


class AuthoringError(ValueError):
    """Something that a scene cannot hold as it was asked for; one line, without full stop."""


class Author:
    """A scene under construction.

    Materials have ids in the order in which they are declared, whether used or not, so that a scene's ids stay when
    its objects change; those of asset files follow, in order of first use.

    Parameters
    ----------
    name
        The scene's name.
    background
        The colour where nothing is hit.
    """

    def __init__(self, name: str, *, background: Colour = EMPTY.colour) -> None:
        self._name = name
        self._materials: dict[int, Material] = {0: Material(EMPTY.name, parse_colour(background))}
        self._ids: dict[str, int] = {}
        self._asset_ids: dict[tuple[str, Material], int] = {}
        self._default: int | None = None
        self._uncoloured: set[str] = set()
        self._objects: dict[str, SceneObject] = {}
        self._notes = Notes()
        self._viewpoint: Viewpoint | None = None
        self._light: PointLight | None = None

    def material(
        self, name: str, colour: Colour | None = None, *, mirror: bool = False, number: int | None = None
    ) -> str:
        """Declare a material and return its name.

        Parameters
        ----------
        name
            Any text, once.
        colour
            sRGB: ``"#rrggbb"`` or three integers of 0 … 255; None for the colour that the first asset to have a
            material of that name gives it.
        mirror
            Reflects, where the hardware has mirrors; a mirror in its asset does so anyway.
        number
            Its id, 1 … 255; None for the lowest that is free.
        """
        if name in self._ids:
            raise AuthoringError(f"material {name!r} is declared twice")
        if number is not None and (not 1 <= number <= MATERIAL_LIMIT or number in self._materials):
            taken = f", which belongs to {self._materials[number].name!r}" if number in self._materials else ""
            raise AuthoringError(f"material {name!r} cannot have the id {number}{taken}; ids are 1 to {MATERIAL_LIMIT}")
        self._ids[name] = self._enter(Material(name, parse_colour(colour or EMPTY.colour), mirror), number)
        if colour is None:
            self._uncoloured.add(name)
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
    ) -> None:
        """Add a solid as one object.

        Parameters
        ----------
        name
            The object's name, once.
        solid
            Its shape.
        material
            What its surfaces are made of where the solid does not say.
        translate, rotate, scale
            Its place, as :func:`placement` has it.
        collider
            What stands in for it under ``--geometry auto``.
        pow2
            Whether a box collider is rounded up to powers of two voxels.
        """
        self.add_transformed(
            name, solid, placement(translate, rotate, scale), material=material, collider=collider, pow2=pow2
        )

    def add_transformed(
        self,
        name: str,
        solid: Solid,
        transform: NDArray[np.float64],
        *,
        material: str | None = None,
        collider: ColliderKind | None = None,
        pow2: bool = True,
    ) -> None:
        """As :meth:`add`, placed by a matrix (float64, shape (4, 4), affine, column vectors)."""
        positions, triangles, runs = (solid if material is None else solid.of(material)).surface()
        ids = np.concatenate([np.full(count, self.number(name, count), dtype=np.uint8) for name, count in runs])
        colliders = (collider_around(collider, positions, triangles, pow2=pow2),) if collider else ()
        self._enter_object(SceneObject(name, Mesh(positions, triangles, ids), transform, colliders, int(ids[0])))

    def add_asset(
        self,
        name: str,
        asset: Scene,
        transform: NDArray[np.float64],
        *,
        materials: Mapping[str, str] | None = None,
        collider: ColliderKind | None = None,
        pow2: bool = True,
    ) -> None:
        """Add all objects of a loaded file, named ``name/…``.

        Parameters
        ----------
        name
            What their names begin with.
        asset
            The file's scene.
        transform
            float64, shape (4, 4), affine, column vectors: where its frame stands in this scene.
        materials
            The file's material names to those declared here; a name that is declared here needs no entry. A texture
            gives way to the declared material, too.
        collider
            Replaces the colliders of each of its objects.
        pow2
            Whether box colliders made for it are rounded up to powers of two voxels.
        """
        wardrobe = _Wardrobe(self, asset, dict(materials or {}), name)
        meshes: dict[int, Mesh] = {}
        for one in asset.objects:
            if id(one.mesh) not in meshes:
                meshes[id(one.mesh)] = wardrobe.dressed(one.mesh)
            mesh = meshes[id(one.mesh)]
            stand_ins, filling = one.colliders, int(mesh.materials[0]) if len(mesh.triangles) else 0
            if collider and filling:
                stand_ins = (collider_around(collider, mesh.positions, mesh.triangles, pow2=pow2),)
            elif stand_ins:
                filling = wardrobe.number(one.collider_material)
            path = f"{name}/{one.name.strip('/')}"
            self._enter_object(SceneObject(path, mesh, transform @ one.transform, stand_ins, filling or 1))
        for warning in asset.warnings:
            self._notes.add(warning.kind, f"{name}: {warning.message}", warning.count)

    def look(self, eye: Sequence[float], target: Sequence[float], *, field_of_view: float | None = None) -> None:
        """Set where the scene is seen from when no camera is asked for: metres; degrees from top to bottom."""
        if field_of_view is not None and not 0 < field_of_view < 180:
            raise AuthoringError(f"field of view {field_of_view} is not between 0 and 180 degrees")
        if tuple(eye) == tuple(target):
            raise AuthoringError("the camera stands where it looks")
        self._viewpoint = Viewpoint(_point(eye), _point(target), field_of_view)

    def light(self, position: Sequence[float]) -> None:
        """Set where the point light stands when light is asked for, in metres."""
        self._light = PointLight(_point(position))

    def build(self) -> Scene:
        """Return the scene.

        Raises
        ------
        AuthoringError
            It has no objects, or a material without a colour.
        """
        if not self._objects:
            raise AuthoringError("the scene has no objects")
        for name in self.uncoloured:
            raise AuthoringError(f"material {name!r} has no colour, and no asset has one of that name")
        table = tuple(
            self._materials.get(number, Material(f"unused {number}", EMPTY.colour, authored=False))
            for number in range(max(self._materials) + 1)
        )
        warnings: tuple[SceneWarning, ...] = self._notes.warnings()
        return Scene(self._name, tuple(self._objects.values()), table, warnings, self._viewpoint, self._light)

    def number(self, name: str | None, faces: int) -> int:
        """Return the id of a declared material, or of the default one for `faces` faces that have none.

        Raises
        ------
        AuthoringError
            It is not declared.
        """
        if name is None:
            self._notes.add("default-material", "faces without a material got the default one", faces)
            if self._default is None:
                self._default = self._enter(Material("default", DEFAULT_COLOUR, authored=False), None)
            return self._default
        if name not in self._ids:
            known = ", ".join(repr(one) for one in self._ids) or "none"
            raise AuthoringError(f"no material {name!r} is declared; there is {known}")
        return self._ids[name]

    @property
    def uncoloured(self) -> tuple[str, ...]:
        """The declared materials that have no colour so far, in the order of their names."""
        return tuple(sorted(self._uncoloured))

    def coloured(self, name: str, material: Material) -> int:
        """Return the id of a declared material, which takes what it does not say itself from an asset's."""
        number = self._ids[name]
        if name in self._uncoloured:
            self._uncoloured.remove(name)
            own = self._materials[number]
            self._materials[number] = replace(own, colour=material.colour, mirror=own.mirror or material.mirror)
        return number

    def declares(self, name: str) -> bool:
        """Whether a material of that name is declared."""
        return name in self._ids

    def adopted(self, material: Material) -> int:
        """Return the id of an asset's own material; equal ones of several assets are one."""
        key = (material.name, material)
        if key not in self._asset_ids:
            self._asset_ids[key] = self._enter(material, None)
        return self._asset_ids[key]

    def _enter(self, material: Material, number: int | None) -> int:
        if number is None:
            number = next(one for one in range(1, MATERIAL_LIMIT + 2) if one not in self._materials)
        if number > MATERIAL_LIMIT:
            raise DoesNotFitError(f"more than {MATERIAL_LIMIT} materials are in use; merge some in the scene")
        names = {one.name for one in self._materials.values()}
        unique, count = material.name, 2
        while unique in names:
            unique, count = f"{material.name} ({count})", count + 1
        self._materials[number] = Material(unique, material.colour, material.mirror, material.authored)
        return number

    def _enter_object(self, one: SceneObject) -> None:
        if one.name in self._objects:
            raise AuthoringError(f"two objects are named {one.name!r}")
        if not np.isfinite(one.transform).all():
            raise AuthoringError(f"the place of {one.name!r} is no finite one")
        self._objects[one.name] = one


class _Wardrobe:
    """What the materials of one asset are in the scene; each gets its id when a face asks for it."""

    def __init__(self, author: Author, asset: Scene, renamed: dict[str, str], name: str) -> None:
        self._author = author
        self._asset = asset
        self._renamed = renamed
        self._numbers: dict[int, int] = {}
        painted = {paint.name for one in asset.objects if one.mesh.coat is not None for paint in one.mesh.coat.paints}
        known = {material.name for material in asset.materials[1:]} | painted
        for one in renamed:
            if one not in known:
                has = ", ".join(map(repr, sorted(known)))
                raise AuthoringError(f"the asset of {name!r} has no material {one!r}; it has {has}")

    def number(self, old: int) -> int:
        """Return the scene's id of the asset's material `old`."""
        if old not in self._numbers:
            material = self._asset.materials[old]
            target = self._target(material.name)
            if target is None:
                self._numbers[old] = self._author.adopted(material)
            else:
                self._author.number(target, 1)  # refuses one that is not declared
                self._numbers[old] = self._author.coloured(target, material)
        return self._numbers[old]

    def dressed(self, mesh: Mesh) -> Mesh:
        """Return a mesh in the scene's materials."""
        coat = mesh.coat
        materials = np.zeros(len(mesh.materials), dtype=np.uint8)
        if coat is not None:
            rows = coat.rows.copy()
            for row, paint in enumerate(coat.paints):
                target = self._target(paint.name)
                if target in self._author.uncoloured:
                    raise AuthoringError(f"material {paint.name!r} is painted: give {target!r} a colour of its own")
                if target is not None:
                    materials[rows == row] = self._author.number(target, 1)
                    rows[rows == row] = -1
            coat = replace(coat, rows=rows) if (rows >= 0).any() else None
        for old in np.unique(mesh.materials[materials == 0]).tolist():
            materials[(mesh.materials == old) & (materials == 0)] = self.number(old)
        return Mesh(mesh.positions, mesh.triangles, materials, coat)

    def _target(self, name: str) -> str | None:
        """Return the declared material that one of the asset's becomes, None where it stays its own."""
        if name in self._renamed:
            return self._renamed[name]
        return name if self._author.declares(name) else None


def collider_around(
    kind: ColliderKind, positions: NDArray[np.floating], triangles: NDArray[np.int32], *, pow2: bool = True
) -> Collider:
    """Return the stand-in of `kind` for a surface, in the surface's frame."""
    if kind == "mesh":
        return MeshCollider(positions, triangles)
    corners = positions[np.unique(triangles)].astype(np.float64)
    if kind == "hull":
        return HullCollider(corners)
    low, high = corners.min(axis=0), corners.max(axis=0)
    if kind == "box":
        return BoxCollider(low, high, pow2)
    centre = (low + high) / 2
    return SphereCollider(centre, float(np.linalg.norm(corners - centre, axis=1).max()))


def parse_colour(colour: Colour) -> tuple[int, int, int]:
    """Return sRGB of 8 bits a channel, from ``"#rrggbb"`` or three integers.

    Raises
    ------
    AuthoringError
        It is neither.
    """
    if isinstance(colour, str):
        if not _HEX.fullmatch(colour):
            raise AuthoringError(f"colour {colour!r} is not written as #rrggbb")
        return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
    if len(colour) != 3 or not all(isinstance(one, int) and 0 <= one <= 255 for one in colour):
        raise AuthoringError(f"colour {list(colour)} is not three integers of 0 to 255")
    return colour[0], colour[1], colour[2]


def _point(values: Sequence[float]) -> tuple[float, float, float]:
    if len(values) != 3 or not np.isfinite(np.asarray(values, dtype=np.float64)).all():
        raise AuthoringError(f"{list(values)} is not three coordinates")
    return float(values[0]), float(values[1]), float(values[2])
