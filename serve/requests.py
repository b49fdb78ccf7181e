"""The requests of clients: JSON messages, with every field checked. ``docs/protocol.md`` documents them."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, get_args

from voxrt.board.errors import Refused
from voxrt.board.view import FEATURES, Camera, Lighting, Shading, Triple, View
from voxrt.octree.camera import DIRECTION_LIMIT

if TYPE_CHECKING:
    from collections.abc import Callable

_REQUEST_LIMIT = (1 << 32) - 1
_FILES = 64
_SHADINGS: tuple[Shading, ...] = get_args(Shading)
_NAME = 200
_BOUNCES = 4  # of mirrors that are turned on without a number


@dataclass(frozen=True, slots=True)
class TakeControl:
    """Get control."""


@dataclass(frozen=True, slots=True)
class ReleaseControl:
    """Give control to the next client that waits for it."""


@dataclass(frozen=True, slots=True)
class ChangeView:
    """Change the view; a field that is None stays as it is."""

    camera: Camera | None = None
    size: tuple[int, int] | None = None
    background: Triple | None = None
    light: Triple | None = None
    ambient: int | None = None
    features: frozenset[str] | None = None
    shading: Shading | None = None
    bounces: int | None = None
    nonstop: bool | None = None
    frame: int | None = None

    def applied_to(self, view: View) -> View:
        """Make the view that is asked for."""
        fields = ("camera", "size", "background", "frame")
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
            lighting = replace(lighting, on="light" in self.features, bounces=bounces)
        return lighting if self.shading is None else lighting.shaded(self.shading)


@dataclass(frozen=True, slots=True)
class LoadScene:
    """Load the server's own scene with this name."""

    scene: str


@dataclass(frozen=True, slots=True)
class UploadedFile:
    """A file that follows in chunks."""

    name: str
    size: int
    crc32: int


@dataclass(frozen=True, slots=True)
class StartUpload:
    """Load a scene that is made from these files; with `check_only` nothing is written to the device."""

    files: tuple[UploadedFile, ...]
    check_only: bool


@dataclass(frozen=True, slots=True)
class CancelUpload:
    """Discard the upload in progress."""


@dataclass(frozen=True, slots=True)
class ReadRegisters:
    """Get all registers of the device."""


@dataclass(frozen=True, slots=True)
class ReadCounters:
    """Get the counters of the server."""


@dataclass(frozen=True, slots=True)
class CastRay:
    """Find the first solid voxel on a ray: origin, 1/16 voxel, and direction."""

    origin: Triple
    direction: Triple


Request = (
    TakeControl
    | ReleaseControl
    | ChangeView
    | LoadScene
    | StartUpload
    | CancelUpload
    | CastRay
    | ReadRegisters
    | ReadCounters
)


def read_request(text: str) -> tuple[int, Request]:
    """Read a message: return its number, 0 where it has none, and the request.

    Raises
    ------
    Refused
        The message is no JSON object, its type is unknown, or a field is missing, unknown, out of range, or has the
        wrong type.
    """
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        raise Refused("a text message is no JSON; send a JSON object") from None
    if not isinstance(message, dict):
        raise Refused("a text message is no JSON object; send one with a type")
    number = _whole("request", message.pop("request", 0), 0, _REQUEST_LIMIT)
    kind = message.pop("type", None)
    reader = _READERS.get(kind) if isinstance(kind, str) else None
    if reader is None:
        raise Refused(f"{_shown(kind)} is no type of request; there are {', '.join(sorted(_READERS))}")
    request = reader(message)
    if message:
        raise Refused(f"the request {kind} has no field {_shown(next(iter(message)))}; leave it out")
    return number, request


def request_number(text: str) -> int:
    """Return the number of a message, malformed ones included; 0 where it has none."""
    try:
        number = json.loads(text)["request"]
    except (ValueError, RecursionError, TypeError, KeyError):
        return 0
    return number if type(number) is int and 0 <= number <= _REQUEST_LIMIT else 0


def _change_view(message: dict[str, Any]) -> ChangeView:
    def optional(field: str, read: Callable[[str, Any], Any]) -> Any:  # noqa: ANN401 - as the field is
        return read(field, message.pop(field)) if field in message else None

    return ChangeView(
        camera=optional("camera", _camera),
        size=optional("size", _size),
        background=optional("background", lambda name, value: _triple(name, value, 0, 255)),
        light=optional("light", _position),
        ambient=optional("ambient", lambda name, value: _whole(name, value, 0, 255)),
        features=optional("features", _features),
        shading=optional("shading", _shading),
        bounces=optional("bounces", lambda name, value: _whole(name, value, 0, 15)),
        nonstop=optional("nonstop", _truth),
        frame=optional("frame", lambda name, value: _whole(name, value, 0, _REQUEST_LIMIT)),
    )


def _start_upload(message: dict[str, Any]) -> StartUpload:
    files = message.pop("files", None)
    if not isinstance(files, list) or not 1 <= len(files) <= _FILES:
        raise Refused(f"files is not a list of 1 to {_FILES} files")
    check_only = _truth("check_only", message.pop("check_only", False))
    read = tuple(_file(entry) for entry in files)
    names = [file.name.casefold() for file in read]
    for file in read:
        if names.count(file.name.casefold()) > 1:
            raise Refused(f"two files have the name {file.name}; rename one of them")
    return StartUpload(read, check_only)


def _file(entry: object) -> UploadedFile:
    if not isinstance(entry, dict) or entry.keys() != {"name", "size", "crc32"}:
        raise Refused("a file of an upload is not {name, size, crc32}")
    return UploadedFile(
        _file_name(entry["name"]),
        _whole("size", entry["size"], 1, 1 << 40),
        _whole("crc32", entry["crc32"], 0, 0xFFFFFFFF),
    )


def _load_scene(message: dict[str, Any]) -> LoadScene:
    return LoadScene(_name("scene", message.pop("scene", None)))


_READERS: dict[str, Callable[[dict[str, Any]], Request]] = {
    "take": lambda _: TakeControl(),
    "release": lambda _: ReleaseControl(),
    "view": _change_view,
    "show": _load_scene,
    "upload": _start_upload,
    "cancel": lambda _: CancelUpload(),
    "ray": lambda message: CastRay(
        _position("origin", message.pop("origin", None)),
        _triple("direction", message.pop("direction", None), 1 - DIRECTION_LIMIT, DIRECTION_LIMIT - 1),
    ),
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


def _shading(name: str, value: object) -> Shading:
    for shading in _SHADINGS:
        if value == shading:
            return shading
    raise Refused(f"{name} {_shown(value)} is not {', '.join(_SHADINGS[:-1])} or {_SHADINGS[-1]}")


def _whole(name: str, value: object, low: int, high: int) -> int:
    if type(value) is not int or not low <= value <= high:
        raise Refused(f"{name} {_shown(value)} is not a whole number from {low} to {high}")
    return value


def _truth(name: str, value: object) -> bool:
    if not isinstance(value, bool):
        raise Refused(f"{name} {_shown(value)} is not true or false")
    return value


def _name(name: str, value: object) -> str:
    # isprintable() excludes control characters and those that change the direction of text.
    if not isinstance(value, str) or not value.isprintable() or not 1 <= len(value.encode()) <= _NAME:
        raise Refused(f"{name} {_shown(value)} is not a name of 1 to {_NAME} bytes of printable characters")
    return value


def _file_name(value: object) -> str:
    name = _name("name", value)
    if name in {".", ".."} or "/" in name or "\\" in name:
        raise Refused(f"{name}: is no plain file name; upload the files without their folders")
    return name


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:40]}…"
