"""What viewers ask for: JSON messages, read with nothing taken on trust. ``docs/protocol.md`` lists them."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ..board.errors import Refused
from ..board.view import FEATURES, Camera, Lighting, Triple, View

if TYPE_CHECKING:
    from collections.abc import Callable

_REQUEST_LIMIT = (1 << 32) - 1
_FILES = 64
_NAME = 200
_BOUNCES = 4  # of mirrors that are turned on without a number


@dataclass(frozen=True, slots=True)
class Take:
    """Let me steer."""


@dataclass(frozen=True, slots=True)
class Release:
    """Let somebody else steer."""


@dataclass(frozen=True, slots=True)
class ViewChange:
    """Show this instead: what is None stays as it is."""

    camera: Camera | None = None
    size: tuple[int, int] | None = None
    background: Triple | None = None
    light: Triple | None = None
    ambient: int | None = None
    features: frozenset[str] | None = None
    bounces: int | None = None
    nonstop: bool | None = None

    def applied_to(self, view: View) -> View:
        """Make the view that is asked for."""
        fields = ("camera", "size", "background")
        changed = {name: value for name in fields if (value := getattr(self, name)) is not None}
        return replace(view, lighting=self._lighting(view.lighting), **changed)

    def _lighting(self, lighting: Lighting) -> Lighting:
        if self.light is not None:
            lighting = replace(lighting, position=self.light)
        if self.ambient is not None:
            lighting = replace(lighting, ambient=self.ambient)
        if self.bounces is not None:
            lighting = replace(lighting, bounces=self.bounces)
        if self.features is not None:
            bounces = (lighting.bounces or _BOUNCES) if "mirrors" in self.features else 0
            lighting = replace(lighting, on="light" in self.features, flat="flat" in self.features, bounces=bounces)
        return lighting


@dataclass(frozen=True, slots=True)
class ShowScene:
    """Run the scene of this name from the server's own list."""

    scene: str


@dataclass(frozen=True, slots=True)
class UploadedFile:
    """A file that will come in chunks."""

    name: str
    size: int
    crc32: int


@dataclass(frozen=True, slots=True)
class Upload:
    """Run a scene made of these files; `check_only` stops before the first word is written."""

    files: tuple[UploadedFile, ...]
    check_only: bool


@dataclass(frozen=True, slots=True)
class Cancel:
    """Forget the upload under way."""


@dataclass(frozen=True, slots=True)
class ReadRegisters:
    """Tell me all registers."""


@dataclass(frozen=True, slots=True)
class ReadCounters:
    """Tell me what the server has counted."""


Request = Take | Release | ViewChange | ShowScene | Upload | Cancel | ReadRegisters | ReadCounters


def read_request(text: str) -> tuple[int, Request]:
    """Read a message: its number, 0 where it has none, and what is asked.

    Raises
    ------
    Refused
        It is no JSON object, its type is unknown, or a field is missing, of another kind, out of range, or unknown.
    """
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        raise Refused("a text message is no JSON") from None
    if not isinstance(message, dict):
        raise Refused("a text message is no JSON object")
    number = _whole("request", message.pop("request", 0), 0, _REQUEST_LIMIT)
    kind = message.pop("type", None)
    reader = _READERS.get(kind) if isinstance(kind, str) else None
    if reader is None:
        raise Refused(f"{_shown(kind)} is no type of message; there are {', '.join(sorted(_READERS))}")
    request = reader(message)
    if message:
        raise Refused(f"{kind} has no field {_shown(next(iter(message)))}")
    return number, request


def request_number(text: str) -> int:
    """Give the number of a message that :func:`read_request` refused, 0 where even that cannot be told."""
    try:
        number = json.loads(text)["request"]
    except (ValueError, RecursionError, TypeError, KeyError):
        return 0
    return number if type(number) is int and 0 <= number <= _REQUEST_LIMIT else 0


