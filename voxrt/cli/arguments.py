"""Values from the text of the command line."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from math import isfinite
from pathlib import Path
from string import hexdigits
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from voxrt.backgrounds import read_background

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cyclopts import Token

SIZE_LIMIT = 1 << 14
BRIGHTEST = 16  # of a sky
_REGISTER = range(-(1 << 15), 1 << 15)
_POSITION_LIMIT = 1 << 31  # in 1/16 voxel


class UsageError(Exception):
    """A command line that cannot be understood, in one line."""


@dataclass(frozen=True)
class Reporting:
    """How a command prints its results."""

    json: bool = False
    """Print the result as JSON on standard output."""

    debug: bool = False
    """Show the traceback of an error."""


def bind_preview(arguments: Sequence[str]) -> list[str]:
    """Join ``--preview`` to its file, if it has one: the value is optional, and an asset may follow it.

    The next argument is its file unless it is an option or has the suffix of an asset.
    """
    bound = list(arguments)
    for place, argument in enumerate(bound):
        if argument == "--":
            break
        if argument == "--preview":
            value = bound[place + 1] if place + 1 < len(bound) else "-"
            if value.startswith("-") or _is_asset(value):
                bound[place] = "--preview="
            else:
                bound[place : place + 2] = [f"--preview={value}"]
    return bound


def _is_asset(name: str) -> bool:
    from voxrt.voxelize.assets import SUFFIXES  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    return Path(name).suffix.lower() in SUFFIXES


def whole(_type: type, tokens: Sequence[Token]) -> int:
    """Read a whole number; cyclopts alone would round 3.5."""
    try:
        return int(tokens[0].value, 10)
    except ValueError:
        raise ValueError(f"{tokens[0].value!r} is not a whole number") from None


def levels(kind: type, tokens: Sequence[Token]) -> int:
    """Read an octree's depth."""
    number = whole(kind, tokens)
    if not 1 <= number <= 16:
        raise ValueError(f"{number} is not 1 to 16")
    return number


def shades(kind: type, tokens: Sequence[Token]) -> int:
    """Read a number of colours; a textured surface has one more inside."""
    number = whole(kind, tokens)
    if not 1 <= number <= 254:
        raise ValueError(f"{number} is not 1 to 254")
    return number


def samples(kind: type, tokens: Sequence[Token]) -> int:
    """Read a number of rays."""
    number = whole(kind, tokens)
    if not 1 <= number <= 4096:
        raise ValueError(f"{number} is not 1 to 4096")
    return number


def direction(_type: object, tokens: Sequence[Token]) -> tuple[float, float, float]:
    """Read a direction, ``1,3,2``."""
    try:
        x, y, z = (float(part) for part in _three(tokens[0].value))
    except ValueError as error:
        raise ValueError(f"{tokens[0].value!r} is not three numbers such as 1,3,2") from error
    if not (isfinite(x) and isfinite(y) and isfinite(z)):
        raise ValueError(f"{tokens[0].value} is not three finite numbers")
    return x, y, z


def sky_light(_type: object, tokens: Sequence[Token]) -> float | str:
    """Read the light of a sky: a strength, ``0.4``, or a colour, ``#9db4d0``."""
    text = tokens[0].value
    if len(text) == 7 and text[0] == "#" and all(one in hexdigits for one in text[1:]):
        return text
    try:
        strength = float(text)
    except ValueError:
        strength = -1.0
    if not 0 <= strength <= BRIGHTEST:
        raise ValueError(f"{text!r} is no strength of 0 to {BRIGHTEST} and no colour such as #9db4d0")
    return strength


def words(kind: type, tokens: Sequence[Token]) -> int:
    """Read a number of memory words."""
    number = whole(kind, tokens)
    if number < 1:
        raise ValueError(f"{number} is not a number of words")
    return number


def metres(kind: type, tokens: Sequence[Token]) -> float:
    """Read a length."""
    number = seconds(kind, tokens)
    if number <= 0:
        raise ValueError(f"{tokens[0].value} is not a positive number of metres")
    return number


def seconds(_type: type, tokens: Sequence[Token]) -> float:
    """Read a time."""
    try:
        number = float(tokens[0].value)
    except ValueError:
        raise ValueError(f"{tokens[0].value!r} is not a number") from None
    if not isfinite(number):
        raise ValueError(f"{tokens[0].value} is not a finite number")
    return number


