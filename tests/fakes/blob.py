"""Files of scenes that no builder makes."""

from __future__ import annotations

import struct
import zlib

from voxrt.export import Blob, blob_bytes
from voxrt.export.manifest import make_manifest, manifest_bytes
from voxrt.export.word_file import mem_crc32, mem_pieces
from voxrt.octree import Octree, Rom
from voxrt.voxelize import Material


def rom_of(scene, name: str | None = None) -> Rom:
    """The memory of a scene, with 256 materials."""
    materials = tuple(Material(f"m{row}", tuple(colour)) for row, colour in enumerate(scene.colours.tolist()))
    return Rom(name or scene.name, Octree(scene.depth, scene.words), materials)


def blob_of(scene, name: str | None = None) -> bytes:
    """A scene as a blob."""
    return blob_bytes(Blob(rom_of(scene, name)))


def mem_files(scene) -> dict[str, bytes]:
    """A scene as a .mem and its .json."""
    manifest = make_manifest(Blob(rom_of(scene)), mem_crc32(scene.words), "report")
    return {f"{scene.name}.mem": b"".join(mem_pieces(scene.words)), f"{scene.name}.json": manifest_bytes(manifest)}


def rewritten(data: bytes, name: bytes, body: bytes | None = None) -> bytes:
    """The blob with one section exchanged (or left out), its table made right again."""
    count = struct.unpack_from("<I", data, 12)[0]
    entries = [struct.unpack_from("<4sIII", data, 24 + 16 * i) for i in range(count)]
    bodies = {n: data[o : o + size] for n, o, size, _ in entries}
    if body is None:
        del bodies[name]
    else:
        bodies[name] = body
    table, rest, start = b"", b"", 24 + 16 * len(bodies)
    for n, section in bodies.items():
        table += struct.pack("<4sIII", n, start + len(rest), len(section), zlib.crc32(section))
        rest += section
    return data[:12] + struct.pack("<III", len(bodies), start + len(rest), zlib.crc32(table)) + table + rest
