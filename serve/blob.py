"""A scene from a blob, one file that holds all of a scene. ``docs/blob.md`` documents every byte."""

from __future__ import annotations

import math
import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np

from ..board.errors import Refused
from ..board.scene import Scene, frame_period
from ..board.view import FACES, Camera, Faces, Lighting

if TYPE_CHECKING:
    from numpy.typing import NDArray

MAGIC = b"VOXRTBLB"
VERSION = 1

_HEADER = struct.Struct("<8sIIII")  # magic, version, number of sections, bytes of the file, CRC-32 of the table
_ENTRY = struct.Struct("<4sIII")  # name, offset, bytes, CRC-32
_DEPTH = struct.Struct("<I")  # the rest of the section places the grid in the scene; boards do not use it
_MATERIAL = struct.Struct("<4BHxx")  # red, green, blue, flags, bytes of the name
_VIEW = struct.Struct("<12i")  # position, look, right, up
_LIGHT = struct.Struct("<3i4B")  # position, ambient, flags, bounces, 0
_FRAME = struct.Struct("<IIdHxxxxxx")  # root, words of the frame alone, second or NaN, bytes of the name
_FACES = struct.Struct("<6B")  # brightness of the faces along -x, +x, -y, +y, -z, +z; absent where it is the default

_MIRROR = 1
_LIGHT_ON, _FLAT, _BY_ANGLE = 1, 2, 4


def read_blob(data: bytes) -> Scene:
    """Read the bytes of a blob.

    Raises
    ------
    Refused
        The bytes are no blob, or a blob of another version, or damaged; the message names the section.
    """
    sections = _sections(data)
    try:
        name = sections[b"NAME"].decode()
        (depth,) = _DEPTH.unpack_from(sections[b"WRLD"])
        colours, mirrors = _materials(sections[b"MATL"])
        words = np.frombuffer(sections[b"WORD"], dtype="<u4").astype(np.uint32)
        camera = _camera(sections[b"VIEW"]) if b"VIEW" in sections else None
        faces = _FACES.unpack(sections[b"FACE"]) if b"FACE" in sections else FACES
        lighting = _lighting(sections[b"LITE"], faces) if b"LITE" in sections else None
        roots, period = _frames(sections[b"FRMS"]) if b"FRMS" in sections else ((0,), None)
    except KeyError as error:
        raise Refused(f"the blob has no section {error.args[0].decode()}; write it again") from None
    except (struct.error, ValueError) as error:
        raise Refused(
            f"the sections of the blob do not have the layout of version {VERSION} ({error}); write it again"
        ) from None
    return Scene(name, depth, words, colours, mirrors, camera, lighting, roots, period)


def _sections(data: bytes) -> dict[bytes, bytes]:
    if len(data) < _HEADER.size or not data.startswith(MAGIC):
        raise Refused(f"the file does not start with {MAGIC.decode()}: it is no blob; write one with voxrt convert")
    _, version, count, size, crc32 = _HEADER.unpack_from(data)
    if version != VERSION:
        raise Refused(f"blob version {version} is not supported, only {VERSION}; upgrade voxrt-board")
    table = data[_HEADER.size : _HEADER.size + _ENTRY.size * min(count, len(data))]
    if size != len(data) or len(table) != _ENTRY.size * count or zlib.crc32(table) != crc32:
        raise Refused("the header of the blob is damaged, or the file is incomplete; write it again")
    sections = {}
    for name, offset, length, section_crc32 in _ENTRY.iter_unpack(table):
        section = data[offset : offset + length]
        if len(section) != length or zlib.crc32(section) != section_crc32:
            raise Refused(
                f"section {name.decode('latin-1').encode('unicode_escape').decode()} of the blob is damaged (CRC-32); "
                "write it again"
            )
        sections[name] = section
    return sections


def _materials(section: bytes) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    colours, mirrors = np.zeros((256, 3), dtype=np.uint8), np.zeros(256, dtype=np.bool_)
    (count,) = struct.unpack_from("<I", section)
    if not 1 <= count <= 256:
        raise ValueError(f"{count} materials are not 1 to 256")
    position = 4
    for material in range(count):
        red, green, blue, flags, name = _MATERIAL.unpack_from(section, position)
        colours[material], mirrors[material] = (red, green, blue), bool(flags & _MIRROR)
        position += _MATERIAL.size + name + -name % 8
    return colours, mirrors


def _frames(section: bytes) -> tuple[tuple[int, ...], float | None]:
    """Return the roots of the frames of an animation, and its period."""
    roots, times = [], []
    (count,) = struct.unpack_from("<I", section)
    position = 8
    if not 1 <= count <= len(section) // _FRAME.size:
        raise ValueError(f"{count} frames are not what {len(section)} bytes hold")
    for _ in range(count):
        root, _, time, name = _FRAME.unpack_from(section, position)
        roots.append(root)
        times.append(None if math.isnan(time) else time)
        position += _FRAME.size + name + -name % 8
    return tuple(roots), frame_period(times)


def _camera(section: bytes) -> Camera:
    values = _VIEW.unpack(section)
    return Camera(values[:3], values[3:6], values[6:9], values[9:12])


def _lighting(section: bytes, faces: Faces) -> Lighting:
    x, y, z, ambient, flags, bounces, _ = _LIGHT.unpack(section)
    return Lighting(
        (x, y, z),
        ambient,
        on=bool(flags & _LIGHT_ON),
        flat=bool(flags & _FLAT),
        bounces=min(bounces, 15),
        faces=None if flags & _BY_ANGLE else faces,
    )
