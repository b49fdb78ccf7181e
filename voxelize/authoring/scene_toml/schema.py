"""Every key of ``scene.toml``. Lengths are metres, y is up, angles are degrees, colours are sRGB."""

from __future__ import annotations

from typing import Annotated, TypeAlias

from msgspec import Meta, Struct

from voxrt.voxelize.authoring.solid import Axis  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.authoring.transforms import FARTHEST
from voxrt.voxelize.collider_shapes import ColliderKind  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.rules import ObjectFill, Rule  # noqa: TC001

Number: TypeAlias = Annotated[float, Meta(ge=-FARTHEST, le=FARTHEST)]
Point: TypeAlias = tuple[Number, Number, Number]
Length: TypeAlias = Annotated[float, Meta(gt=0, le=FARTHEST)]
Colour: TypeAlias = str | list[int]


class _Table(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A table that refuses unknown keys."""


class MaterialEntry(_Table, frozen=True, kw_only=True):
    """``[materials.NAME]``: ids follow the order of the file, whether materials are used or not.

    Attributes
    ----------
    colour
        ``"#rrggbb"`` or three integers 0 … 255; the default is the colour of the first asset material of that name.
    mirror
        Whether it reflects, where the hardware has mirrors.
    id
        1 … 255; the default is the lowest id that is free.
    """

    colour: Colour | None = None
    mirror: bool = False
    id: Annotated[int, Meta(ge=1, le=255)] | None = None


class Box(_Table, frozen=True, kw_only=True):
    """``box``: its sides along x, y and z, and its `centre` (by default the origin) or its lowest `corner`."""

    size: tuple[Length, Length, Length]
    centre: Point | None = None
    corner: Point | None = None


class Sphere(_Table, frozen=True, kw_only=True):
    """``sphere``."""

    radius: Length
    centre: Point = (0, 0, 0)


class Cylinder(_Table, frozen=True, kw_only=True):
    """``cylinder``: along `axis`, `centre` half way up."""

    radius: Length
    height: Length
    axis: Axis = "y"
    centre: Point = (0, 0, 0)


class Cone(_Table, frozen=True, kw_only=True):
    """``cone``: its tip towards the positive end of `axis`, `centre` half way up."""

    radius: Length
    height: Length
    axis: Axis = "y"
    centre: Point = (0, 0, 0)


class Extrude(_Table, frozen=True, kw_only=True):
    """``extrude``: a prism from 0 to `height` along `axis` over an outline of points.

    The points are (x, z) for the y axis, (x, y) for z, (y, z) for x, in either orientation.
    """

    outline: Annotated[list[tuple[Number, Number]], Meta(min_length=3)]
    height: Length
    axis: Axis = "y"


class Asset(_Table, frozen=True, kw_only=True):
    """``asset``: another file.

    Attributes
    ----------
    file
        Its path, relative to this file's folder.
    up, unit
        The up axis and metres per unit, for formats that do not declare them.
    time, animation, variants
        Seconds into an animation, which animation, and which variants, for formats that have them.
    materials
        Its material names to those of this file. A material whose name this file declares becomes the declared one
        without an entry.
    """

    file: str
    up: Axis | None = None
    unit: Length | None = None
    time: Number | None = None
    animation: str | None = None
    variants: list[str] = []
    materials: dict[str, str] = {}


class Node(_Table, frozen=True, kw_only=True):
    """One of ``[[objects]]``, of a group, or of the operands of a boolean: one shape, its placement and its material.

    Attributes
    ----------
    name
        For reports; by default the shape and its number, ``box 3``.
    box, sphere, cylinder, cone, extrude, asset, union, difference, intersection, hull, group
        The shape: exactly one of them. ``difference`` subtracts all others from the first; a ``group`` is several
        objects placed together.
    translate, rotate, scale
        Its placement: it is scaled, then rotated about x, then y, then z, then moved.
    material
        The material of its parts that have none.
    collider, pow2
        The collider to voxelize in its place, and whether a box is rounded up to powers of two voxels.
    rule
        Which voxels it fills: ``touch``, ``centre`` or ``half``.
    fill
        Whether what it encloses is filled: ``solid``, ``surface`` or ``auto``.
    """

    name: str | None = None
    box: Box | None = None
    sphere: Sphere | None = None
    cylinder: Cylinder | None = None
    cone: Cone | None = None
    extrude: Extrude | None = None
    asset: Asset | None = None
    union: Annotated[list[Node], Meta(min_length=1)] | None = None
    difference: Annotated[list[Node], Meta(min_length=2)] | None = None
    intersection: Annotated[list[Node], Meta(min_length=2)] | None = None
    hull: Annotated[list[Node], Meta(min_length=1)] | None = None
    group: Annotated[list[Node], Meta(min_length=1)] | None = None
    translate: Point = (0, 0, 0)
    rotate: Point = (0, 0, 0)
    scale: float | list[float] = 1.0  # one or three: msgspec crashes on a union of a bounded number and a tuple
    material: str | None = None
    collider: ColliderKind | None = None
    pow2: bool = True
    rule: Rule | None = None
    fill: ObjectFill | None = None


SHAPES = (
    *("box", "sphere", "cylinder", "cone", "extrude", "asset"),
    *("union", "difference", "intersection", "hull", "group"),
)
"""The shape keys of a node; it has exactly one."""


class Camera(_Table, frozen=True, kw_only=True):
    """``[camera]``: the camera for pictures for which no other is given."""

    eye: Point
    target: Point
    field_of_view: Annotated[float, Meta(gt=0, lt=180)] | None = None


class Light(_Table, frozen=True, kw_only=True):
    """``[light]``: the position of the point light, used when light is switched on."""

    position: Point


class File(_Table, frozen=True, kw_only=True):
    """The whole file. Where objects compete for a voxel, the first wins."""

    objects: Annotated[list[Node], Meta(min_length=1)]
    materials: dict[str, MaterialEntry] = {}
    background: Colour = "#000000"
    camera: Camera | None = None
    light: Light | None = None
