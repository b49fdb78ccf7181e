"""A scene, or the reason why there is none, as bytes that one process sends to another.

A message is two lengths (uint64, little-endian), then JSON of :class:`Message`, then the arrays, 64 bytes apart at
least. What several objects share (meshes, textures, colliders) is sent once and shared again afterwards. The receiver
trusts nothing: JSON is checked against the types below, arrays against the length, and values by the classes that hold
them. Pickle would run code of the sender's choice.
"""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, Annotated, Generic, Literal, TypeAlias, TypeVar

import msgspec
import numpy as np
from msgspec.structs import replace

from voxrt.voxelize.collider_shapes import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.texture import Texture, Wrap
from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.errors import SceneWarning  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.materials import Material  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.mesh import Mesh
from voxrt.voxelize.rules import ObjectFill, Rule  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.scene import PointLight, Scene, SceneObject, Viewpoint

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

LENGTHS = struct.Struct("<QQ")
"""The first bytes of a message: the length of its JSON, and that of its arrays."""

_ALIGNMENT = 64

T = TypeVar("T")
Row: TypeAlias = Annotated[int, msgspec.Meta(ge=0)]

# Arrays stand in JSON as :class:`ArrayMessage`; what is shared stands there by its number.
TextureMessage: TypeAlias = tuple[np.ndarray, tuple[Wrap, Wrap], bool]
AppearanceMessage: TypeAlias = tuple[str, tuple[float, float, float, float], Row | None, float, bool]


class ArrayMessage(msgspec.Struct, array_like=True, frozen=True):
    """Where an array is."""

    dtype: Literal["<f4", "<f8", "<i4", "<i8", "|u1"]
    shape: tuple[Row, ...]
    offset: Row


class MeshMessage(msgspec.Struct, frozen=True):
    """A :class:`Mesh`."""

    positions: np.ndarray
    triangles: np.ndarray
    materials: np.ndarray
    appearance: tuple[list[Row], np.ndarray, np.ndarray, np.ndarray] | None
    normals: tuple[np.ndarray, np.ndarray] | None


class ColliderMessage(msgspec.Struct, frozen=True):
    """A collider: the arrays of its kind, in the order of its attributes."""

    kind: Literal["box", "sphere", "hull", "mesh"]
    arrays: list[np.ndarray]
    radius: float = 0.0
    pow2: bool = True


class ObjectsMessage(msgspec.Struct, frozen=True):
    """All objects of a scene, column by column; meshes and colliders by number."""

    names: list[str]
    meshes: list[Row]
    transforms: np.ndarray
    colliders: list[list[Row]]
    materials: list[Row]
    hidden: list[bool]
    represented: list[bool]
    rules: list[Rule | None]
    fills: list[ObjectFill | None]


class SceneMessage(msgspec.Struct, frozen=True):
    """A :class:`Scene`."""

    name: str
    objects: ObjectsMessage
    meshes: list[MeshMessage]
    appearances: list[AppearanceMessage]
    textures: list[TextureMessage]
    colliders: list[ColliderMessage]
    materials: list[Material]
    warnings: list[SceneWarning]
    cameras: list[Viewpoint]
    viewpoint: Row | None
    light: PointLight | None


class AssetErrorMessage(msgspec.Struct, frozen=True, tag="asset"):
    """An :class:`AssetError`; the receiver knows the file."""

    problem: str
    place: str
    fix: str


class DoesNotFitMessage(msgspec.Struct, frozen=True, tag="fit"):
    """A :class:`DoesNotFitError`."""

    problem: str


class MemoryMessage(msgspec.Struct, frozen=True, tag="memory"):
    """The memory that the sender may use was not enough."""


class FaultMessage(msgspec.Struct, frozen=True, tag="fault"):
    """An error that the sender did not expect, and where it came from."""

    error: str
    traceback: str


Failure: TypeAlias = AssetErrorMessage | DoesNotFitMessage | MemoryMessage | FaultMessage