def _view_change(message: dict[str, Any]) -> ViewChange:
    def optional(field: str, read: Callable[[str, Any], Any]) -> Any:  # noqa: ANN401 - as the field is
        return read(field, message.pop(field)) if field in message else None

    return ViewChange(
        camera=optional("camera", _camera),
        size=optional("size", _size),
        background=optional("background", lambda name, value: _triple(name, value, 0, 255)),
        light=optional("light", _position),
        ambient=optional("ambient", lambda name, value: _whole(name, value, 0, 255)),
        features=optional("features", _features),
        bounces=optional("bounces", lambda name, value: _whole(name, value, 0, 15)),
        nonstop=optional("nonstop", _truth),
    )


def _upload(message: dict[str, Any]) -> Upload:
    files = message.pop("files", None)
    if not isinstance(files, list) or not 1 <= len(files) <= _FILES:
        raise Refused(f"files is not a list of 1 to {_FILES} files")
    check_only = _truth("check_only", message.pop("check_only", False))
    return Upload(tuple(_file(entry) for entry in files), check_only)


def _file(entry: object) -> UploadedFile:
    if not isinstance(entry, dict) or entry.keys() != {"name", "size", "crc32"}:
        raise Refused("a file of an upload is not {name, size, crc32}")
    return UploadedFile(
        _name("name", entry["name"]),
        _whole("size", entry["size"], 1, 1 << 40),
        _whole("crc32", entry["crc32"], 0, 0xFFFFFFFF),
    )


def _show(message: dict[str, Any]) -> ShowScene:
    return ShowScene(_name("scene", message.pop("scene", None)))


_READERS: dict[str, Callable[[dict[str, Any]], Request]] = {
    "take": lambda _: Take(),
    "release": lambda _: Release(),
    "view": _view_change,
    "show": _show,
    "upload": _upload,
    "cancel": lambda _: Cancel(),
    "registers": lambda _: ReadRegisters(),
    "counters": lambda _: ReadCounters(),
}


def _camera(name: str, value: object) -> Camera:
    if not isinstance(value, dict) or value.keys() != {"position", "look", "right", "up"}:
        raise Refused(f"{name} is not {{position, look, right, up}}")
    triples = (_triple(f"{name}.{field}", value[field], -(1 << 15), (1 << 15) - 1) for field in ("look", "right", "up"))
    return Camera(_position(f"{name}.position", value["position"]), *triples)


def _position(name: str, value: object) -> Triple:
    return _triple(name, value, -(1 << 31), (1 << 31) - 1)


def _triple(name: str, value: object, low: int, high: int) -> Triple:
    if not isinstance(value, list) or len(value) != 3:
        raise Refused(f"{name} is not three numbers")
    x, y, z = (_whole(name, part, low, high) for part in value)
    return x, y, z


def _size(name: str, value: object) -> tuple[int, int]:
    if not isinstance(value, list) or len(value) != 2:
        raise Refused(f"{name} is not columns and rows")
    return _whole(name, value[0], 1, 1 << 14), _whole(name, value[1], 1, 1 << 14)


def _features(name: str, value: object) -> frozenset[str]:
    if not isinstance(value, list) or not all(isinstance(part, str) and part in FEATURES for part in value):
        raise Refused(f"{name} is not a list of {', '.join(FEATURES)}")
    return frozenset(value)


def _whole(name: str, value: object, low: int, high: int) -> int:
    if type(value) is not int or not low <= value <= high:
        raise Refused(f"{name} {_shown(value)} is not a whole number from {low} to {high}")
    return value


def _truth(name: str, value: object) -> bool:
    if not isinstance(value, bool):
        raise Refused(f"{name} {_shown(value)} is not true or false")
    return value


def _name(name: str, value: object) -> str:
    if not isinstance(value, str) or not value.isprintable() or not 1 <= len(value) <= _NAME:
        raise Refused(f"{name} {_shown(value)} is not a name of 1 to {_NAME} printable characters")
    return value


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:40]}…"
