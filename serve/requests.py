"""The requests of clients: JSON messages, with every field checked. ``docs/protocol.md`` documents them."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

import msgspec
from msgspec.structs import replace

from voxrt.board.errors import Refused
from voxrt.board.view import Camera, Lighting, Shading, View
from voxrt.octree.camera import DIRECTION_LIMIT
from voxrt.octree.query import Corner  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.serve.edits import EditOperation  # noqa: TC001 - msgspec resolves the annotations of this module

_NAME = 200
_BOUNCES = 4  # of mirrors that are turned on without a number

_Number: TypeAlias = Annotated[int, msgspec.Meta(ge=0, le=(1 << 32) - 1)]
_Byte: TypeAlias = Annotated[int, msgspec.Meta(ge=0, le=255)]
_Side: TypeAlias = Annotated[int, msgspec.Meta(ge=1, le=1 << 14)]
_Place: TypeAlias = Annotated[int, msgspec.Meta(ge=-(1 << 31), le=(1 << 31) - 1)]
_Register: TypeAlias = Annotated[int, msgspec.Meta(ge=-(1 << 15), le=(1 << 15) - 1)]
_Component: TypeAlias = Annotated[int, msgspec.Meta(ge=1 - DIRECTION_LIMIT, le=DIRECTION_LIMIT - 1)]
_Position: TypeAlias = tuple[_Place, _Place, _Place]
_Axis: TypeAlias = tuple[_Register, _Register, _Register]


class Request(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="type"):
    """A request; its answers repeat its number."""

    request: _Number = 0


class TakeControl(Request, frozen=True, tag="take"):
    """Get control."""


class ReleaseControl(Request, frozen=True, tag="release"):
    """Give control to the next client that waits for it."""


class _Camera(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    position: _Position
    look: _Axis
    right: _Axis
    up: _Axis


class ChangeView(Request, frozen=True, tag="view"):
    """Change the view; a field that is None stays as it is."""

    camera: _Camera | None = None
    size: tuple[_Side, _Side] | None = None
    background: tuple[_Byte, _Byte, _Byte] | None = None
    light: _Position | None = None
    ambient: _Byte | None = None
    features: frozenset[Literal["light", "mirrors"]] | None = None
    shading: Shading | None = None
    bounces: Annotated[int, msgspec.Meta(ge=0, le=15)] | None = None
    nonstop: bool | None = None
    frame: _Number | None = None

    def applied_to(self, view: View) -> View:
        """Make the view that is asked for."""
        fields = ("size", "background", "frame")
        changed: dict[str, Any] = {name: value for name in fields if (value := getattr(self, name)) is not None}
        if self.camera is not None:
            changed["camera"] = Camera(*msgspec.structs.astuple(self.camera))
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


class LoadScene(Request, frozen=True, tag="show"):
    """Load the server's own scene with this name."""

    scene: str

    def __post_init__(self) -> None:
        _check_name("scene", self.scene)


class UploadedFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A file that follows in chunks."""

    name: str
    size: Annotated[int, msgspec.Meta(ge=1, le=1 << 40)]
    crc32: _Number

    def __post_init__(self) -> None:
        _check_name("name", self.name)
        if self.name in {".", ".."} or "/" in self.name or "\\" in self.name:
            raise Refused(f"{self.name}: is no plain file name; upload the files without their folders")


class StartUpload(Request, frozen=True, tag="upload"):
    """Load a scene that is made from these files; with `check_only` nothing is written to the device."""

    files: Annotated[tuple[UploadedFile, ...], msgspec.Meta(min_length=1, max_length=64)]
    check_only: bool = False

    def __post_init__(self) -> None:
        names = [file.name.casefold() for file in self.files]
        for file in self.files:
            if names.count(file.name.casefold()) > 1:
                raise Refused(f"two files have the name {file.name}; rename one of them")


class CancelUpload(Request, frozen=True, tag="cancel"):
    """Discard the upload in progress."""


class ReadRegisters(Request, frozen=True, tag="registers"):
    """Get all registers of the device."""


class ReadCounters(Request, frozen=True, tag="counters"):
    """Get the counters of the server."""


class CastRay(Request, frozen=True, tag="ray"):
    """Find the first solid voxel on a ray: origin, 1/16 voxel, and direction."""

    origin: _Position
    direction: tuple[_Component, _Component, _Component]


class EditScene(Request, frozen=True, tag="edit"):
    """Edit the scene that is shown; edits in a row of one stroke, other than 0, are undone together."""

    operation: EditOperation
    stroke: _Number = 0


class CutSolid(Request, frozen=True, tag="solid"):
    """Get the solid voxels of a box, for who walks there."""

    low: Corner
    high: Corner


class ListMaterials(Request, frozen=True, tag="materials"):
    """Get the names and colours of the scene's materials."""


class SaveScene(Request, frozen=True, tag="save"):
    """Make files of the scene that is shown."""

    suffix: Literal[".mem", ".blob", ".vox"]


class ReadSaved(Request, frozen=True, tag="part"):
    """Get a part of the files that were made last, from a byte on."""

    offset: _Number


class _Numbered(msgspec.Struct):
    request: _Number = 0


_Any: TypeAlias = (
    TakeControl
    | ReleaseControl
    | ChangeView
    | LoadScene
    | StartUpload
    | CancelUpload
    | CastRay
    | EditScene
    | CutSolid
    | ListMaterials
    | SaveScene
    | ReadSaved
    | ReadRegisters
    | ReadCounters
)
_REQUESTS: msgspec.json.Decoder[_Any] = msgspec.json.Decoder(_Any)
_NUMBERS = msgspec.json.Decoder(_Numbered)


def read_request(text: str) -> _Any:
    """Read a message.

    Raises
    ------
    Refused
        The message is no JSON object, its type is unknown, or a field is missing, unknown, out of range, or has the
        wrong type.
    """
    try:
        return _REQUESTS.decode(text)
    except (msgspec.MsgspecError, UnicodeError, RecursionError) as error:
        raise Refused(f"a text message is no request ({error}); send a JSON object of the protocol") from None


def request_number(text: str) -> int:
    """Return the number of a message, malformed ones included; 0 where it has none."""
    try:
        return _NUMBERS.decode(text).request
    except (msgspec.MsgspecError, UnicodeError, RecursionError):
        return 0


def _check_name(field: str, name: str) -> None:
    # isprintable() excludes control characters and those that change the direction of text.
    if not name.isprintable() or not 1 <= len(name.encode()) <= _NAME:
        raise Refused(f"{field} {name[:40]!r} is not a name of 1 to {_NAME} bytes of printable characters")