class Message(msgspec.Struct, frozen=True):
    """One of both."""

    scene: SceneMessage | None = None
    failure: Failure | None = None


class BadMessageError(Exception):
    """Bytes that are no message."""


def failure_bytes(failure: Failure) -> list[bytes]:
    """Return the parts of the message about a failure."""
    text = msgspec.json.encode(Message(failure=failure))
    return [LENGTHS.pack(len(text), 0), text]


def scene_bytes(scene: Scene) -> list[bytes | memoryview]:
    """Return the parts of a scene's message, in order; arrays are not copied where they can be sent as they are."""
    meshes: _Shared[Mesh] = _Shared()
    colliders: _Shared[Collider] = _Shared()
    textures: _Shared[Texture] = _Shared()
    appearances: _Shared[Appearance] = _Shared()
    cameras = list(scene.cameras)
    if scene.viewpoint is not None and scene.viewpoint not in cameras:
        raise ValueError("the viewpoint of a scene that is sent must be one of its cameras")
    message = SceneMessage(
        _text(scene.name),
        ObjectsMessage(
            [_text(one.name) for one in scene.objects],
            [meshes.number(one.mesh) for one in scene.objects],
            np.array([one.transform for one in scene.objects], dtype=np.float64).reshape(-1, 4, 4),
            [[colliders.number(collider) for collider in one.colliders] for one in scene.objects],
            [one.collider_material for one in scene.objects],
            [one.hidden for one in scene.objects],
            [one.represented for one in scene.objects],
            [one.rule for one in scene.objects],
            [one.fill for one in scene.objects],
        ),
        [_mesh_message(one, appearances) for one in meshes],
        [_appearance_message(one, textures) for one in appearances],
        [(one.pixels, one.wrap, one.nearest) for one in textures],
        [_collider_message(one) for one in colliders],
        [replace(one, name=_text(one.name)) for one in scene.materials],
        [replace(one, message=_text(one.message)) for one in scene.warnings],
        [replace(one, name=_text(one.name)) for one in cameras],
        None if scene.viewpoint is None else cameras.index(scene.viewpoint),
        scene.light,
    )
    arrays = _Arrays()
    text = msgspec.json.encode(Message(scene=message), enc_hook=arrays.add)
    return [LENGTHS.pack(len(text), arrays.length), text, *arrays.parts]


def read_message(text: bytes, arrays: NDArray[np.uint8]) -> Scene | Failure:
    """Return what a message says: `text` is its JSON, and `arrays`, uint8, shape (N,), the bytes of its arrays.

    The scene's arrays are views of them. Raise BadMessageError where the message contradicts itself.
    """

    def array(_: type, place: object) -> NDArray[np.generic]:
        one = msgspec.convert(place, ArrayMessage)
        count = math.prod(one.shape)
        if one.offset + count * np.dtype(one.dtype).itemsize > len(arrays):
            raise ValueError(f"an array of {one.shape} ends beyond the message")
        return np.frombuffer(arrays, dtype=one.dtype, count=count, offset=one.offset).reshape(one.shape)

    try:
        message = msgspec.json.decode(text, type=Message, dec_hook=array)
        if message.failure is not None:
            return message.failure
        if message.scene is None:
            raise BadMessageError("a message without content")
        return _scene(message.scene)
    except (msgspec.DecodeError, IndexError, TypeError, ValueError) as error:
        raise BadMessageError(str(error)) from error


def _scene(message: SceneMessage) -> Scene:
    textures = [Texture(*one) for one in message.textures]
    appearances = [
        Appearance(name, factor, None if texture is None else textures[texture], cutoff, mirror)
        for name, factor, texture, cutoff, mirror in message.appearances
    ]
    meshes = [_mesh(one, appearances) for one in message.meshes]
    colliders = [_collider(one) for one in message.colliders]
    objects = message.objects
    return Scene(
        message.name,
        tuple(
            SceneObject(
                objects.names[i],
                meshes[objects.meshes[i]],
                objects.transforms[i],
                tuple(colliders[row] for row in objects.colliders[i]),
                objects.materials[i],
                hidden=objects.hidden[i],
                represented=objects.represented[i],
                rule=objects.rules[i],
                fill=objects.fills[i],
            )
            for i in range(_common_length(objects))
        ),
        tuple(message.materials),
        tuple(message.warnings),
        None if message.viewpoint is None else message.cameras[message.viewpoint],
        message.light,
        tuple(message.cameras),
    )