def pixels(_type: object, tokens: Sequence[Token]) -> tuple[int, int]:
    """Read a picture's size, ``640x480``."""
    parts = tokens[0].value.lower().split("x")
    if len(parts) != 2 or not all(part.isdecimal() and len(part) < 8 for part in parts):
        raise ValueError(f"{tokens[0].value!r} is not WIDTHxHEIGHT, such as 640x480")
    width, height = (int(part) for part in parts)
    if not (1 <= width <= SIZE_LIMIT and 1 <= height <= SIZE_LIMIT):
        raise ValueError(f"{tokens[0].value} is not between 1x1 and {SIZE_LIMIT}x{SIZE_LIMIT} pixels")
    return width, height


def place(_type: object, tokens: Sequence[Token]) -> tuple[int, int, int]:
    """Read a position in voxels, ``10,-2.5,3``, to 1/16 voxel."""
    x, y, z = (_sixteenths(part) for part in _three(tokens[0].value))
    return x, y, z


def background(_type: object, tokens: Sequence[Token]) -> tuple[int, int, int] | Literal["transparent"]:
    """Read a background: a name or a colour."""
    return read_background("the background", tokens[0].value)


def register(_type: object, tokens: Sequence[Token]) -> tuple[int, int, int]:
    """Read three register values, ``0,0,-90``."""
    try:
        x, y, z = (int(part, 10) for part in _three(tokens[0].value))
    except ValueError as error:
        raise ValueError(f"{tokens[0].value!r} is not three whole numbers such as 0,0,-90") from error
    if not all(value in _REGISTER for value in (x, y, z)):
        raise ValueError(f"{tokens[0].value} does not fit signed 16 bits: {_REGISTER.start} to {_REGISTER.stop - 1}")
    return x, y, z


def pixel(_type: object, tokens: Sequence[Token]) -> tuple[int, int]:
    """Read a pixel's place, ``320,240``."""
    parts = tokens[0].value.split(",")
    if len(parts) != 2 or not all(part.isdecimal() and len(part) < 8 for part in parts):
        raise ValueError(f"{tokens[0].value!r} is not COLUMN,ROW, such as 320,240")
    return int(parts[0]), int(parts[1])


def png(path: Path) -> Path:
    """Refuse a picture's name that does not say what the file will be."""
    if path.suffix.lower() != ".png":
        raise UsageError(f"{path}: pictures are PNG files; give it a name that ends in .png")
    return path


def _three(text: str) -> list[str]:
    parts = text.split(",")
    if len(parts) != 3:
        raise ValueError(f"{text!r} is not X,Y,Z: three numbers with commas and no spaces between")
    return parts


def _sixteenths(text: str) -> int:
    try:
        value = Decimal(text) * 16
    except ArithmeticError:
        raise ValueError(f"{text!r} is not a number of voxels") from None
    if not value.is_finite() or abs(value) >= _POSITION_LIMIT:
        raise ValueError(f"{text} voxels is out of range")
    if value != int(value):
        raise ValueError(f"{text} is not a multiple of 1/16 voxel (0.0625)")
    return int(value)


Pixels = Annotated[tuple[int, int], Parameter(converter=pixels, n_tokens=1, metavar="WxH", show_default=False)]
Direction = Annotated[
    tuple[float, float, float],
    Parameter(converter=direction, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True),
]
Pixel = Annotated[tuple[int, int], Parameter(converter=pixel, n_tokens=1, metavar="X,Y", show_default=False)]
Backdrop = Annotated[
    tuple[int, int, int] | Literal["transparent"] | None,
    Parameter(converter=background, n_tokens=1, metavar="COLOUR", show_default=False),
]
Depth = Annotated[int | None, Parameter(converter=levels, metavar="N")]
_Register = Annotated[
    tuple[int, int, int] | None,
    Parameter(converter=register, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True),
]


@dataclass(frozen=True)
class Sight:
    """The camera. What is not given is chosen to show the whole scene."""

    position: Annotated[
        tuple[int, int, int] | None,
        Parameter(converter=place, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True),
    ] = None
    """Position of the camera in voxels, in steps of 1/16. It may lie outside the scene. The default shows the whole
    scene."""

    look: _Register = None
    """Register: direction of the centre of the picture. Without --right and --up, its length does not matter. The
    default looks at the scene."""

    right: _Register = None
    """Register: step of the direction from a pixel to its right neighbour. The default is look x up."""

    up: _Register = None
    """Register: step of the direction from a pixel to the one above it. The default is upright."""
