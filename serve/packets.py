"""The binary messages: frames to clients, chunks of files from clients. ``docs/protocol.md`` documents them."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.device import Counters, Frame
from voxrt.board.errors import Refused
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from typing import Final

PROTOCOL_VERSION: Final = 2
"""Version of the protocol, JSON messages included. A client refuses a server with another version."""

FRAME_MAGIC: Final = b"VXFR"
CHUNK_MAGIC: Final = b"VXCH"
CHUNK_LIMIT: Final = 1 << 18
"""Bytes of a file that one message may contain."""

_NOT_COUNTED = (1 << 64) - 1
# magic, bytes of the header, width, height, sequence, bytes of the pixels, scene, client, request, rays, microseconds,
# cycles, words read
_FRAME = struct.Struct("<4sHHH2xIIIIIIIQQ")
_CHUNK = struct.Struct("<4sIII")

FRAME_HEADER: Final = _FRAME.size
CHUNK_HEADER: Final = _CHUNK.size


class FramePacket(Value, frozen=True, eq=False):
    """A frame with its numbers.

    Attributes
    ----------
    sequence
        The number of the frame, counted from 1; a client that misses frames sees a gap.
    scene
        The number of the scene, counted from 1; 0 before the first scene was loaded.
    client, request
        The newest change of the view that the frame shows: number of the client and of its request; 0 and 0 where
        there was none.
    frame
        The pixels and their cost.
    """

    sequence: int
    scene: int
    client: int
    request: int
    frame: Frame


class Chunk(Value, frozen=True, eq=False):
    """A part of an upload: number of the upload, offset in all its files together, and the bytes."""

    upload: int
    offset: int
    data: bytes


def pack_frame(packet: FramePacket) -> bytes:
    """Encode a frame as the message for clients."""
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
        packet.client,
        packet.request,
        counters.rays,
        min(round(counters.seconds * 1e6), 0xFFFFFFFF),
        _NOT_COUNTED if counters.cycles is None else counters.cycles,
        _NOT_COUNTED if counters.words_read is None else counters.words_read,
    )
    return header + pixels


def unpack_frame(message: bytes) -> FramePacket:
    """Decode the message of :func:`pack_frame`.

    Raises
    ------
    Refused
        The message is no frame, or it is incomplete.
    """
    if len(message) < FRAME_HEADER or not message.startswith(FRAME_MAGIC):
        raise Refused("the message is no frame; check that the address is that of a voxrt frame server")
    (_, header, width, height, sequence, length, scene, client, request, rays, micros, cycles, words_read) = (
        _FRAME.unpack_from(message)
    )
    if header < FRAME_HEADER or width * height == 0:
        raise Refused(f"a frame of {width}x{height} pixels has a header of {header} bytes; connect again")
    if length != width * height * 3 or len(message) != header + length:
        raise Refused(f"a frame of {width}x{height} pixels has {len(message) - header} bytes; connect again")
    colour = np.frombuffer(message, dtype=np.uint8, offset=header).reshape(height, width, 3)
    words_read, cycles = (None if count == _NOT_COUNTED else count for count in (words_read, cycles))
    counters = Counters(rays, words_read, cycles, micros / 1e6)
    return FramePacket(sequence, scene, client, request, Frame(colour, counters))


def pack_chunk(chunk: Chunk) -> bytes:
    """Encode a chunk with the CRC-32 of its bytes."""
    return _CHUNK.pack(CHUNK_MAGIC, chunk.upload, chunk.offset, zlib.crc32(chunk.data)) + chunk.data


def unpack_chunk(message: bytes) -> Chunk:
    """Decode a chunk and check its bytes.

    Raises
    ------
    Refused
        The message is no chunk, the chunk is empty or too long, or its CRC-32 is wrong.
    """
    if len(message) < CHUNK_HEADER or not message.startswith(CHUNK_MAGIC):
        raise Refused("a binary message is no chunk of an upload; upload again")
    _, upload, offset, crc32 = _CHUNK.unpack_from(message)
    data = message[CHUNK_HEADER:]
    if not 1 <= len(data) <= CHUNK_LIMIT:
        raise Refused(f"a chunk has {len(data)} bytes, which is not 1 to {CHUNK_LIMIT}; upload again")
    if zlib.crc32(data) != crc32:
        raise Refused(f"the chunk at byte {offset} was damaged in transit (CRC-32); upload again")
    return Chunk(upload, offset, data)
