"""The kinds of values that have a notation of their own: lengths, triples, sizes, colours."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from math import inf, isfinite
from os import PathLike
from typing import TYPE_CHECKING, Literal, TypeAlias

from voxrt.options.kinds import FLAG, Kind, as_it_is, exact, file, plain, read_whole, several, show
from voxrt.sim.backgrounds import BACKGROUNDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.sim import Background

FrameChoice: TypeAlias = tuple[float, float, int] | Literal["files"]
"""The frames of an animation: start, stop and count, or the assets themselves."""

_SIZE_LIMIT = 1 << 14
_BRIGHTEST = 16  # of a sky
_MOST_FRAMES = 4096  # of an animation
_POSITION_LIMIT = 1 << 31  # in 1/16 voxel
_MOST_WORDS = 1 << 31
_TIMES = "xX\N{MULTIPLICATION SIGN}"
_UNITS = {"mm": "0.001", "cm": "0.01", "m": "1", "in": "0.0254", "ft": "0.3048"}
_LENGTH = re.compile(
    rf"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|[-+]?(?:inf|nan))?\s*({'|'.join(_UNITS)})?", re.IGNORECASE
)


def _length(text: str, *, is_unit: bool) -> float:
    from decimal import Decimal  # noqa: PLC0415 - most command lines do without

    found = _LENGTH.fullmatch(text.strip())
    number, unit = found.groups() if found else (None, None)
    if found is None or not (number or (is_unit and unit)):
        units = (
            f", nor one of the units {', '.join(_UNITS)}" if is_unit else f", with one of {', '.join(_UNITS)} or none"
        )
        raise ValueError(f"{text!r} is not a number{units}")
    try:
        return float(Decimal(number or 1) * Decimal(_UNITS[unit.lower() if unit else "m"]))
    except ArithmeticError:
        return inf


LENGTH = Kind("LENGTH", lambda text: _length(text, is_unit=False), exact("real", above=0))
"""Metres; ``5cm`` and ``2 in`` on the command line."""

UNIT = Kind("UNIT", lambda text: _length(text, is_unit=True), exact("metres_per_unit"))
"""Metres per unit; its name on the command line."""


def _parts(text: str, between: str = "") -> list[str]:
    """Split numbers as people write them: with commas or spaces between, or what else may stand there."""
    return re.sub(rf"[,;\s{between}]+", " ", text.strip().strip("()[]")).split()


def _three(text: str) -> list[str]:
    parts = _parts(text)
    if len(parts) != 3:
        raise ValueError(f"{text!r} is not X,Y,Z: three numbers with commas between, or with spaces and quotes around")
    return parts


def _triple(read: Callable[[str], object], example: str) -> Callable[[str], object]:
    def triple(text: str) -> tuple[object, ...]:
        try:
            return tuple(read(part) for part in _three(text))
        except ValueError as error:
            raise ValueError(f"{text!r} is not {example}") from error

    return triple


DIRECTION = Kind(
    "X,Y,Z",
    _triple(float, "three numbers such as 1,3,2"),
    exact("vector"),
    lambda value: ",".join(f"{part:g}" for part in value),
)
"""A direction in the scene."""


def _check_register(name: str, value: object) -> object:
    if not all(-(1 << 15) <= part < 1 << 15 for part in value):  # type: ignore[attr-defined]
        raise ValueError(f"{name} {value} does not fit signed 16 bits: {-(1 << 15)} to {(1 << 15) - 1}")
    return value


REGISTER = Kind("X,Y,Z", _triple(read_whole, "three whole numbers such as 0,0,-90"), _check_register)
"""A register of the camera."""


def _sixteenths(text: str) -> int:
    from decimal import Decimal  # noqa: PLC0415

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


PLACE = Kind("X,Y,Z", lambda text: tuple(map(_sixteenths, _three(text))), as_it_is)
"""A position: voxels on the command line, to 1/16; 1/16 voxel as a value."""


def _read_corners(text: str) -> tuple[float, ...]:
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 6:
        raise ValueError(f"{text!r} is not X,Y,Z,X,Y,Z: two corners in metres, with commas and no spaces between")
    return values


_six = several(6, "the lowest and the highest corner, six numbers", exact("real"))


def _check_corners(name: str, value: object) -> tuple[float, ...]:
    corners = _six(name, value)
    if not all(low < high for low, high in zip(corners[:3], corners[3:], strict=True)):
        raise ValueError(f"{name} must be the lowest and then the highest corner, not {show(value)}")
    return corners


CORNERS = Kind("X,Y,Z,X,Y,Z", _read_corners, _check_corners)
"""The lowest and the highest corner of a box, metres."""


def _read_pixels(text: str) -> tuple[int, int]:
    parts = _parts(text, _TIMES)
    if len(parts) not in {1, 2} or not all(part.isdecimal() and len(part) < 8 for part in parts):
        raise ValueError(f"{text!r} is not WIDTHxHEIGHT, such as 640x480, or WIDTH")
    width = int(parts[0])
    return width, int(parts[1]) if len(parts) == 2 else max(1, round(width * 3 / 4))


PIXELS = Kind(
    "WxH",
    _read_pixels,
    several(2, "a width and a height in pixels", exact("whole", 1, _SIZE_LIMIT)),
    lambda size: "{}x{}".format(*size),
)
"""The size of a picture: ``640x480``, or its width alone for a picture of 4 to 3."""


def _check_samples(name: str, value: object) -> int:
    if (samples := exact("whole", 1, 4)(name, value)) == 3:
        raise ValueError(f"{name} must be 1, 2 or 4, not 3")
    return int(samples)


SAMPLES = Kind("1|2|4", read_whole, _check_samples, choices=("1", "2", "4"))
"""Rays per pixel on each axis."""


def _read_pixel(text: str) -> tuple[int, int]:
    parts = _parts(text, _TIMES)
    if len(parts) != 2 or not all(part.isdecimal() and len(part) < 8 for part in parts):
        raise ValueError(f"{text!r} is not COLUMN,ROW, such as 320,240")
    return int(parts[0]), int(parts[1])


PIXEL = Kind("X,Y", _read_pixel, as_it_is)
"""Column and row of a pixel."""


def read_background(name: str, value: object) -> Background:
    """Return the background that is meant: ``"transparent"``, a name, ``"#rrggbb"``, or three numbers of 0 … 255.

    ValueError, which calls it `name`, if it is none of these.

    Examples
    --------
    >>> read_background("background", "#204060")
    (32, 64, 96)
    """
    if isinstance(value, str):
        if value == "transparent":
            return "transparent"
        if value in BACKGROUNDS:
            return BACKGROUNDS[value]
        if re.fullmatch("#[0-9a-fA-F]{6}", value):
            return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)
    elif isinstance(value, Sequence) and len(value) == 3:
        red, green, blue = (channel if type(channel) is int and 0 <= channel <= 255 else -1 for channel in value)
        if min(red, green, blue) >= 0:
            return red, green, blue
    raise ValueError(f"{name} {value!r} is not {', '.join(BACKGROUNDS)}, transparent or a colour such as #204060")


COLOUR = Kind("COLOUR", lambda text: read_background("the background", text), read_background)
"""A background."""


def _read_sky(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _check_sky(name: str, value: object) -> float | str:
    from voxrt.voxelize.colour.srgb import linear_from_hex  # noqa: PLC0415

    if isinstance(value, str):
        linear_from_hex(name, value)
        return value
    strength = float(exact("real")(name, value))
    if not 0 <= strength <= _BRIGHTEST:
        raise ValueError(f"{name} must be a strength of 0 … {_BRIGHTEST}, or a colour like '#9db4d0', not {value!r}")
    return strength


SKY = Kind("STRENGTH|COLOUR", _read_sky, _check_sky)
"""The light of a sky."""


def _read_bytes(text: str) -> int:
    from decimal import Decimal  # noqa: PLC0415

    found = re.fullmatch(r"(\d+(?:\.\d+)?)\s*([KMGT]?)(?:i?B)?", text.strip(), re.IGNORECASE)
    if found is None:
        raise ValueError(f"{text!r} is not a size such as 4G or 512M")
    return int(Decimal(found[1]) * (1 << 10 * " KMGT".index(found[2].upper() or " ")))


def _check_bytes(name: str, value: object) -> int:
    size = int(exact("whole", 0, 1 << 4096)(name, value))
    if not 1 << 26 <= size < 1 << 62:
        raise ValueError(f"{name} must be 64M to 4194303T, which are {1 << 26} to {(1 << 62) - 1} bytes, not {size}")
    return size


BYTES = Kind("SIZE", _read_bytes, _check_bytes)
"""A size of memory, bytes; ``4G`` and ``512M`` on the command line."""


def _check_budget(name: str, value: object) -> int | str:
    from voxrt.octree import BOARDS  # noqa: PLC0415

    check = exact("choice", tuple(BOARDS)) if isinstance(value, str) else exact("whole", 1, _MOST_WORDS)
    found: int | str = check(name, value)
    return found


BUDGET = Kind("WORDS", read_whole, _check_budget)
"""A number of memory words; in Python also the name of a board."""


def find_board(text: str, boards: Iterable[str]) -> str:
    """Return the board of a name, however that is spelled."""
    found = {plain(name): name for name in boards}
    if plain(text) not in found:
        raise ValueError(f"no board {text!r}; there are {', '.join(sorted(found.values()))}")
    return found[plain(text)]


def _read_board(text: str) -> str:
    from voxrt.octree import BOARDS  # noqa: PLC0415

    return find_board(text, BOARDS)


BOARD = Kind("NAME", _read_board, as_it_is)
"""A board whose memory is a budget."""


INTERIOR = Kind(
    "keep|any|MATERIAL",
    str,
    lambda name, value: value if isinstance(value, str) else exact("whole", 1, 255)(name, value),
)
"""A material by name or id, or one of two rules."""

PICTURE = file("FILE", (".png",), "pictures are PNG files")
"""The name of a picture."""

PICTURES = file("FILE", (".png", ".gif", ".webp", ".mp4"), "pictures are PNG files, and animations GIF, WebP or MP4")
"""The name of a picture or of an animation."""

WAVE = file("FILE", (".vcd", ".fst"), "waves are VCD or FST files")
"""The name of a wave."""

PREVIEW = Kind(
    "[FILE]",
    lambda text: PICTURE.read(text) if text else True,
    lambda name, value: value if isinstance(value, str | PathLike) else FLAG.check(name, value),
    is_optional=True,
    is_file=True,
)
"""A picture that may be given a name."""


def _read_frames(text: str) -> FrameChoice:
    if text == "files":
        return "files"
    parts = text.split(":")
    try:
        start, stop, count = float(parts[0]), float(parts[1]), int(parts[2], 10)
    except (ValueError, IndexError):
        parts = []
    if len(parts) != 3 or not (isfinite(start) and isfinite(stop)):
        raise ValueError(
            f"{text!r} is not START:STOP:COUNT, such as 0:2:24 for 24 frames of two seconds, and not files"
        )
    if stop <= start:
        raise ValueError(f"{text}: the stop must be after the start, {parts[0]}")
    if not 1 <= count <= _MOST_FRAMES:
        raise ValueError(f"{text}: {count} frames are not 1 to {_MOST_FRAMES}")
    return start, stop, count


FRAMES = Kind("START:STOP:COUNT|files", _read_frames, as_it_is)
"""The frames of an animation."""


def _read_cut(text: str) -> tuple[int, int]:
    axis, _, place = text.partition("=")
    if axis not in {"x", "y", "z"} or not place.isdecimal() or not 1 <= int(place) <= 1 << 16:
        raise ValueError(f"{text!r} is not AXIS=VOXEL, such as x=40")
    return "xyz".index(axis), int(place)


CUTS = Kind("AXIS=N", _read_cut, as_it_is, many=True)
"""Planes that cut: axis and voxel of each."""
