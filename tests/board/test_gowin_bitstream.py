"""The block RAMs in a bitstream of a Gowin GW2A: patching gives what gowin_pack gives of the new contents."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from voxrt.board.designs.base_design import GOWIN_WIDTHS, Slice, base_contents, match_slices
from voxrt.board.designs.gowin import find_block_rams
from voxrt.board.designs.gowin_bitstream import BlockRams, patch_fs, read_block_rams

BOARD = {"part": "GW2A-18C"}
ROWS, BITS = 4096, 12
# 72 columns of a block RAM in no order, and two block RAMs in two rows of them.
RAMS = BlockRams(tuple((7 * line + 3) % 180 for line in range(72)), ((4, 200), (260, 8)))
LENGTH = 448
COMMENT, HEADER = "//a comment", "1010010111000011"


def checksum(frame):
    """CRC-16/ARC, bit by bit, of six bytes of ones and a frame of zeros and ones."""
    value = 0
    for byte in [0xFF] * 6 + [int(frame[at : at + 8], 2) for at in range(0, len(frame), 8)]:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return value


@pytest.fixture(scope="module")
def fs():
    """A bitstream of noise, whose checksums are wrong."""
    bits = np.random.default_rng(3).integers(0, 2, (4 + 512, LENGTH + 64))
    frames = ["".join(map(str, row)) for row in bits]
    return "\n".join([COMMENT, HEADER, *frames, "0000"]) + "\n"


def test_only_the_contents_and_their_checksums_change(fs):
    contents = np.random.default_rng(1).integers(0, 1 << 18, 1024, dtype=np.uint32)
    patched = patch_fs(fs, RAMS, {"memory": [Slice(1, 0, 1024, 0, 18)]}, {"memory": contents})
    before, after = read_block_rams(fs, RAMS), read_block_rams(patched, RAMS)
    assert np.array_equal(after[1], contents)
    assert np.array_equal(after[0], before[0])
    lines = list(zip(fs.splitlines(), patched.splitlines(), strict=True))
    frames = [pair for pair in lines if len(pair[0]) == LENGTH + 64]
    assert [pair for pair in lines if pair not in frames] == [(COMMENT,) * 2, (HEADER,) * 2, ("0000",) * 2]
    assert all(old == new for old, new in frames[:260])
    columns = {LENGTH - 1 - 8 - column for column in RAMS.columns}
    for old, new in frames[260:]:
        assert {at for at in range(LENGTH) if old[at] != new[at]} <= columns
        check = checksum(new[:LENGTH])
        assert new[LENGTH + 16 :] == old[LENGTH + 16 :]
        assert new[LENGTH : LENGTH + 16] == f"{check & 0xFF:08b}{check >> 8:08b}"


def ram(kind, bel, widths, contents, x9=False):
    """A block RAM as nextpnr writes it, which holds rows of 16 or 18 bits."""
    bits = 18 if x9 else 16
    text = "".join(f"{row:0{bits}b}" for row in reversed(contents.tolist()))
    size = 16 * bits
    lines = [text[len(text) - size * (n + 1) : len(text) - size * n] for n in range(64)]
    parameters = {f"INIT_RAM_{number:02X}": line for number, line in enumerate(lines)}
    names = ["BIT_WIDTH"] if kind == "SP" else ["BIT_WIDTH_0", "BIT_WIDTH_1"]
    parameters |= {name: f"{width:032b}" for name, width in zip(names, widths, strict=True)}
    attributes = {"NEXTPNR_BEL": bel, "BSRAM_SUBTYPE": "X9" if x9 else " "}
    return {"type": kind, "parameters": parameters, "attributes": attributes, "port_directions": {}, "connections": {}}


def packed(folder, memories):
    """Pack block RAMs that hold the memories, by gowin_pack: 4,096 x 4 bits three times, and 1,024 x 18 bits."""
    memory, other = memories
    cells = {}
    for number, bel in enumerate(("X10Y9/BSRAM", "X37Y27/BSRAM", "X46Y45/BSRAM")):
        part = memory >> (4 * number) & 15
        rows = part[0::4] | part[1::4] << 4 | part[2::4] << 8 | part[3::4] << 12
        cells[f"ram{number}"] = ram("SP", bel, [4], rows)
    cells["wide"] = ram("DP", "X10Y27/BSRAM", [18, 18], other, x9=True)
    pin = {"O": [3], "I": [2]}
    attributes = {"NEXTPNR_BEL": "X0Y46/IOBA"}
    buffer = {"parameters": {"NET_I": "NET", "NET_O": "NET"}, "attributes": attributes, "port_directions": {}}
    cells["pin"] = {"type": "OBUF", "connections": pin} | buffer
    top = {"attributes": {}, "ports": {}, "cells": cells, "netnames": {}}
    top["settings"] = {
        "packer.partno": "GW2AR-LV18QN88C8/I7",
        "packer.chipdb": "GW2A-18C",
        "packer.arch": "himbaechel/gowin",
    }
    netlist = {"creator": "", "modules": {"top": top}}
    (folder / "placed.json").write_text(json.dumps(netlist))
    program = Path(sys.executable).with_name("gowin_pack")
    subprocess.run([program, "-d", "GW2A-18C", "-o", "top.fs", "placed.json"], cwd=folder, check=True)
    return netlist, (folder / "top.fs").read_text()


def test_patching_gives_the_bytes_of_gowin_pack(tmp_path):
    pytest.importorskip("apycula", reason="gowin_pack is not installed")
    sizes = {"octree": (ROWS, BITS), "table": (1024, 18)}
    netlist, fs = packed(tmp_path, [base_contents(name, *size) for name, size in sizes.items()])
    rams = find_block_rams(BOARD, netlist)
    slices = match_slices(read_block_rams(fs, rams), sizes, GOWIN_WIDTHS)
    assert [(len(found), found[0].bits) for found in slices.values()] == [(3, 4), (1, 18)]
    random = np.random.default_rng(7)
    new = {name: random.integers(0, 1 << bits, rows, dtype=np.uint32) for name, (rows, bits) in sizes.items()}
    _, expected = packed(tmp_path, list(new.values()))
    assert patch_fs(fs, rams, slices, new) == expected
