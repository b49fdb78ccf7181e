"""Files of words other than .mem: layouts by hand, round trips, and what a board tool would refuse."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt import export
from voxrt.octree import RomError

WORDS = np.array([1, 0xFFFFFF00, 0xABCDEF], np.uint32)
FORMATS = {
    ".coe": (export.write_coe, export.read_coe),
    ".mif": (export.write_mif, export.read_mif),
    ".bin": (export.write_raw, export.read_raw),
    ".mem": (export.write_mem, export.read_mem),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("formats")


def read(folder, suffix, data):
    path = folder / f"a{suffix}"
    path.write_bytes(data)
    return FORMATS[suffix][1](path)


@pytest.mark.parametrize(
    ("suffix", "data"),
    [
        (".coe", b"memory_initialization_radix=16;\nmemory_initialization_vector=\n00000001,\nFFFFFF00,\n00ABCDEF;\n"),
        (
            ".mif",
            (
                b"WIDTH=32;\nDEPTH=3;\nADDRESS_RADIX=HEX;\nDATA_RADIX=HEX;\nCONTENT BEGIN\n"
                b"0 : 00000001;\n1 : FFFFFF00;\n2 : 00ABCDEF;\nEND;\n"
            ),
        ),
        (".bin", b"\x01\0\0\0\x00\xff\xff\xff\xef\xcd\xab\0"),
    ],
)
def test_layout(folder, suffix, data):
    path = folder / f"layout{suffix}"
    FORMATS[suffix][0](path, WORDS)
    assert path.read_bytes() == data


@pytest.mark.parametrize("suffix", FORMATS)
@given(words=st.lists(st.integers(0, 2**32 - 1), min_size=1, max_size=40))
def test_round_trip(folder, suffix, words):
    path = folder / f"trip{suffix}"
    write, reader = FORMATS[suffix]
    write(path, np.array(words, np.uint32))
    found = reader(path)
    assert found.words.dtype == np.uint32
    assert found.words.tolist() == words
    export.write_mem(folder / "trip.mem", np.array(words, np.uint32))
    assert found.crc32 == export.read_mem(folder / "trip.mem").crc32


@pytest.mark.parametrize(
    ("suffix", "data", "lines"),
    [
        (".coe", (b"; heading\n; more\nMEMORY_INITIALIZATION_RADIX = 2 ;\nmemory_initialization_vector =\n"
                 b"1 , 11111111111111111111111100000000\n\n,101010111100110111101111 ;"), [5, 5, 7]),
        (".coe", b"memory_initialization_radix=10;\nmemory_initialization_vector=1 4294967040 11259375;", [2, 2, 2]),
        (".mif", (b"-- heading\nDEPTH = 3; % two\nlines % WIDTH = 32;\nADDRESS_RADIX = UNS;\nDATA_RADIX = BIN;\n"
                 b"content begin\n0: 1\n11111111111111111111111100000000;\n2 : 101010111100110111101111; -- end\nend;"),
         [7, 7, 9]),
        (".mif", b"WIDTH=32;DEPTH=3;CONTENT BEGIN\n[0..2] : 1 ; \n1 : FFFFFF00 ABCDEF;\nEND;\n", [2, 3, 3]),
        (".mif", b"\n".join(f"{word:032b}".encode() for word in WORDS), None),
    ],
)  # fmt: skip
def test_other_layouts(folder, suffix, data, lines):
    found = read(folder, suffix, data)
    assert found.words.tolist() == WORDS.tolist()
    assert lines is None or found.lines.tolist() == lines


COE = b"memory_initialization_radix=16;\nmemory_initialization_vector=\n"
MIF = b"WIDTH=32;\nDEPTH=2;\nCONTENT BEGIN\n"


@pytest.mark.parametrize(
    ("suffix", "data", "message"),
    [
        (".coe", b"", "do not stand first"),
        (".coe", COE.replace(b"16", b"8") + b"1;", "radix 8 is none of 2, 10 and 16"),
        (".coe", COE + b"1,2", "the vector does not end the file"),
        (".coe", COE + b"1; 2", "the vector does not end the file"),
        (".coe", COE + b"1,\n100000000;", "line 4: '100000000' is no word of 32 bits in radix 16"),
        (".coe", COE.replace(b"16", b"10") + b"4294967296;", "line 3: '4294967296' is no word of 32 bits in radix 10"),
        (".coe", COE + b"1,\n\n0x1;", "line 5: '0x1' is no word"),
        (".mif", b"", "has no CONTENT BEGIN"),
        (".mif", MIF, "has no CONTENT BEGIN"),
        (".mif", MIF.replace(b"32", b"16") + b"END;", "WIDTH is not 32"),
        (".mif", MIF.replace(b"2;\nC", b"99999999999;\nC") + b"END;", "DEPTH is not 1 ... 67108864"),
        (".mif", MIF.replace(b"WIDTH", b"DATA_RADIX=ODD;WIDTH") + b"END;", "is none of BIN, OCT, DEC, UNS and HEX"),
        (".mif", MIF + b"0 : 1;\nEND;", "word 0x1 has no value"),
        (".mif", MIF + b"0 : 1;\n1 : 2;\n2 : 3;\nEND;", "line 6: an entry reaches word 2 of 2"),
        (".mif", MIF + b"[1..0] : 1;\nEND;", "line 4: an entry reaches"),
        (".mif", MIF + b"0 : ;\nEND;", "line 4: '0 :' is no 'address : word'"),
        (".mif", MIF + b"0 : 100000000;\nEND;", "line 4: '0 : 100000000' is no"),
        (".mif", MIF + b"0 : -1;\nEND;", "line 4: '0 : -1' is no"),
        (".mif", MIF + b"0 : 1;\n1 : 2\nEND;", "the last entry does not end with ';'"),
        (".bin", b"12345", "5 bytes are not words of 4"),
    ],
)
def test_malformed_files_are_refused(folder, suffix, data, message):
    with pytest.raises(RomError, match=message):
        read(folder, suffix, data)


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_file_that_is_not_there(folder, suffix):
    with pytest.raises(RomError, match=rf"none\{suffix}: cannot be read"):
        FORMATS[suffix][1](folder / f"none{suffix}")
