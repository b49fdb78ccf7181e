"""The materials of a scene under construction: declared by its author, or taken over from asset files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

from msgspec.structs import replace

from voxrt.voxelize import arguments
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.materials import DEFAULT_COLOUR, EMPTY, MATERIAL_LIMIT, Material

if TYPE_CHECKING:
    from voxrt.voxelize.warning_log import WarningLog

Colour: TypeAlias = str | Sequence[int]
"""sRGB: ``"#rrggbb"`` or three integers 0 … 255."""

_HEX = re.compile(r"#[0-9a-fA-F]{6}")


class AuthoringError(ValueError):
    """A request that a scene cannot fulfil; the message is one line, without a full stop."""


class DeclaredMaterials:
    """A material table in the making. Entry 0 is empty space, in the colour of the background."""

    def __init__(self, background: Colour) -> None:
        self._materials: dict[int, Material] = {0: Material(EMPTY.name, parse_colour(background))}
        self._ids: dict[str, int] = {}
        self._asset_ids: dict[tuple[str, Material], int] = {}
        self._default: int | None = None
        self._without_colour: set[str] = set()

    def declare(self, name: str, colour: Colour | None, *, mirror: bool, number: int | None) -> None:
        """Add a declared material; :meth:`Author.material <voxrt.voxelize.authoring.Author.material>` says how."""
        if name in self._ids:
            raise AuthoringError(f"material {name!r} is declared twice")
        if number is not None:
            number = arguments.whole("number", number, 1, MATERIAL_LIMIT)
            if number in self._materials:
                taken = self._materials[number].name
                raise AuthoringError(f"material {name!r} cannot have the id {number}: it belongs to {taken!r}")
        plain = EMPTY.colour if colour is None else parse_colour(colour)
        self._ids[name] = self._enter(Material(name, plain, mirror), number)
        if colour is None:
            self._without_colour.add(name)

    def id_of(self, name: str) -> int:
        """Return the id of a declared material; raise AuthoringError for any other."""
        if name not in self._ids:
            known = ", ".join(repr(one) for one in self._ids) or "none"
            raise AuthoringError(f"no material {name!r} is declared; there is {known}")
        return self._ids[name]

    def default(self, log: WarningLog, faces: int) -> int:
        """Return the id of the default material, and count `faces` faces that have none in `log`."""
        log.add("default-material", "faces without a material got the default one", faces)
        if self._default is None:
            self._default = self._enter(Material("default", DEFAULT_COLOUR, authored=False), None)
        return self._default

    @property
    def without_colour(self) -> tuple[str, ...]:
        """The declared materials that have no colour so far, in alphabetical order."""
        return tuple(sorted(self._without_colour))

    def complete(self, name: str, material: Material) -> int:
        """Return the id of a declared material. One without a colour takes colour and mirror from `material`."""
        number = self.id_of(name)
        if name in self._without_colour:
            self._without_colour.remove(name)
            own = self._materials[number]
            self._materials[number] = replace(own, colour=material.colour, mirror=own.mirror or material.mirror)
        return number

    def declares(self, name: str) -> bool:
        """Tell whether a material of that name is declared."""
        return name in self._ids

    def adopt(self, material: Material) -> int:
        """Return the id of an asset's own material; equal materials of several assets share one."""
        key = (material.name, material)
        if key not in self._asset_ids:
            self._asset_ids[key] = self._enter(material, None)
        return self._asset_ids[key]

    def table(self) -> tuple[Material, ...]:
        """Return the materials by id; ids that nobody took have a placeholder."""
        return tuple(
            self._materials.get(number, Material(f"unused {number}", EMPTY.colour, authored=False))
            for number in range(max(self._materials) + 1)
        )

    def _enter(self, material: Material, number: int | None) -> int:
        if number is None:
            number = next(one for one in range(1, MATERIAL_LIMIT + 2) if one not in self._materials)
        if number > MATERIAL_LIMIT:
            raise DoesNotFitError(f"uses more than {MATERIAL_LIMIT} materials; merge some in the scene")
        names = {one.name for one in self._materials.values()}
        unique, count = material.name, 2
        while unique in names:
            unique, count = f"{material.name} ({count})", count + 1
        self._materials[number] = replace(material, name=unique)
        return number


def parse_colour(colour: Colour) -> tuple[int, int, int]:
    """Return sRGB as three integers 0 … 255, from ``"#rrggbb"`` or three integers.

    Raises
    ------
    TypeError
        It is neither text nor integers. Floats are refused: multiply by 255 and round.
    AuthoringError
        It is text of another form, or integers out of range.

    Examples
    --------
    >>> parse_colour("#ff8000")
    (255, 128, 0)
    """
    if isinstance(colour, str):
        if not _HEX.fullmatch(colour):
            raise AuthoringError(f"colour {colour!r} is not written as #rrggbb")
        return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
    try:
        return arguments.colour("colour", colour)
    except ValueError as error:
        raise AuthoringError(str(error)) from None
