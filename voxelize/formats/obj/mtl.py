"""MTL material libraries."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec import Struct

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.colour_range import clamped
from voxrt.voxelize.formats.obj.text import read_text, spellings
from voxrt.voxelize.formats.written_numbers import is_number, not_a_number

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.voxelize.warning_log import WarningLog

# Keywords that do not affect the base colour.
_WITHOUT_EFFECT = frozenset(
    {
        *("ka", "ks", "ns", "ni", "tf", "illum", "sharpness", "km", "pr", "pm", "ps", "pc", "pcr", "aniso"),
        *("anisor", "map_ka", "map_ke", "map_ks", "map_ns", "map_bump", "bump", "map_disp", "disp", "decal", "refl"),
        *("norm", "map_norm", "map_pr", "map_pm", "map_ps", "map_refl", "map_aat"),
    }
)

# The fewest and the most values of each option of a texture.
_OPTIONS = {
    "-s": (1, 3),
    "-o": (1, 3),
    "-t": (1, 3),
    "-mm": (2, 2),
    "-clamp": (1, 1),
    "-blendu": (1, 1),
    "-blendv": (1, 1),
    "-cc": (1, 1),
    "-bm": (1, 1),
    "-boost": (1, 1),
    "-texres": (1, 1),
    "-imfchan": (1, 1),
    "-type": (1, 1),
    "-colorspace": (1, 1),
}


class MtlTexture(Struct, frozen=True):
    """The arguments of ``map_Kd`` or ``map_d``: a file name, the placement of the image, and whether it is clamped.

    Texture coordinates are multiplied by `scale`, then `offset` is added.
    """

    name: str
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)
    clamp: bool = False

    def placed(self) -> tuple[object, ...]:
        """Return the placement of the image."""
        return self.scale, self.offset, self.clamp


class MtlMaterial(Struct):
    """One material of a library."""

    name: str
    folder: Path  # of its library
    colour: tuple[float, float, float] | None = None  # ``Kd``, three reals of 0 … 1; None where there is none
    emission: tuple[float, float, float] | None = None  # ``Ke``, likewise
    opacity: float = 1.0  # ``d``, or 1 - ``Tr`` where there is no ``d``
    opacity_statement: str = ""  # the statement that gave it
    texture: MtlTexture | None = None  # ``map_Kd``, or None
    opacity_texture: MtlTexture | None = None  # ``map_d``, or None


def read_mtl(path: Path, log: WarningLog) -> dict[str, MtlMaterial]:
    """Return the materials of a library by name; the first wins where a name repeats."""
    text = read_text(path)
    materials: dict[str, MtlMaterial] = {}
    current: MtlMaterial | None = None
    for line in range(len(text.starts)):
        keyword, argument = text.statement(line)
        if keyword == "newmtl":
            current = MtlMaterial(argument, path.parent)
            if argument in materials:
                log.add("repeated-material", f"{path.name} names a material twice; the first was used")
            materials.setdefault(argument, current)
        elif keyword and current is None:
            log.add("unknown-statement", f"{path.name}: statements before the first newmtl were ignored")
        elif keyword and current is not None:
            _set(current, keyword, argument, _Place(path, text.place(line), log))
    for material in materials.values():
        if material.emission and any(material.emission) and not any(material.colour or ()):
            material.colour = material.emission  # what reflects nothing shows what it emits
    return materials


class _Place(Struct, frozen=True):
    path: Path
    line: str
    log: WarningLog


def _set(material: MtlMaterial, keyword: str, argument: str, place: _Place) -> None:
    if keyword in ("kd", "ke", "d", "tr"):
        argument = spellings(argument)[-1]
    if keyword == "kd":
        material.colour = _colour("Kd", argument, place)
    elif keyword == "ke":
        material.emission = _colour("Ke", argument, place)
    elif keyword == "d":
        material.opacity = _real(argument.split()[-1:], place)
        material.opacity_statement = f"d {argument}"
    elif keyword == "tr":
        transparency = _real(argument.split()[-1:], place)
        if not material.opacity_statement.startswith("d"):  # which the format defines; writers disagree on Tr
            material.opacity = 1.0 - transparency
            material.opacity_statement = f"Tr {argument}"
    elif keyword == "map_kd":
        material.texture = _texture(keyword, argument, place)
    elif keyword == "map_d":
        material.opacity_texture = _texture(keyword, argument, place)
    elif keyword not in _WITHOUT_EFFECT:
        place.log.add("unknown-statement", f"{place.path.name}: {keyword!r} was ignored")


def _colour(keyword: str, argument: str, place: _Place) -> tuple[float, float, float] | None:
    words = argument.split()
    if words[:1] in (["spectral"], ["xyz"]):
        message = f"{place.path.name}: {keyword} {words[0]} is not supported; the default colour was used"
        place.log.add("material-colour", message)
        return None
    values = [_real([word], place) for word in words[:3]]
    if len(values) == 1:  # the format defines one value as a grey
        values *= 3
    if len(values) != 3:
        raise AssetError(place.path, f"{keyword} needs three numbers", place=place.line, fix="repair the line")
    red, green, blue = clamped(values, place.log).tolist()
    return red, green, blue


def _texture(keyword: str, argument: str, place: _Place) -> MtlTexture | None:
    """Read the options before a file name, which may hold blanks."""
    rest = argument
    scale, offset, clamp = (1.0, 1.0), (0.0, 0.0), False
    while rest.startswith("-"):
        option, _, rest = rest.partition(" ")
        option, rest = option.lower(), rest.lstrip()
        fewest, most = _OPTIONS.get(option, (0, 0))
        if not most:
            place.log.add("unknown-statement", f"{place.path.name}: {keyword} option {option!r} was ignored")
        values: list[str] = []
        while len(values) < most:
            word, _, after = rest.partition(" ")
            if len(values) >= fewest and not is_number(word.encode()):
                break
            values.append(word)
            rest = after.lstrip()
        if option in ("-s", "-o"):
            numbers = [_real([word], place) for word in values]
            if option == "-s":
                scale = numbers[0], numbers[1] if len(numbers) > 1 else 1.0
            else:
                offset = numbers[0], numbers[1] if len(numbers) > 1 else 0.0
        elif option == "-clamp":
            clamp = values == ["on"]
        elif option in ("-mm", "-t"):
            place.log.add("texture", f"{place.path.name}: {keyword} option {option!r} was ignored")
    return MtlTexture(rest, scale, offset, clamp) if rest else None


def _real(words: list[str], place: _Place) -> float:
    word = "".join(words[:1])
    if not is_number(word.encode()) or not math.isfinite(float(word)):
        raise not_a_number(place.path, word.encode(), place.line)
    return float(word)
