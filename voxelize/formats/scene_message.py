"""A scene, or the reason why there is none, as bytes that one process sends to another.

A message is two lengths (uint64, little-endian), then JSON of :class:`Message`, then the arrays, 64 bytes apart at
least. What several objects share (meshes, textures, colliders) is sent once and shared again afterwards. The receiver
trusts nothing: JSON is checked against the types below, arrays against the length, and values by the classes that hold
them. Pickle would run code of the sender's choice.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Annotated, Generic, Literal, TypeAlias, TypeVar

import msgspec
import numpy as np

from voxrt.voxelize.collider_shapes import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.texture import Texture, Wrap
from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.errors import SceneWarning
from voxrt.voxelize.materials import Material
from voxrt.voxelize.mesh import Mesh
from voxrt.voxelize.scene import PointLight, Scene, SceneObject, Viewpoint

if TYPE_CHECKING:
    from numpy.typing import NDArray

LENGTHS = struct.Struct("<QQ")
"""The first bytes of a message: the length of its JSON, and that of its arrays."""

_ALIGNMENT = 64

T = TypeVar("T")
Three: TypeAlias = tuple[float, float, float]
Row: TypeAlias = Annotated[int, msgspec.Meta(ge=0)]


class ArrayMessage(msgspec.Struct, array_like=True, frozen=True):
    """Where an array is."""

    dtype: Literal["<f4", "<f8", "<i4", "<i8", "|u1"]
    shape: tuple[Row, ...]
    offset: Row


class AppearanceMessage(msgspec.Struct, frozen=True):
    """An :class:`Appearance`; its texture by number."""

    name: str
    factor: tuple[float, float, float, float]
    texture: Row | None
    cutoff: float
    mirror: bool


class SurfaceAppearanceMessage(msgspec.Struct, frozen=True):
    """A :class:`SurfaceAppearance`; its appearances by number."""

    entries: list[Row]
    rows: ArrayMessage
    uv: ArrayMessage
    colours: ArrayMessage


class NormalsMessage(msgspec.Struct, frozen=True):
    """:class:`CornerNormals`."""

    vectors: ArrayMessage
    rows: ArrayMessage


class MeshMessage(msgspec.Struct, frozen=True):
    """A :class:`Mesh`."""

    positions: ArrayMessage
    triangles: ArrayMessage
    materials: ArrayMessage
    appearance: SurfaceAppearanceMessage | None
    normals: NormalsMessage | None


class ColliderMessage(msgspec.Struct, frozen=True):
    """A collider: the arrays of its kind, in the order of its attributes."""

    kind: Literal["box", "sphere", "hull", "mesh"]
    arrays: list[ArrayMessage]
    radius: float = 0.0
    pow2: bool = True


class TextureMessage(msgspec.Struct, frozen=True):
    """A :class:`Texture`."""

    pixels: ArrayMessage
    wrap: tuple[Wrap, Wrap]
    nearest: bool


class ObjectsMessage(msgspec.Struct, frozen=True):
    """All objects of a scene, column by column; meshes and colliders by number."""

    names: list[str]
    meshes: list[Row]
    colliders: list[list[Row]]
    materials: list[Row]
    hidden: list[bool]
    represented: list[bool]
    transforms: ArrayMessage


class SceneMessage(msgspec.Struct, frozen=True):
    """A :class:`Scene`."""

    name: str
    textures: list[TextureMessage]
    appearances: list[AppearanceMessage]
    meshes: list[MeshMessage]
    colliders: list[ColliderMessage]
    objects: ObjectsMessage
    materials: list[tuple[str, tuple[int, int, int], bool, bool]]
    warnings: list[tuple[str, str, int]]
    cameras: list[tuple[Three, Three, float | None, Three | None, str]]
    viewpoint: Row | None
    light: Three | None


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
    arrays = _Arrays()
    meshes: _Shared[Mesh] = _Shared()
    colliders: _Shared[Collider] = _Shared()
    textures: _Shared[Texture] = _Shared()
    appearances: _Shared[Appearance] = _Shared()
    objects = ObjectsMessage(
        [_text(one.name) for one in scene.objects],
        [meshes.number(one.mesh) for one in scene.objects],
        [[colliders.number(collider) for collider in one.colliders] for one in scene.objects],
        [one.collider_material for one in scene.objects],
        [one.hidden for one in scene.objects],
        [one.represented for one in scene.objects],
        arrays.add(np.array([one.transform for one in scene.objects], dtype=np.float64).reshape(-1, 4, 4)),
    )
    sent_meshes = [
        MeshMessage(
            arrays.add(one.positions),
            arrays.add(one.triangles),
            arrays.add(one.materials),
            None
            if one.appearance is None
            else SurfaceAppearanceMessage(
                [appearances.number(entry) for entry in one.appearance.entries],
                arrays.add(one.appearance.rows),
                arrays.add(one.appearance.uv),
                arrays.add(one.appearance.colours),
            ),
            None
            if one.normals is None
            else NormalsMessage(arrays.add(one.normals.vectors), arrays.add(one.normals.rows)),
        )
        for one in meshes
    ]
    sent_appearances = [
        AppearanceMessage(
            _text(one.name),
            one.factor,
            None if one.texture is None else textures.number(one.texture),
            one.cutoff,
            one.mirror,
        )
        for one in appearances
    ]
    cameras = list(scene.cameras)
    if scene.viewpoint is not None and scene.viewpoint not in cameras:
        raise ValueError("the viewpoint of a scene that is sent must be one of its cameras")
    message = SceneMessage(
        name=_text(scene.name),
        textures=[TextureMessage(arrays.add(one.pixels), one.wrap, one.nearest) for one in textures],
        appearances=sent_appearances,
        meshes=sent_meshes,
        colliders=[_collider_message(one, arrays) for one in colliders],
        objects=objects,
        materials=[(_text(one.name), one.colour, one.mirror, one.authored) for one in scene.materials],
        warnings=[(one.kind, _text(one.message), one.count) for one in scene.warnings],
        cameras=[(one.eye, one.target, one.field_of_view, one.up, _text(one.name)) for one in cameras],
        viewpoint=None if scene.viewpoint is None else cameras.index(scene.viewpoint),
        light=None if scene.light is None else scene.light.position,
    )
    text = msgspec.json.encode(Message(scene=message))
    return [LENGTHS.pack(len(text), arrays.length), text, *arrays.parts]


def read_message(text: bytes, arrays: NDArray[np.uint8]) -> Scene | Failure:
    """Return what a message says: `text` is its JSON, and `arrays`, uint8, shape (N,), the bytes of its arrays.

    The scene's arrays are views of them. Raise BadMessageError where the message contradicts itself.
    """
    try:
        message = msgspec.json.decode(text, type=Message)
        if message.failure is not None:
            return message.failure
        if message.scene is None:
            raise BadMessageError("a message without content")
        return _scene(message.scene, arrays)
    except (msgspec.DecodeError, IndexError, TypeError, ValueError) as error:
        raise BadMessageError(str(error)) from error


def _scene(message: SceneMessage, arrays: NDArray[np.uint8]) -> Scene:
    def array(one: ArrayMessage) -> NDArray[np.generic]:
        kind = np.dtype(one.dtype)
        count = 1
        for side in one.shape:
            count *= side
        if one.offset + count * kind.itemsize > len(arrays):
            raise BadMessageError(f"an array of {one.shape} ends beyond the message")
        return np.frombuffer(arrays, dtype=kind, count=count, offset=one.offset).reshape(one.shape)

    textures = [Texture(array(one.pixels), one.wrap, one.nearest) for one in message.textures]  # type: ignore[arg-type]
    appearances = [
        Appearance(one.name, one.factor, None if one.texture is None else textures[one.texture], one.cutoff, one.mirror)
        for one in message.appearances
    ]
    meshes = [
        Mesh(
            array(one.positions),  # type: ignore[arg-type]
            array(one.triangles),  # type: ignore[arg-type]
            array(one.materials),  # type: ignore[arg-type]
            None
            if one.appearance is None
            else SurfaceAppearance(
                tuple(appearances[row] for row in one.appearance.entries),
                array(one.appearance.rows),  # type: ignore[arg-type]
                array(one.appearance.uv),  # type: ignore[arg-type]
                array(one.appearance.colours),  # type: ignore[arg-type]
            ),
            normals=None if one.normals is None else CornerNormals(array(one.normals.vectors), array(one.normals.rows)),  # type: ignore[arg-type]
        )
        for one in message.meshes
    ]
    colliders = [_collider(one, [array(part) for part in one.arrays]) for one in message.colliders]
    cameras = tuple(Viewpoint(*camera) for camera in message.cameras)
    objects = tuple(
        SceneObject(name, meshes[mesh], transform, tuple(colliders[row] for row in own), material, *flags)
        for name, mesh, transform, own, material, *flags in zip(
            message.objects.names,
            message.objects.meshes,
            array(message.objects.transforms),
            message.objects.colliders,
            message.objects.materials,
            message.objects.hidden,
            message.objects.represented,
            strict=True,
        )
    )
    return Scene(
        message.name,
        objects,
        tuple(Material(*one) for one in message.materials),
        tuple(SceneWarning(*one) for one in message.warnings),
        None if message.viewpoint is None else cameras[message.viewpoint],
        None if message.light is None else PointLight(message.light),
        cameras,
    )


def _collider_message(one: Collider, arrays: _Arrays) -> ColliderMessage:
    if isinstance(one, BoxCollider):
        return ColliderMessage("box", [arrays.add(one.minimum), arrays.add(one.maximum)], pow2=one.pow2)
    if isinstance(one, SphereCollider):
        return ColliderMessage("sphere", [arrays.add(one.centre)], radius=one.radius)
    if isinstance(one, HullCollider):
        return ColliderMessage("hull", [arrays.add(one.positions)])
    return ColliderMessage("mesh", [arrays.add(one.positions), arrays.add(one.triangles)])


def _collider(message: ColliderMessage, parts: list[NDArray[np.generic]]) -> Collider:
    first = parts[0]
    match message.kind:
        case "box":
            return BoxCollider(first, parts[1], message.pow2)  # type: ignore[arg-type]
        case "sphere":
            return SphereCollider(first, message.radius)  # type: ignore[arg-type]
        case "hull":
            return HullCollider(first)  # type: ignore[arg-type]
        case "mesh":
            return MeshCollider(first, parts[1])  # type: ignore[arg-type]


class _Arrays:
    """Arrays that are to be sent, each at a multiple of the alignment; one array is sent once."""

    def __init__(self) -> None:
        self.parts: list[bytes | memoryview] = []
        self.length = 0
        self._known: dict[int, tuple[NDArray[np.generic], ArrayMessage]] = {}

    def add(self, array: NDArray[np.generic]) -> ArrayMessage:
        if id(array) in self._known:  # the array is kept, for an id is unique only while its array lives
            return self._known[id(array)][1]
        little = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))
        message = ArrayMessage(little.dtype.str, little.shape, self.length)
        if little.size:
            self.parts.append(little.reshape(-1).view(np.uint8).data)
        padding = -little.nbytes % _ALIGNMENT
        self.parts.append(bytes(padding))
        self.length += little.nbytes + padding
        self._known[id(array)] = (array, message)
        return message


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

    def __iter__(self):  # type: ignore[no-untyped-def]  # noqa: ANN204
        return iter(self._values)


def _text(name: str) -> str:
    """Return text without what cannot be sent: parts of names that are not UTF-8."""
    return name.encode("utf-8", "replace").decode()
