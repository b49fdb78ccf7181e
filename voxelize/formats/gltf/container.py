"""A glTF file or GLB container taken apart: the validated JSON, and the binary chunk of a GLB.

Source: Khronos, glTF 2.0 specification, section 4 (GLB file format).
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import msgspec

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.authored_properties import explain
from voxrt.voxelize.formats.external_files import read_asset
from voxrt.voxelize.formats.gltf.schema import Gltf

if TYPE_CHECKING:
    from pathlib import Path

_MAGIC = b"glTF"
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
_RE_EXPORT = "the file is damaged: export or download it again"

_decoder = msgspec.json.Decoder(Gltf)


def read_container(path: Path) -> tuple[Gltf, memoryview | None]:
    """Read `path`, as GLB where it starts like one, else as JSON: the file's JSON, and the binary chunk of a GLB.

    Raise AssetError where the container is broken, or its JSON is not glTF 2.
    """
    data = read_asset(path)
    if data[:4] == _MAGIC:
        text, binary = _split_glb(path, data)
    else:
        text, binary = memoryview(data), None
    return _parse(path, bytes(text)), binary


def _split_glb(path: Path, data: bytes) -> tuple[memoryview, memoryview | None]:
    if len(data) < 20:
        raise AssetError(path, f"a GLB of {len(data)} bytes ends before its JSON chunk", fix=_RE_EXPORT)
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise AssetError(
            path,
            f"is a GLB of version {version}, and version 2 is read",
            fix="convert it to glTF 2.0, by gltf-pipeline for example",
        )
    if length != len(data):
        raise AssetError(path, f"the GLB says it has {length} bytes and has {len(data)}", fix=_RE_EXPORT)
    chunks: dict[int, memoryview] = {}
    whole = memoryview(data)
    at = 12
    while at < length:
        if length - at < 8:
            raise AssetError(path, "ends inside a chunk header", place=f"byte {at}", fix=_RE_EXPORT)
        size, kind = struct.unpack_from("<II", data, at)
        if size > length - at - 8:
            problem = f"a chunk of {size} bytes where {length - at - 8} are left"
            raise AssetError(path, problem, place=f"byte {at}", fix=_RE_EXPORT)
        if size % 4:
            problem = f"a chunk of {size} bytes, not a multiple of 4"
            raise AssetError(path, problem, place=f"byte {at}", fix=_RE_EXPORT)
        if (kind == _JSON_CHUNK) != (at == 12):
            raise AssetError(path, "the JSON chunk is not the first", place=f"byte {at}", fix=_RE_EXPORT)
        if kind == _BINARY_CHUNK and len(chunks) != 1:
            raise AssetError(path, "the binary chunk is not the second", place=f"byte {at}", fix=_RE_EXPORT)
        chunks[kind] = whole[at + 8 : at + 8 + size]
        at += 8 + size
    return chunks[_JSON_CHUNK], chunks.get(_BINARY_CHUNK)


class _Asset1(msgspec.Struct, frozen=True):
    version: str | float = ""


class _Gltf1(msgspec.Struct, frozen=True):
    asset: _Asset1 = _Asset1()


def _refuse_version_1(path: Path, text: bytes) -> None:
    """Raise AssetError for a file of glTF 1.0, whose lists are objects."""
    try:
        version = msgspec.json.decode(text.removeprefix(b"\xef\xbb\xbf"), type=_Gltf1).asset.version
    except msgspec.DecodeError:
        return
    if str(version).startswith("1"):
        fix = "convert it to 2.0, by gltf-pipeline for example"
        raise AssetError(path, f"is glTF {version}, and glTF 2.0 is read", place="asset", fix=fix)


def _parse(path: Path, text: bytes) -> Gltf:
    try:
        str(text, "utf-8")  # the decoder looks only at the strings it needs
    except UnicodeDecodeError as error:
        raise AssetError(path, "the JSON is not UTF-8", place=f"byte {error.start}", fix=_RE_EXPORT) from None
    try:
        gltf = _decoder.decode(text.removeprefix(b"\xef\xbb\xbf"))
    except msgspec.ValidationError as error:
        _refuse_version_1(path, text)
        problem, place = explain(error)
        fix = "the file breaks the glTF 2.0 schema: export it again"
        raise AssetError(path, problem, place=place, fix=fix) from None
    except msgspec.DecodeError as error:
        raise AssetError(path, f"the JSON cannot be read ({error})", fix=_RE_EXPORT) from None
    except RecursionError:
        raise AssetError(path, "the JSON is nested too deeply", fix=_RE_EXPORT) from None
    if gltf.asset.version.partition(".")[0] != "2" or gltf.asset.min_version != "2.0":
        problem = f"written in glTF {gltf.asset.version}, to be read by {gltf.asset.min_version} and later"
        raise AssetError(path, problem, place="asset", fix="export as glTF 2.0")
    return gltf
