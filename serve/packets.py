"""The binary messages: frames to viewers, chunks of files from them. ``docs/protocol.md`` is their manual."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..board.device import Counters, Frame
from ..board.errors import Refused

if TYPE_CHECKING:
    from typing import Final

FRAME_MAGIC: Final = b"VXFR"
CHUNK_MAGIC: Final = b"VXCH"
CHUNK_LIMIT: Final = 1 << 18
"""Bytes of a file that one message may carry."""

_NOT_COUNTED = (1 << 64) - 1
# magic, header's length, width, height, sequence, pixels' length, scene, viewer, request, rays, microseconds, cycles,
# words read
_FRAME = struct.Struct("<4sHHH2xIIIIIIIQQ")
_CHUNK = struct.Struct("<4sIII")

FRAME_HEADER: Final = _FRAME.size
CHUNK_HEADER: Final = _CHUNK.size


@dataclass(frozen=True, eq=False, slots=True)
class FramePacket:
    """A frame on its way.

    Attributes
    ----------
    sequence
        Counts the frames of a server, from 1; viewers that miss some see it.
    scene
        Counts the scenes that a server has run; which of them this frame shows.
    viewer, request
        The newest request that this frame honours, and whose it was; 0 and 0 where there was none.
    frame
        The picture and its cost.
    """

    sequence: int
    scene: int
    viewer: int
    request: int
    frame: Frame


@dataclass(frozen=True, eq=False, slots=True)
class Chunk:
    """A piece of the files of an upload: which upload, from which byte of all its files on, and the bytes."""

    upload: int
    offset: int
    data: bytes


def pack_frame(packet: FramePacket) -> bytes:
    """Spell a frame as the message that viewers get."""
    height, width, _ = packet.frame.colour.shape
    counters = packet.frame.counters
    pixels = packet.frame.colour.tobytes()
    header = _FRAME.pack(
        FRAME_MAGIC,
        FRAME_HEADER,
        width,
        height,
        packet.sequence & 0xFFFFFFFF,
        len(pixels),
        packet.scene & 0xFFFFFFFF,
        packet.viewer,
        packet.request,
        counters.rays,
        min(round(counters.seconds * 1e6), 0xFFFFFFFF),
        _NOT_COUNTED if counters.cycles is None else counters.cycles,
        _NOT_COUNTED if counters.words_read is None else counters.words_read,
    )
    return header + pixels


def unpack_frame(message: bytes) -> FramePacket:
    """Read what :func:`pack_frame` wrote.

    Raises
    ------
    Refused
        It is no frame, or not all of one.
    """
    if len(message) < FRAME_HEADER or not message.startswith(FRAME_MAGIC):
        raise Refused("the message is no frame; is that a voxrt frame server?")
    (_, header, width, height, sequence, length, scene, viewer, request, rays, micros, cycles, words_read) = (
        _FRAME.unpack_from(message)
    )
    if length != width * height * 3 or len(message) != header + length:
        raise Refused(f"a frame of {width}x{height} pixels came with {len(message) - header} bytes")
    colour = np.frombuffer(message, dtype=np.uint8, offset=header).reshape(height, width, 3)
    words_read, cycles = (None if count == _NOT_COUNTED else count for count in (words_read, cycles))
    counters = Counters(rays, words_read, cycles, micros / 1e6)
    return FramePacket(sequence, scene, viewer, request, Frame(colour, counters))


def pack_chunk(chunk: Chunk) -> bytes:
    """Spell a chunk, with the CRC-32 of its bytes."""
    return _CHUNK.pack(CHUNK_MAGIC, chunk.upload, chunk.offset, zlib.crc32(chunk.data)) + chunk.data


def unpack_chunk(message: bytes) -> Chunk:
    """Read a chunk and check its bytes.

    Raises
    ------
    Refused
        It is no chunk, it is empty or too long, or its CRC-32 is another.
    """
    if len(message) < CHUNK_HEADER or not message.startswith(CHUNK_MAGIC):
        raise Refused("a binary message is no chunk of an upload")
    _, upload, offset, crc32 = _CHUNK.unpack_from(message)
    data = message[CHUNK_HEADER:]
    if not 1 <= len(data) <= CHUNK_LIMIT:
        raise Refused(f"a chunk of {len(data)} bytes is not 1 to {CHUNK_LIMIT}")
    if zlib.crc32(data) != crc32:
        raise Refused(f"the chunk at byte {offset} was damaged on its way (CRC-32); upload again")
    return Chunk(upload, offset, data)
