"""Properties for voxrt that authors give to objects and materials: `extras` of glTF, custom properties of Blender.

`voxrt_material` names the material that an object's faces take, or renames a material; `voxrt_collider` makes an
object's mesh collide as a box, a sphere, a hull or a mesh; `voxrt_rule` and `voxrt_fill` say which voxels it fills;
`voxrt_ignore` leaves an object out; `voxrt_reflect` makes a material, or what an object shows, a mirror.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar, get_args, get_type_hints

import msgspec

from voxrt.voxelize.collider_shapes import ColliderKind  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.rules import ObjectFill, Rule  # noqa: TC001

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from voxrt.voxelize.errors import AssetError

PREFIX = "voxrt_"
"""What the names of all of them begin with."""


class MaterialProperties(msgspec.Struct, frozen=True, kw_only=True):
    """The properties of a material: its name in the palette, and whether it is a mirror."""

    voxrt_material: str | None = None
    voxrt_reflect: bool | float = False


class ObjectProperties(MaterialProperties, frozen=True, kw_only=True):
    """The properties of an object: those of its faces, its collider, its rule and fill, and whether it is left out."""

    voxrt_collider: ColliderKind | None = None
    voxrt_rule: Rule | None = None
    voxrt_fill: ObjectFill | None = None
    voxrt_ignore: bool | float = False


P = TypeVar("P", MaterialProperties, ObjectProperties)


def checked_properties(
    authored: Mapping[str, object], kind: type[P], place: str, error: Callable[[str, str, str], AssetError]
) -> P:
    """Return the properties for voxrt among those that an author gave.

    `error` makes the error for a place below `place`, a problem and a fix; it is raised for a property that is unknown
    or has another value.
    """
    for key in authored:
        if key.startswith(PREFIX) and key not in kind.__struct_fields__:
            from difflib import get_close_matches  # noqa: PLC0415 - slow to import, and for what is wrong alone

            nearest = get_close_matches(key, kind.__struct_fields__, n=1)
            fix = f"did you mean {nearest[0]}?" if nearest else f"use {', '.join(kind.__struct_fields__)}"
            raise error(f"{place}.{key}", "unknown property for voxrt", fix)
    try:
        return msgspec.convert(authored, kind)
    except msgspec.ValidationError as wrong:
        problem, here = explain(wrong, place)
        choices = [one for form in get_args(get_type_hints(kind)[here.rpartition(".")[2]]) for one in get_args(form)]
        raise error(here, problem, f"use {', '.join(choices)}" if choices else "correct the property") from None


def explain(error: msgspec.ValidationError, place: str = "") -> tuple[str, str]:
    """Return what is wrong with a value that does not match its schema, and the path of it: `error`'s below `place`."""
    problem, _, where = str(error).partition(" - at ")
    path = place + where.strip("`").removeprefix("$")
    return problem[:1].lower() + problem[1:], path.removeprefix(".")
