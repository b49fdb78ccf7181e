"""An open glTF asset: its JSON, the bytes it refers to, its memory limit, and its warnings."""

from __future__ import annotations

import binascii
from typing import TYPE_CHECKING, TypeVar
from urllib.parse import unquote, unquote_to_bytes

import msgspec

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.authored_properties import explain
from voxrt.voxelize.formats.external_files import ALLOW_OUTSIDE, LFS_POINTER, ExternalFiles, refuse_pointer
from voxrt.voxelize.formats.gltf.container import read_container
from voxrt.voxelize.formats.gltf.extensions import MESHOPT
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from voxrt.voxelize.formats.gltf.schema import BufferView, Gltf, Property

T = TypeVar("T")

_FREE_BYTES = 128 << 20
_BYTES_PER_INPUT_BYTE = 128


class Document:
    """One glTF asset while it is being read: its path, its JSON (`gltf`) and its warnings (`log`).

    The asset's size limits the memory that it may use: :meth:`charge` counts what is made from it and refuses a small
    file that needs much. The sizes in the JSON are no limit: an accessor may have no bytes, or share them with others.
    """

    def __init__(self, path: Path, *, allow_outside: bool = False, opaque_from: float = OPAQUE_FROM) -> None:
        self.path = path
        self.opaque_from = opaque_from  # blended surfaces of a lower alpha are cut away
        self._external_files = ExternalFiles.of(path, allow_outside=allow_outside)
        self.gltf: Gltf
        self.gltf, self._binary = read_container(path)
        self._buffers: dict[int, memoryview] = {}
        self._unpacked: dict[int, bytes] = {}
        self._allowed = _FREE_BYTES + _BYTES_PER_INPUT_BYTE * path.stat().st_size
        self.log = WarningLog()
        self._check_views()

    def error(self, place: str, problem: str, fix: str = "export the file again") -> AssetError:
        """Return an error about the JSON path `place`."""
        return AssetError(self.path, problem, place=place, fix=fix)

    def charge(self, amount: int, place: str) -> None:
        """Count `amount` bytes towards the memory that an asset of this size may use."""
        self._allowed -= amount
        if self._allowed < 0:
            problem = f"needs {amount} bytes, more than a file of this size may use"
            raise self.error(place, problem, "check the counts: the file is damaged or hostile")

    def item(self, array: Sequence[T], index: int, place: str, kind: str) -> T:
        """Return `array[index]`; refuse a reference at `place` to a `kind` that does not exist."""
        if index >= len(array):
            raise self.error(place, f"{kind} {index} does not exist, the file has {len(array)}")
        return array[index]

    def extension(self, owner: Property, name: str, kind: type[T], place: str) -> T | None:
        """Return the extension `name` of `owner` at `place` as a value of `kind`; None where it has none."""
        if name not in owner.extensions:
            return None
        try:
            return msgspec.json.decode(owner.extensions[name], type=kind)
        except msgspec.ValidationError as error:
            problem, here = explain(error, f"{place}.extensions.{name}")
            raise self.error(here, problem) from None
        except (msgspec.DecodeError, RecursionError):
            raise self.error(f"{place}.extensions.{name}".removeprefix("."), "is not valid JSON") from None

    def view(self, index: int, place: str) -> memoryview:
        """Return the bytes of buffer view `index`, to which `place` refers."""
        view = self.item(self.gltf.buffer_views, index, place, "buffer view")
        if index in self._unpacked:
            return memoryview(self._unpacked[index])
        for name in MESHOPT:
            if name in view.extensions:
                self._unpacked[index] = self._decompressed(view, name, f"bufferViews[{index}]")
                return memoryview(self._unpacked[index])
        return self.buffer(view.buffer)[view.byte_offset : view.byte_offset + view.byte_length]

    def _decompressed(self, view: BufferView, name: str, place: str) -> bytes:
        from voxrt.voxelize.formats.gltf.meshopt import CompressedView, decode  # noqa: PLC0415 - few files need it
        from voxrt.voxelize.formats.gltf.meshopt_attributes import BadStreamError  # noqa: PLC0415

        compressed = self.extension(view, name, CompressedView, place)
        assert compressed is not None
        here = f"{place}.extensions.{name}"
        size = compressed.count * compressed.byte_stride
        self.charge(size * 4, here)
        buffer = self.item(self.gltf.buffers, compressed.buffer, f"{here}.buffer", "buffer")
        end = compressed.byte_offset + compressed.byte_length
        if end > buffer.byte_length:
            raise self.error(here, f"ends at byte {end} of a buffer of {buffer.byte_length}")
        if size != view.byte_length:
            raise self.error(here, f"holds {size} bytes for a buffer view of {view.byte_length}")
        data = self.buffer(compressed.buffer)[compressed.byte_offset : end]
        try:
            return decode(compressed, bytes(data))
        except BadStreamError as error:
            raise self.error(here, f"the compressed data is damaged: {error}") from None

    def _check_views(self) -> None:
        """Refuse a file whose buffer views leave their buffers, used or not: the file is cut short."""
        for index, view in enumerate(self.gltf.buffer_views):
            place = f"bufferViews[{index}]"
            buffer = self.item(self.gltf.buffers, view.buffer, f"{place}.buffer", "buffer")
            end = view.byte_offset + view.byte_length
            if end > buffer.byte_length:
                raise self.error(place, f"ends at byte {end} of a buffer of {buffer.byte_length}")

    def buffer(self, index: int) -> memoryview:
        """Return the bytes of buffer `index`, cut to its byteLength."""
        if index in self._buffers:
            return self._buffers[index]
        buffer = self.gltf.buffers[index]
        here = f"buffers[{index}]"
        if buffer.uri is not None:
            found = self.resource(buffer.uri, f"{here}.uri", max(buffer.byte_length, len(LFS_POINTER)))
            if found is None:
                problem = f"no file {buffer.uri[:60]!r} in the asset's folder"
                raise self.error(f"{here}.uri", problem, "put it there, or embed it in a .glb")
            refuse_pointer(self.path, found, f"{here}.uri")
            data = memoryview(found)
        elif index == 0 and self._binary is not None:
            data = self._binary
        else:
            raise self.error(here, "has no uri, and the file has no binary chunk")
        if len(data) < buffer.byte_length:
            raise self.error(here, f"its byteLength is {buffer.byte_length}, and it has {len(data)} bytes")
        self._buffers[index] = data[: buffer.byte_length]
        return self._buffers[index]

    def resource(self, uri: str, place: str, most: int = -1) -> bytes | None:
        """Return inline data, or at most `most` bytes of a file that may be opened; None where there is no such file.

        Raise AssetError for a place outside of the asset's folder, whether there is a file or not. A file adds to the
        asset's size, and so to the memory that the asset may use.
        """
        if uri.startswith("data:"):
            return self._inline(uri, place)
        scheme = uri.partition(":")[0]
        if ":" in uri and "/" not in scheme:
            raise self.error(place, f"the address {uri[:60]!r} was not opened", "put the file into the asset's folder")
        target = self._external_files.find(*_spellings(uri))
        if target is None:
            if self.is_outside(uri):
                raise self.error(place, f"{uri[:60]!r} is outside the asset's folder", ALLOW_OUTSIDE)
            return None
        try:
            with target.open("rb") as file:
                data = file.read(most)
        except OSError as error:
            problem = f"{uri[:60]!r} cannot be read: {error.strerror}"
            raise self.error(place, problem, "check its permissions") from error
        self._allowed += _BYTES_PER_INPUT_BYTE * len(data)
        return data

    def is_outside(self, uri: str) -> bool:
        """Tell whether `uri` is the path of a place that may not be opened."""
        return ":" not in uri.partition("/")[0] and self._external_files.is_outside(*_spellings(uri))

    def _inline(self, uri: str, place: str) -> bytes:
        header, comma, body = uri.partition(",")
        if not comma:
            raise self.error(place, "a data URI without a comma")
        if ";;" in header:
            raise self.error(place, "a data URI with an empty parameter: ';;'")
        if not header.endswith(";base64"):
            return unquote_to_bytes(body)
        text = unquote(body) if "%" in body else body
        try:
            return binascii.a2b_base64(text + "=" * (-len(text) % 4), strict_mode=True)
        except (binascii.Error, ValueError):
            raise self.error(place, "a data URI that is not base64") from None


def _spellings(uri: str) -> tuple[str, ...]:
    """Return the paths that a URI may mean: some exporters do not encode names, or write backslashes.

    Web viewers append queries.
    """
    plain = unquote(uri)
    return plain, uri, plain.replace("\\", "/"), unquote(uri.partition("?")[0].partition("#")[0])
