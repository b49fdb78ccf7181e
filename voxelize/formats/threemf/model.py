"""The objects of one model part of a 3MF package: meshes with their properties, and components."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct, field

from voxrt.voxelize.errors import DAMAGED, AssetError
from voxrt.voxelize.formats.scene_frame import FARTHEST, in_range
from voxrt.voxelize.formats.threemf.package import part_name
from voxrt.voxelize.from_arrays import triangles_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.threemf.package import Package

UNITS = {"micron": 1e-6, "millimeter": 1e-3, "centimeter": 1e-2, "inch": 0.0254, "foot": 0.3048, "meter": 1.0}
"""Metres per unit."""

_DEFAULT_UNIT = "millimeter"
_NONE = -1
_PAINTED = {"paint_color", "mmu_segmentation"}  # of triangles: by Bambu Studio and OrcaSlicer; by PrusaSlicer


class Placed(Struct, frozen=True, eq=False):
    """An object of a part where a component or an item of the build puts it: float64, shape (4, 4)."""

    part: str
    number: str
    transform: NDArray[np.float64]
    name: str = ""


class ModelObject(Struct, frozen=True, eq=False):
    """An object: triangles or components.

    `groups` are the property groups that triangles name, by their numbers in the part; `properties`, int64, shape
    (T, 4), has the row of the group of each triangle, and those of the corners in it; -1 for none. `painted`: triangles
    that a slicer painted, in filaments.
    """

    name: str
    positions: NDArray[np.float64]
    triangles: NDArray[np.int32]
    groups: list[str]
    properties: NDArray[np.int64]
    components: list[Placed]
    painted: int


class Group(Struct, frozen=True):
    """The colours of a property group: red, green, blue and opacity; None for one that cannot be read.

    `names`: of materials; None for mere colours.
    """

    colours: list[tuple[int, ...] | None]
    names: list[str] | None = None


class Model(Struct, frozen=True, eq=False):
    """A model part: its unit, objects and property groups by their numbers, and what it builds."""

    unit: str = _DEFAULT_UNIT
    objects: dict[str, ModelObject] = field(default_factory=dict)
    groups: dict[str, Group] = field(default_factory=dict)
    items: list[Placed] = field(default_factory=list)


def read_model(package: Package, part: str) -> Model:
    """Read a part; AssetError where it is not of 3MF."""
    unit = next((one.get("unit") for one in package.elements(part, "model", event="start")), None) or _DEFAULT_UNIT
    if unit not in UNITS:
        raise AssetError(package.path, f"has the unit {unit!r}", fix=f"use one of {', '.join(UNITS)}")
    model = Model(unit)
    for element in package.elements(part, "basematerials", "colorgroup", "object", "item"):
        number = element.get("id", "")
        kind = _kind_of(element)
        try:
            if kind == "item":
                model.items.append(_placed(element, part))
            elif kind == "object":
                model.objects[number] = _object(element, part)
                element.clear()
            else:
                colours = [colour_of(one.get("displaycolor") or one.get("color") or "") for one in element]
                names = [one.get("name") or "material" for one in element] if kind == "basematerials" else None
                model.groups[number] = Group(colours, names)
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            problem = f"an element <{kind}> is not as 3MF has it ({' '.join(str(error).split())[:80]})"
            raise AssetError(package.path, problem, place=f"{part}: id {number[:20]!r}", fix=DAMAGED) from None
    return model


def _kind_of(element: Any) -> str:  # noqa: ANN401 - lxml has no types
    return str(element.tag).rpartition("}")[2]


def _placed(element: Any, part: str) -> Placed:  # noqa: ANN401
    """Return what a component or an item shows; by the production extension it may name another part."""
    transform = np.eye(4)
    if element.get("transform"):
        transform[:3] = np.array(element.get("transform").split(), np.float64).reshape(4, 3).T
    if not np.isfinite(transform).all():
        raise ValueError("a transform is not finite")
    other = next((text for key, text in element.items() if key.rpartition("}")[2] == "path"), None)
    place = part if other is None else part_name(other)
    return Placed(place, element.attrib["objectid"], transform, element.get("partnumber") or "")


def _object(element: Any, part: str) -> ModelObject:  # noqa: ANN401
    positions = np.array([(one.get("x"), one.get("y"), one.get("z")) for one in element.iter("{*}vertex")], np.float64)
    positions = positions.reshape(-1, 3)
    if not in_range(positions).all():
        raise ValueError(f"a coordinate is not a number below {FARTHEST:g}")
    faces = list(element.iter("{*}triangle"))
    corners = np.array([(one.get("v1"), one.get("v2"), one.get("v3")) for one in faces], np.int64).reshape(-1, 3)
    own = element.get("pid"), element.get("pindex")
    groups: list[str] = []
    rows = [_property(one, own, groups) for one in faces]
    return ModelObject(
        element.get("name") or f"object {element.attrib['id']}",
        positions,
        triangles_of("triangles", corners, len(positions)),
        groups,
        np.array(rows, np.int64).reshape(-1, 4),
        [_placed(one, part) for one in element.iter("{*}component")],
        sum(any(key.rpartition("}")[2] in _PAINTED for key in one.keys()) for one in faces),  # noqa: SIM118 - of lxml
    )


def _property(face: Any, own: tuple[str | None, str | None], groups: list[str]) -> tuple[int, int, int, int]:  # noqa: ANN401
    """Return the group of a triangle, a row of `groups`, and the properties of its corners: its own or its object's."""
    group = face.get("pid") or own[0]
    first = face.get("p1") or (own[1] if group == own[0] else None)
    if group is None or first is None:
        return (_NONE,) * 4
    if group not in groups:
        groups.append(group)
    return (groups.index(group), int(first), int(face.get("p2") or first), int(face.get("p3") or first))


def colour_of(text: str) -> tuple[int, ...] | None:
    """Return ``#RRGGBB`` or ``#RRGGBBAA`` as red, green, blue and opacity; None for other text."""
    try:
        found = bytes.fromhex(text.strip().lstrip("#"))
    except ValueError:
        return None
    return (*found, 255)[:4] if len(found) in (3, 4) else None
