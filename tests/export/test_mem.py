import os
import zlib

import numpy as np
import pytest
from assets import asset, over_assets
from hypothesis import given
from hypothesis import strategies as st

from voxrt import export
from voxrt.export.word_file import mem_crc32, mem_pieces
from voxrt.octree import RomError, _native
from voxrt.voxelize import AssetError

words32 = st.lists(st.integers(0, 2**32 - 1), max_size=40)


def read(path, data):
    path.write_bytes(data)
    return export.read_mem(path)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("mem") / "a.mem"


def test_layout(path):
    export.write_mem(path, np.array([1, 0xFFFFFF00, 0xABCDEF], np.uint32))
    assert path.read_bytes() == b"00000001\nFFFFFF00\n00ABCDEF\n"
    assert [p.name for p in path.parent.iterdir()] == ["a.mem"]


@given(words=words32)
def test_round_trip(path, words):
    export.write_mem(path, np.array(words, np.uint32))
    data = path.read_bytes()
    found = export.read_mem(path)
    assert data == b"".join(b"%08X\n" % word for word in words)
    assert found.words.tolist() == words
    assert found.lines.tolist() == list(range(1, len(words) + 1))
    assert found.crc32 == zlib.crc32(data)


@given(words=words32, data=st.data())
def test_any_layout_that_readmemh_takes(path, words, data):
    text = data.draw(st.sampled_from(["", "// heading\n", "/* two\nlines */", "\r\n\n", "@0\n"]))
    line = 1 + text.count("\n")
    lines = []
    for i, word in enumerate(words):
        digits = data.draw(st.sampled_from([f"{word:08X}", f"{word:x}", f"{word:04X}_"]))
        end = data.draw(st.sampled_from(["\n", " ", " \n", "\t// a word\n", f"\n@{i + 1:X}\n", "\r\n", "/**/\n"]))
        lines.append(line)
        text += digits + end
        line += end.count("\n")
    found = read(path, text.encode())
    assert found.words.tolist() == words
    assert found.lines.tolist() == lines
    if data.draw(st.booleans()):
        assert read(path, text.rstrip().encode()).words.tolist() == words


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"00000001\nGFFFFF00\n", r"a\.mem: line 2: 'GFFFFF00' is not a word of up to 8 hex digits"),
        (b"00000001\n\n1FFFFFF00\n", "line 3: '1FFFFFF00' is not a word"),
        (b"0000000x\n", "line 1: '0000000x' is not a word"),
        (b"_\n", "line 1: '_' is not a word"),
        (b"@5\n00000001\n", "line 1: address '@5' does not name the next word"),
        (b"@zz\n00000001\n", "line 1: address '@zz' does not name"),
        (b"\x89PNG\r\n\x1a\n", r"line 1: '\\x89PNG' is not a word"),
        (b"f" * 10**6, "line 1: 'ffffffffffffffffffff' is not a word"),
        (b"00000001\n/* never closed", r"line 2: '/\*' is not a word"),
    ],
)
def test_what_is_no_mem_file_is_refused_by_line(path, data, message):
    with pytest.raises(RomError, match=message):
        read(path, data)


def test_a_file_that_is_not_there(path):
    with pytest.raises(RomError, match=r"none\.mem: cannot be read: No such file or directory"):
        export.read_mem(path.with_name("none.mem"))
    with pytest.raises(RomError, match="cannot be read: Is a directory"):
        export.read_mem(path.parent)


@over_assets(
    ("name", "count", "last"), [("house", 4305, 0xFFFFFFF0), ("dog", 1049, 0xFFFFFFF0), ("cubes", 25, 0xFFFFFF01)]
)
def test_the_published_memories_keep_their_last_word(name, count, last):
    found = export.read_mem(asset(f"../seed-memories/{name}.mem"))
    assert len(found.words) == count
    assert found.words[-1] == last
    assert found.lines[-1] == count


@given(st.lists(st.integers(0, 2**32 - 1), max_size=300), st.integers(0, 300))
def test_the_text_and_its_crc_are_those_of_python(values, cut):
    words = np.array(values, np.uint32)
    text = b"".join(b"%08X\n" % value for value in values)
    assert b"".join(mem_pieces(words)) == text
    assert mem_crc32(words) == zlib.crc32(text)
    before = zlib.crc32(text[: 9 * cut])
    assert _native.mem_text_crc32(words[cut:], before) == zlib.crc32(text)
    assert _native.read_mem_text(text).tolist() == values


def test_long_texts_are_cut_into_pieces_for_the_threads():
    words = np.random.default_rng(0).integers(0, 1 << 32, (1 << 20) + 77, np.uint32)
    text = b"".join(mem_pieces(words))
    assert len(text) == 9 * len(words)
    assert zlib.crc32(text) == mem_crc32(words)
    assert (_native.read_mem_text(text) == words).all()


@pytest.mark.parametrize("text", [b"0000000g\n", b"0000000a\n", b"00000000 ", b"0000000\n", b"-0000000\n"])
def test_other_layouts_are_left_to_the_reader_of_all(text):
    assert _native.read_mem_text(text) is None


@pytest.mark.parametrize("suffix", [".mem", ".coe", ".mif", ".bin", ".blob", ".txt", ".vox"])
def test_what_may_never_end_is_not_read(suffix, tmp_path):
    pipe, endless = tmp_path / f"pipe{suffix}", tmp_path / f"endless{suffix}"
    os.mkfifo(pipe)
    endless.symlink_to("/dev/zero")
    for path in (pipe, endless):
        with pytest.raises((RomError, AssetError), match="is a pipe or a device; save it to a file, and name that"):
            export.read_any(path)
