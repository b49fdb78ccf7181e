"""Values from the text of the command line."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from math import isfinite
from pathlib import Path
from string import hexdigits
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, get_args

from cyclopts import Parameter

from voxrt.cli.errors import UsageError
from voxrt.options.backgrounds import read_background

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from cyclopts import Token

SIZE_LIMIT = 1 << 14
_LEAST_MEMORY = 1 << 26
BRIGHTEST = 16  # of a sky
WIDEST_CELL = 1024.0  # in pixels
MOST_FRAMES = 4096  # of an animation
_REGISTER = range(-(1 << 15), 1 << 15)
_POSITION_LIMIT = 1 << 31  # in 1/16 voxel
_TIMES = "xX\N{MULTIPLICATION SIGN}"

FrameChoice: TypeAlias = tuple[float, float, int] | Literal["files"]
"""The frames of an animation: start, stop and count, or the assets themselves."""


@dataclass(frozen=True)
class Messages:
    """How much a command says."""

    verbose: Annotated[bool, Parameter(("--verbose", "-v"))] = False
    """Print every warning, and the time of each stage as it ends."""

    quiet: Annotated[bool, Parameter(("--quiet", "-q"))] = False
    """Print nothing but answers, warnings and errors."""

    debug: bool = False
    """Show the traceback of an error."""


@dataclass(frozen=True)
class Reporting(Messages):
    """How a command prints its results."""

    json: bool = False
    """Print the result as JSON on standard output."""


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


def processes(kind: type, tokens: Sequence[Token]) -> int:
    """Read a number of worker processes."""
    number = whole(kind, tokens)
    if not 1 <= number <= 1024:
        raise ValueError(f"{number} is not 1 to 1024")
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


def size_in_bytes(_type: type, tokens: Sequence[Token]) -> int:
    """Read a size of memory, ``4G``, ``512M`` or a number of bytes."""
    text = tokens[0].value
    found = re.fullmatch(r"(\d+(?:\.\d+)?)\s*([KMGT]?)(?:i?B)?", text.strip(), re.IGNORECASE)
    if found is None:
        raise ValueError(f"{text!r} is not a size such as 4G or 512M")
    size = int(Decimal(found[1]) * (1 << 10 * " KMGT".index(found[2].upper() or " ")))
    if not _LEAST_MEMORY <= size < 1 << 62:
        raise ValueError(f"{text} is not 64M to 4194303T")
    return size


def choice(kind: Any, tokens: Sequence[Token]) -> str:  # noqa: ANN401 - a Literal
    """Read one of a few names, in whichever case, with dashes or underscores."""
    names: list[str] = [name for one in (kind, *get_args(kind)) for name in get_args(one) if isinstance(name, str)]
    said = _plain(tokens[0].value)
    for name in names:
        if _plain(name) == said:
            return name
    raise ValueError(f"{tokens[0].value!r} is none of " + ", ".join(f'"{name}"' for name in names))


def board_name(_type: type, tokens: Sequence[Token]) -> str:
    """Read the name of a board with a budget, however it is spelled."""
    from voxrt.octree import BOARDS  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    return _board_of(tokens, BOARDS)


def design_name(_type: type, tokens: Sequence[Token]) -> str:
    """Read the name of a board with a design, however it is spelled."""
    from voxrt.boards.bitstream import board_names  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    return _board_of(tokens, board_names())


def _board_of(tokens: Sequence[Token], names: Iterable[str]) -> str:
    for name in names:
        if _plain(name) == _plain(tokens[0].value):
            return name
    raise ValueError(f"no board {tokens[0].value!r}; there are {', '.join(sorted(names))}")


def _plain(name: str) -> str:
    return "".join(c for c in name.lower() if c.isalnum())


def number(_type: type, tokens: Sequence[Token]) -> float:
    """Read a finite number."""
    try:
        found = float(tokens[0].value)
    except ValueError:
        raise ValueError(f"{tokens[0].value!r} is not a number") from None
    if not isfinite(found):
        raise ValueError(f"{tokens[0].value} is not a finite number")
    return found


def cell_width(kind: type, tokens: Sequence[Token]) -> float:
    """Read the width of a cell in pixels."""
    width = number(kind, tokens)
    if not 0 < width < WIDEST_CELL:
        raise ValueError(f"{tokens[0].value} is not between 0 and {WIDEST_CELL:g} pixels")
    return width


def frame_choice(_type: object, tokens: Sequence[Token]) -> FrameChoice:
    """Read what the frames of an animation are: ``0:2:24``, or ``files``."""
    said = tokens[0].value
    if said == "files":
        return "files"
    parts = said.split(":")
    try:
        start, stop, count = float(parts[0]), float(parts[1]), int(parts[2], 10)
    except (ValueError, IndexError):
        parts = []
    if len(parts) != 3 or not (isfinite(start) and isfinite(stop)):
        raise ValueError(
            f"{said!r} is not START:STOP:COUNT, such as 0:2:24 for 24 frames of two seconds, and not files"
        )
    if stop <= start:
        raise ValueError(f"{said}: the stop must be after the start, {parts[0]}")
    if not 1 <= count <= MOST_FRAMES:
        raise ValueError(f"{said}: {count} frames are not 1 to {MOST_FRAMES}")
    return start, stop, count


def corners(_type: object, tokens: Sequence[Token]) -> tuple[float, ...]:
    """Read the lowest and the highest corner of a box, ``-1,0,-1,1,2.5,1``."""
    text = tokens[0].value
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 6 or not all(map(isfinite, values)):
        raise ValueError(f"{text!r} is not X,Y,Z,X,Y,Z: two corners in metres, with commas and no spaces between")
    if not all(low < high for low, high in zip(values[:3], values[3:], strict=True)):
        raise ValueError(f"{text!r} is not a lowest and a highest corner: each number must be below its partner")
    return values


def pixels(_type: object, tokens: Sequence[Token]) -> tuple[int, int]:
    """Read a picture's size, ``640x480``, or its width alone: a picture of 4 to 3."""
    parts = _parts(tokens[0].value, _TIMES)
    if len(parts) not in {1, 2} or not all(part.isdecimal() and len(part) < 8 for part in parts):
        raise ValueError(f"{tokens[0].value!r} is not WIDTHxHEIGHT, such as 640x480, or WIDTH")
    width = int(parts[0])
    height = int(parts[1]) if len(parts) == 2 else max(1, round(width * 3 / 4))
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
    parts = _parts(tokens[0].value, _TIMES)
    if len(parts) != 2 or not all(part.isdecimal() and len(part) < 8 for part in parts):
        raise ValueError(f"{tokens[0].value!r} is not COLUMN,ROW, such as 320,240")
    return int(parts[0]), int(parts[1])


