"""Blobs of scenes that no builder makes."""

from __future__ import annotations

import struct
import zlib


def blob_of(scene, name: bytes | None = None) -> bytes:
    """A blob with a scene's words and 256 materials."""
    sections = {
        b"NAME": scene.name.encode() if name is None else name,
        b"WRLD": struct.pack("<I", scene.depth),
        b"MATL": struct.pack("<I", 256) + b"".join(struct.pack("<4BHxx", *row, 0, 0) for row in scene.colours.tolist()),
        b"WORD": scene.words.astype("<u4").tobytes(),
    }
    table, body = b"", b""
    start = 24 + 16 * len(sections)
    for section, data in sections.items():
        table += struct.pack("<4sIII", section, start + len(body), len(data), zlib.crc32(data))
        body += data + bytes(-len(data) % 8)
    return struct.pack("<8sIIII", b"VOXRTBLB", 1, len(sections), start + len(body), zlib.crc32(table)) + table + body
