"""``.svdag`` files: bytes by hand, round trips, and damaged files."""

import struct
import zlib

import numpy as np
import pytest

import voxrt
from voxrt import export, octree
from voxrt.octree import Rom, RomError


def rom(cells):
    return Rom("a", octree.from_dense(np.asarray(cells, np.uint8)), export.default_materials(9))


@pytest.fixture
def path(tmp_path):
    cells = np.zeros((8, 8, 8), np.uint8)
    cells[0, 0, 0], cells[7, 0, 0] = 7, 9
    export.write_svdag(tmp_path / "a.svdag", rom(cells))
    return tmp_path / "a.svdag"


def test_layout(path):
    words = struct.pack("<7I", 3, 3, 5, 1, 0, 8, 0)
    header = struct.pack("<8sIIIIQ", b"VOXSVDAG", 1, 3, 0, zlib.crc32(words), 7)
    assert path.read_bytes() == header + words


def test_a_file_is_read_as_a_memory_of_one_material(path):
    read, warnings = export.read_svdag(path)
    assert np.argwhere(octree.to_dense(read.octree)).tolist() == [[0, 0, 0], [7, 0, 0]]
    assert [warning.kind for warning in warnings] == ["assumed-palette"]
    blob, warnings = voxrt.read_any(path)
    assert bytes(blob.rom.octree.words) == bytes(read.octree.words)
    assert len(warnings) == 1


def test_a_world_without_solid_voxels(tmp_path):
    files = voxrt.convert(rom(np.zeros((4, 4, 4))), tmp_path / "none.svdag")
    assert files == (tmp_path / "none.svdag",)
    assert len(files[0].read_bytes()) == 32
    assert not octree.to_dense(export.read_svdag(files[0])[0].octree).any()


def test_every_damaged_byte_is_refused_in_one_line(path):
    data = path.read_bytes()
    for place in range(len(data)):
        path.write_bytes(data[:place] + bytes([data[place] ^ 0xFF]) + data[place + 1 :])
        with pytest.raises(RomError, match=r"a\.svdag: [^\n]+$"):
            export.read_svdag(path)
    for size in range(len(data)):
        path.write_bytes(data[:size])
        with pytest.raises(RomError, match=r"a\.svdag: [^\n]+$"):
            export.read_svdag(path)


def test_words_that_are_no_graph_are_refused_with_the_file(path):
    words = struct.pack("<2I", 1, 9)
    path.write_bytes(struct.pack("<8sIIIIQ", b"VOXSVDAG", 1, 3, 0, zlib.crc32(words), 2) + words)
    with pytest.raises(RomError, match=r"a\.svdag: word 1 leads behind the last word; the file is damaged"):
        export.read_svdag(path)
