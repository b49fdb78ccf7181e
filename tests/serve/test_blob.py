"""The reader of blobs, against a writer of the tests, and against damaged blobs."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest
from fakes.device import scene

from voxrt.board.errors import Refused
from voxrt.board.view import Camera, Lighting
from voxrt.serve.blob import read_blob
from voxrt.serve.scene_files import read_memory

MADE = scene("föhn", blocks=3)
SECTIONS = {
    b"NAME": "föhn".encode(),
    b"WRLD": struct.pack("<II4d", 3, 1, 0.5, -1, 2, 0.25),
    b"MATL": struct.pack("<I", 2)
    + struct.pack("<4BHxx", 1, 2, 3, 2, 5) + b"empty\0\0\0"
    + struct.pack("<4BHxx", 200, 100, 50, 1, 0),
    b"WORD": MADE.words.astype("<u4").tobytes(),
    b"VIEW": struct.pack("<12i", -16, 32, 48, 0, 0, -90, 1, 0, 0, 0, 1, 0),
    b"XTRA": b"of a later version",
    b"LITE": struct.pack("<3i4B", 1, -2, 3, 40, 1, 2, 0),
}  # fmt: skip


def encode(sections):
    table, body = b"", b""
    start = 24 + 16 * len(sections)
    for name, data in sections.items():
        table += struct.pack("<4sIII", name, start + len(body), len(data), zlib.crc32(data))
        body += data + bytes(-len(data) % 8)
    return struct.pack("<8sIIII", b"VOXRTBLB", 1, len(sections), start + len(body), zlib.crc32(table)) + table + body


def test_blob(tmp_path):
    (tmp_path / "any.name").write_bytes(encode(SECTIONS))
    read = read_memory([tmp_path / "any.name"], lambda *_: None)
    assert (read.name, read.depth, read.background) == ("föhn", 3, (1, 2, 3))
    assert (read.words == MADE.words).all()
    assert read.colours[1].tolist() == [200, 100, 50]
    assert np.flatnonzero(read.mirrors).tolist() == [1]
    assert read.camera == Camera((-16, 32, 48), (0, 0, -90), (1, 0, 0), (0, 1, 0))
    assert read.lighting == Lighting((1, -2, 3), 40, on=True, bounces=2)
    bare = read_blob(encode({name: SECTIONS[name] for name in (b"NAME", b"WRLD", b"MATL", b"WORD")}))
    assert (bare.camera, bare.lighting) == (None, None)


def test_the_shading_of_a_blob():
    def lighting(flags):
        return read_blob(encode({**SECTIONS, b"LITE": struct.pack("<3i4B", 1, -2, 3, 40, flags, 0, 0)})).lighting

    assert [lighting(flags).shading for flags in (0, 2, 4)] == ["faces", "flat", "report"]
    assert read_blob(encode({**SECTIONS, b"FACE": bytes([1, 2, 3, 4, 5, 255])})).lighting.faces == (1, 2, 3, 4, 5, 255)


@pytest.mark.parametrize("name", [b"NAME", b"WRLD", b"MATL", b"WORD"])
def test_missing_sections(name):
    with pytest.raises(Refused, match=f"no section {name.decode()}"):
        read_blob(encode({key: data for key, data in SECTIONS.items() if key != name}))


@pytest.mark.parametrize(
    ("name", "data"),
    [
        (b"NAME", b"\xff"),
        (b"WRLD", b"\1"),
        (b"MATL", b""),
        (b"MATL", struct.pack("<I", 257)),
        (b"MATL", struct.pack("<I", 3) + bytes(16)),
        (b"WORD", b"abc"),
        (b"VIEW", bytes(47)),
        (b"LITE", bytes(17)),
        (b"FACE", bytes(5)),
    ],
)
def test_other_layouts(name, data):
    with pytest.raises(Refused, match="do not have the layout of version 1"):
        read_blob(encode({**SECTIONS, name: data}))


def test_every_flipped_bit_and_every_cut():
    blob = encode(SECTIONS)
    padding = len(blob)
    for at in range(padding):
        with pytest.raises(Refused):
            read_blob(blob[:at])
        flipped = bytearray(blob)
        flipped[at] ^= 0x10
        try:
            read = read_blob(bytes(flipped))
        except Refused:
            continue
        # The bytes between sections have no meaning.
        assert (read.words == MADE.words).all()
        assert read.camera == Camera((-16, 32, 48), (0, 0, -90), (1, 0, 0), (0, 1, 0))
    with pytest.raises(Refused, match="version 2"):
        read_blob(blob[:8] + b"\2" + blob[9:])


def test_blobs_of_the_exporter():
    blobs = pytest.importorskip("voxrt.export.blob")
    from voxrt.octree import Octree, Rom
    from voxrt.voxelize import Material

    materials = (Material("empty", (9, 8, 7)), Material("glass", (1, 2, 3), mirror=True))
    rom = Rom("house", Octree(3, MADE.words), materials)
    view = Camera((-160, 5, 7), (1, 2, -90), (3, 0, 0), (0, 4, 0))
    read = read_blob(blobs.blob_bytes(blobs.Blob(rom, view, Lighting((5, 6, 7), 30, on=True, bounces=3))))
    assert (read.name, read.depth, read.background) == ("house", 3, (9, 8, 7))
    assert (read.words == MADE.words).all()
    assert np.flatnonzero(read.mirrors).tolist() == [1]
    assert read.camera == Camera(view.position, view.look, view.right, view.up)
    assert read.lighting == Lighting((5, 6, 7), 30, on=True, bounces=3)