def _common_length(objects: ObjectsMessage) -> int:
    lengths = {len(getattr(objects, column)) for column in objects.__struct_fields__}
    if len(lengths) != 1:
        raise ValueError(f"columns of objects have {lengths} rows")
    return lengths.pop()


def _mesh_message(one: Mesh, appearances: _Shared[Appearance]) -> MeshMessage:
    surface = normals = None
    if one.appearance is not None:
        entries = [appearances.number(entry) for entry in one.appearance.entries]
        surface = entries, one.appearance.rows, one.appearance.uv, one.appearance.colours
    if one.normals is not None:
        normals = one.normals.vectors, one.normals.rows
    return MeshMessage(one.positions, one.triangles, one.materials, surface, normals)


def _mesh(message: MeshMessage, appearances: list[Appearance]) -> Mesh:
    surface = None
    if message.appearance is not None:
        entries, *arrays = message.appearance
        surface = SurfaceAppearance(tuple(appearances[row] for row in entries), *arrays)
    normals = message.normals and CornerNormals(*message.normals)
    return Mesh(message.positions, message.triangles, message.materials, surface, normals=normals)


def _appearance_message(one: Appearance, textures: _Shared[Texture]) -> AppearanceMessage:
    texture = None if one.texture is None else textures.number(one.texture)
    return _text(one.name), one.factor, texture, one.cutoff, one.mirror


def _collider_message(one: Collider) -> ColliderMessage:
    if isinstance(one, BoxCollider):
        return ColliderMessage("box", [one.minimum, one.maximum], pow2=one.pow2)
    if isinstance(one, SphereCollider):
        return ColliderMessage("sphere", [one.centre], radius=one.radius)
    if isinstance(one, HullCollider):
        return ColliderMessage("hull", [one.positions])
    return ColliderMessage("mesh", [one.positions, one.triangles])


def _collider(message: ColliderMessage) -> Collider:
    first, *others = message.arrays
    match message.kind:
        case "box":
            return BoxCollider(first, others[0], message.pow2)
        case "sphere":
            return SphereCollider(first, message.radius)
        case "hull":
            return HullCollider(first)
        case "mesh":
            return MeshCollider(first, others[0])


class _Arrays:
    """Arrays that are to be sent, each at a multiple of the alignment; one array is sent once."""

    def __init__(self) -> None:
        self.parts: list[bytes | memoryview] = []
        self.length = 0
        self._known: dict[int, ArrayMessage] = {}  # an id is unique, for the message keeps its arrays

    def add(self, array: NDArray[np.generic]) -> ArrayMessage:
        if id(array) not in self._known:
            little = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))
            self._known[id(array)] = ArrayMessage(little.dtype.str, little.shape, self.length)
            if little.size:
                self.parts.append(little.reshape(-1).view(np.uint8).data)
            padding = -little.nbytes % _ALIGNMENT
            self.parts.append(bytes(padding))
            self.length += little.nbytes + padding
        return self._known[id(array)]


class _Shared(Generic[T]):
    """Values by identity, numbered in order of first use. Values may be added during a traversal."""

    def __init__(self) -> None:
        self._numbers: dict[int, int] = {}
        self._values: list[T] = []

    def number(self, value: T) -> int:
        if id(value) not in self._numbers:
            self._numbers[id(value)] = len(self._values)
            self._values.append(value)
        return self._numbers[id(value)]

    def __iter__(self) -> Iterator[T]:
        return iter(self._values)


def _text(name: str) -> str:
    """Return text without what cannot be sent: parts of names that are not UTF-8."""
    return name.encode("utf-8", "replace").decode()
