"""Large files of words are mapped, not copied, and are as good as those that are read."""

import mmap

import numpy as np
import pytest

from voxrt import export, octree
from voxrt.export import word_file
from voxrt.octree import Rom, RomError

CELLS = np.random.default_rng(0).integers(0, 3, (16, 16, 16)).astype(np.uint8)


@pytest.fixture
def mapped(tmp_path, monkeypatch):
    """A memory whose file counts as large, and the file."""
    monkeypatch.setattr(word_file, "_MAPPED", 64)
    rom = Rom("a", octree.from_dense(CELLS), export.default_materials(2))
    return rom, export.write_rom(tmp_path, rom, suffix=".bin").mem


def test_the_words_of_the_memory_are_those_of_the_mapping(mapped):
    rom, path = mapped
    words = export.read_raw(path).words
    assert not words.flags.writeable
    assert not words.flags.owndata
    tree = octree.decode(words, "report", rom.octree.depth)
    assert np.shares_memory(tree.words, words)
    np.testing.assert_array_equal(tree.words, rom.octree.words)


def test_words_that_somebody_can_write_are_copied(mapped):
    rom, _ = mapped
    words = rom.octree.words.copy()
    tree = octree.decode(words, "report", rom.octree.depth)
    words[:] = 0
    np.testing.assert_array_equal(tree.words, rom.octree.words)
    assert not tree.words.flags.writeable


@pytest.mark.parametrize("manifest", [True, False])
def test_a_mapped_memory_is_that_of_its_file(mapped, manifest):
    rom, path = mapped
    if not manifest:
        path.with_suffix(".json").unlink()
    read, _ = export.read_rom(path)
    np.testing.assert_array_equal(octree.to_dense(read.octree), CELLS)
    assert octree.census(read.octree).voxels == octree.census(rom.octree).voxels


def owner(words):
    while isinstance(words, np.ndarray):
        words = words.base
    return words.obj if isinstance(words, memoryview) else words


def test_the_words_of_a_large_blob_are_those_of_the_mapping(mapped, tmp_path):
    rom, _ = mapped
    path = tmp_path / "a.blob"
    export.write_blob(path, export.Blob(rom))
    read = export.read_blob(path)
    assert isinstance(owner(read.rom.octree.words), mmap.mmap)
    np.testing.assert_array_equal(read.rom.octree.words, rom.octree.words)
    assert export.blob_bytes(read) == path.read_bytes()


def test_a_large_blob_that_is_damaged_is_refused(mapped, tmp_path):
    path = tmp_path / "a.blob"
    export.write_blob(path, export.Blob(mapped[0]))
    data = bytearray(path.read_bytes())
    for change, message in ((len(data) - 20, "section WORD: is damaged"), (3, "does not start with VOXRTBLB")):
        damaged = bytearray(data)
        damaged[change] ^= 1
        path.write_bytes(damaged)
        with pytest.raises(RomError, match=message):
            export.read_blob(path)
    path.write_bytes(data[:-8])
    with pytest.raises(RomError, match="header: speaks of"):
        export.read_blob(path)


def test_a_file_that_is_replaced_stays_as_it_was_for_its_reader(mapped):
    rom, path = mapped
    read, _ = export.read_rom(path)
    export.write_raw(path, np.zeros(9, np.uint32))
    np.testing.assert_array_equal(read.octree.words, rom.octree.words)


def test_damaged_words_are_refused_with_their_address(mapped):
    rom, path = mapped
    words = rom.octree.words.copy()
    words[3] = 0xFFFF0001
    path.with_suffix(".json").unlink()
    export.write_raw(path, words)
    with pytest.raises(RomError, match=r"word 0x3: FFFF0001"):
        export.read_rom(path, rom.octree.depth, "report")
    with pytest.raises(RomError, match=r"word 0x3: FFFF0001"):
        export.read_rom(path)
    path.write_bytes(words.tobytes()[:-1])
    with pytest.raises(RomError, match="bytes are not words of 4"):
        export.read_rom(path)