def picture_file(path: Path) -> Path:
    """Refuse a file's name that is not that of a picture or of an animation."""
    if path.suffix.lower() not in (".png", ".gif"):
        raise UsageError(
            f"{path}: pictures are PNG files, and animations GIF: give it a name that ends in .png or .gif"
        )
    return path


def png(path: Path) -> Path:
    """Refuse a picture's name that does not say what the file will be."""
    if path.suffix.lower() != ".png":
        raise UsageError(f"{path}: pictures are PNG files; give it a name that ends in .png")
    return path


def _three(text: str) -> list[str]:
    parts = _parts(text)
    if len(parts) != 3:
        raise ValueError(f"{text!r} is not X,Y,Z: three numbers with commas between, or with spaces and quotes around")
    return parts


def _parts(text: str, between: str = "") -> list[str]:
    """Split numbers as people write them: with commas or spaces between, or what else may stand there."""
    return re.sub(rf"[,;\s{between}]+", " ", text.strip().strip("()[]")).split()


def _sixteenths(text: str) -> int:
    try:
        value = Decimal(text) * 16
    except ArithmeticError:
        raise ValueError(f"{text!r} is not a number of voxels") from None
    if not value.is_finite() or abs(value) >= _POSITION_LIMIT:
        raise ValueError(f"{text} voxels is out of range")
    if value != int(value):
        near = float(round(value)) / 16
        raise ValueError(f"{text} is not a multiple of 1/16 voxel (0.0625); the nearest is {near:g}")
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
