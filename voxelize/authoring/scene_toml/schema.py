"""Every key of ``scene.toml``. Lengths are metres, y is up, angles are degrees, colours are sRGB."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

FARTHEST = 1e9
"""Metres, degrees: no scene goes beyond, and their products stay finite."""

Number: TypeAlias = Annotated[float, Meta(ge=-FARTHEST, le=FARTHEST)]
Point: TypeAlias = tuple[Number, Number, Number]
Length: TypeAlias = Annotated[float, Meta(gt=0, le=FARTHEST)]
Axis: TypeAlias = Literal["x", "y", "z"]
Colour: TypeAlias = str | list[int]
ColliderKind: TypeAlias = Literal["box", "sphere", "hull", "mesh"]


class _Table(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A table that knows its keys."""


class MaterialTable(_Table, frozen=True, kw_only=True):
    """``[materials.NAME]``: ids go in the order of the file, and stay while materials are not used.

    Attributes
    ----------
    colour
        ``"#rrggbb"`` or three integers of 0 … 255; left out, the one that the asset with such a material gives it.
    mirror
        Reflects, where the hardware has mirrors.
    id
        1 … 255, to keep an id whatever is declared before.
    """

    colour: Colour | None = None
    mirror: bool = False
    id: Annotated[int, Meta(ge=1, le=255)] | None = None


class Box(_Table, frozen=True, kw_only=True):
    """``box``: its sides along x, y and z, and its `centre` (the origin by default) or its lowest `corner`."""

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

    The points are (x, z) for the y axis, (x, y) for z, (y, z) for x, either way round.
    """

    outline: Annotated[list[tuple[Number, Number]], Meta(min_length=3)]
    height: Length
    axis: Axis = "y"


class Asset(_Table, frozen=True, kw_only=True):
    """``asset``: another file.

    Attributes
    ----------
    file
        Its path, from this file's folder.
    up, unit
        For formats that do not say: the up axis, and metres per unit.
    time, animation, variants
        For formats that have them: seconds of its animation, which animation, and what to show of what it
        has in several ways.
    materials
        Its material names to those of this file. One of a name that this file declares is that one anyway.
    """

    file: str
    up: Axis | None = None
    unit: Length | None = None
    time: Number | None = None
    animation: str | None = None
    variants: list[str] = []
    materials: dict[str, str] = {}


class Node(_Table, frozen=True, kw_only=True):
    """One of ``[[objects]]``, or of a group, or an operand of a boolean: one shape, placed and made of something.

    Attributes
    ----------
    name
        For reports; ``shape 3`` by default.
    box, sphere, cylinder, cone, extrude, asset, union, difference, intersection, hull, group
        The shape: one of them. ``difference`` takes the second and all that follow from the first; a ``group`` is
        several objects placed together.
    translate, rotate, scale
        Its place: scaled, then turned about x, then y, then z, then moved.
    material
        What it is made of where its parts do not say.
    collider, pow2
        What stands in for it, and whether a box is rounded up to powers of two voxels.
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


SHAPES = (
    *("box", "sphere", "cylinder", "cone", "extrude", "asset"),
    *("union", "difference", "intersection", "hull", "group"),
)
"""The keys of a node of which it has one."""


class Camera(_Table, frozen=True, kw_only=True):
    """``[camera]``: where pictures are taken from when no other place is asked for."""

    eye: Point
    target: Point
    field_of_view: Annotated[float, Meta(gt=0, lt=180)] | None = None


class Light(_Table, frozen=True, kw_only=True):
    """``[light]``: where the point light stands when light is asked for."""

    position: Point


class File(_Table, frozen=True, kw_only=True):
    """The whole file; objects in the order in which they win voxels."""

    objects: Annotated[list[Node], Meta(min_length=1)]
    materials: dict[str, MaterialTable] = {}
    background: Colour = "#000000"
    camera: Camera | None = None
    light: Light | None = None
